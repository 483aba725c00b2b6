#include "client/files/measured_files.h"

#include <algorithm>
#include <array>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "server/schema/file_bytes.h"

namespace phrenic::client {
namespace {

using fit::Measured;
using fit::MeasuredFile;

constexpr std::size_t kMostMeasuredBytes = 512 << 20;
constexpr std::array kWithErrors = {Measured::kLandmarks, Measured::kDiaphragm, Measured::kLungs,
                                    Measured::kVolume,    Measured::kMMode,     Measured::kMarkers};

// The kind and the value of KIND=VALUE.
struct GivenError {
  Measured measured;
  double value;
};

absl::StatusOr<GivenError> ReadError(const std::string& text) {
  const size_t at = text.find('=');
  const std::string name = text.substr(0, at);
  std::string kinds;
  for (const Measured measured : kWithErrors) {
    absl::StrAppend(&kinds, kinds.empty() ? "" : ", ", std::string(fit::NameOf(measured)));
    GivenError error = {measured, 0};
    if (at == std::string::npos || name != fit::NameOf(measured)) continue;
    if (!absl::SimpleAtod(text.substr(at + 1), &error.value) || !(error.value > 0)) {
      return absl::InvalidArgumentError(absl::StrCat("\"", text, "\": the error must be a positive number [mm, l]"));
    }
    return error;
  }
  return absl::InvalidArgumentError(absl::StrCat("\"", text, "\" is not KIND=VALUE with a kind of ", kinds));
}

// Sets the suffix after the last "@": a phase, a time or a side. Returns the file's name.
absl::StatusOr<std::string> ReadSuffix(const std::string& text, MeasuredFile& file) {
  const size_t at = text.rfind('@');
  if (at == std::string::npos) return text;
  const std::string name = text.substr(0, at), suffix = text.substr(at + 1);
  double phase = 0;
  const bool surface = file.measured == Measured::kDiaphragm || file.measured == Measured::kLungs;
  if (file.measured == Measured::kLandmarks && absl::SimpleAtod(suffix, &phase)) {
    file.phase = phase;
    return name;
  }
  if (surface && (suffix == "inhale" || suffix == "exhale")) {
    file.at_exhale = suffix == "exhale";
    return name;
  }
  if (file.measured == Measured::kMMode && (suffix == "right" || suffix == "left")) {
    file.side = suffix == "left" ? fit::kLeft : fit::kRight;
    return name;
  }
  if (ReadBytes(text, 0).has_value() || suffix.find('/') != std::string::npos ||
      suffix.find('.') != std::string::npos) {
    return text;
  }
  const char* allowed = surface                                 ? "@inhale or @exhale"
                        : file.measured == Measured::kLandmarks ? "@PHASE, a number above 0 and below 2"
                        : file.measured == Measured::kMMode     ? "@right or @left"
                                                                : "nothing";
  return absl::InvalidArgumentError(absl::StrCat("\"", text, "\": after the file's name comes ", allowed));
}

absl::StatusOr<MeasuredFile> ReadOneFile(Measured measured, const std::string& text) {
  MeasuredFile file;
  file.measured = measured;
  const absl::StatusOr<std::string> name = ReadSuffix(text, file);
  if (!name.ok()) return name.status();
  file.name = *name;
  std::optional<std::string> bytes = ReadBytes(file.name, kMostMeasuredBytes);
  if (!bytes) {
    return absl::NotFoundError(absl::StrCat("cannot read the file of --", std::string(fit::NameOf(measured)), ", ",
                                            file.name, ": check the path, and that it has at most ",
                                            kMostMeasuredBytes >> 20, " MiB"));
  }
  file.bytes = *std::move(bytes);
  return file;
}

}  // namespace

bool HasOtherKinds(const MeasuredOptions& options) {
  const bool phases = std::any_of(options.landmarks.begin(), options.landmarks.end(), [](const std::string& text) {
    MeasuredFile file;
    return ReadSuffix(text, file).ok() && file.phase.has_value();
  });
  return phases || options.landmarks.size() > 2 || !options.errors.empty() || !options.surfaces.empty() ||
         !options.lung_surfaces.empty() || !options.volumes.empty() || !options.m_modes.empty() ||
         !options.markers.empty() || (!options.landmarks.empty() && !options.exhale.empty());
}

absl::Status CheckError(const std::string& text) { return ReadError(text).status(); }

absl::StatusOr<std::vector<fit::MeasuredFile>> ReadMeasured(const MeasuredOptions& options) {
  const std::pair<Measured, const std::vector<std::string>*> lists[] = {
      {Measured::kLandmarks, &options.landmarks}, {Measured::kExhale, &options.exhale},
      {Measured::kDiaphragm, &options.surfaces},  {Measured::kLungs, &options.lung_surfaces},
      {Measured::kVolume, &options.volumes},      {Measured::kMMode, &options.m_modes},
      {Measured::kMarkers, &options.markers}};
  std::vector<MeasuredFile> files;
  for (const auto& [measured, texts] : lists) {
    for (const std::string& text : *texts) {
      absl::StatusOr<MeasuredFile> file = ReadOneFile(measured, text);
      if (!file.ok()) return file.status();
      files.push_back(*std::move(file));
    }
  }
  for (const std::string& text : options.errors) {
    const absl::StatusOr<GivenError> error = ReadError(text);
    if (!error.ok()) return error.status();
    bool used = false;
    for (MeasuredFile& file : files) {
      if (file.measured != error->measured) continue;
      file.error = error->value;
      used = true;
    }
    if (!used) {
      return absl::InvalidArgumentError(
          absl::StrCat("--error ", text, ": no --", std::string(fit::NameOf(error->measured)), " is given"));
    }
  }
  return files;
}

}  // namespace phrenic::client
