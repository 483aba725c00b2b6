#include "server/fit/fit_request.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "server/fit/fit_message.h"
#include "server/fit/person_scene.h"
#include "server/fit/read_landmarks.h"
#include "server/schema/schema.h"

namespace phrenic::fit {
namespace {

constexpr std::size_t kLongestFileName = 255, kLongestSceneName = 64;

bool IsPrintable(std::string_view text) {
  return std::ranges::all_of(text, [](unsigned char c) { return c >= 0x20 && c < 0x7f; });
}

bool IsSceneName(std::string_view name) {
  return name.size() <= kLongestSceneName &&
         std::ranges::all_of(name, [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; });
}

// Of FitMotionRequest.landmarks or MotionCase.landmarks.
using LandmarkFiles = google::protobuf::RepeatedPtrField<v1::LandmarkFile>;

absl::StatusOr<Landmarks> ReadFile(const LandmarkFiles& files, int index, const std::string& path) {
  const v1::LandmarkFile& file = files[index];
  const std::string field = absl::StrCat(path, "[", index, "]");
  if (file.name().size() > kLongestFileName) {
    return absl::InvalidArgumentError(
        absl::StrCat(field, ".name: has ", file.name().size(), " characters, more than ", kLongestFileName));
  }
  return ParseLandmarks(file.name().empty() ? field : file.name(), file.content());
}

absl::StatusOr<Landmarks> ReadFiles(const LandmarkFiles& files, const std::string& path) {
  if (files.empty()) return absl::InvalidArgumentError(absl::StrCat(path, ": is required"));
  if (files.size() > 2) {
    return absl::InvalidArgumentError(absl::StrCat(
        path, ": ", files.size(), " files: give one of pairs, or one of end exhale and one of end inhale"));
  }
  absl::StatusOr<Landmarks> first = ReadFile(files, 0, path);
  if (!first.ok() || files.size() == 1) return first;
  absl::StatusOr<Landmarks> second = ReadFile(files, 1, path);
  if (!second.ok()) return second;
  return PairLandmarks(*first, *second);
}

std::string SourceOf(const v1::FitMotionRequest& request) {
  std::vector<std::string> names;
  for (const v1::LandmarkFile& file : request.landmarks()) {
    if (!file.name().empty() && IsPrintable(file.name())) names.push_back(file.name());
  }
  return names.empty() ? "landmarks" : absl::StrJoin(names, " and ");
}

absl::Status CheckModes(int modes, bool given) {
  if (!given || modes == 8 || modes == 12) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("modes: ", modes, " is neither 8 nor 12"));
}

absl::Status CheckOptions(const v1::FitMotionRequest& request) {
  if (absl::Status status = CheckModes(request.modes(), request.has_modes()); !status.ok()) return status;
  if (!IsSceneName(request.scene_name())) {
    return absl::InvalidArgumentError(
        absl::StrFormat("scene_name: give at most %d characters of a-z, 0-9 and \"-\"", kLongestSceneName));
  }
  if (request.measured_size() > 0 && request.landmarks_size() > 0) {
    return absl::InvalidArgumentError("landmarks: give them among measured, with the other kinds");
  }
  if (request.measured_size() > 0 && request.assimilate()) {
    return absl::InvalidArgumentError("assimilate: belongs to landmarks alone: leave measured out");
  }
  if (request.measured_size() == 0 && request.landmarks_size() == 0) {
    return absl::InvalidArgumentError("landmarks: is required, or measured");
  }
  if (request.show_landmarks() && request.assimilate()) {
    return absl::InvalidArgumentError("show_landmarks: shows what the numbers leave: leave assimilate out");
  }
  return absl::OkStatus();
}

absl::Status CheckPairCount(const Landmarks& landmarks) {
  if (landmarks.size() <= kMostPairs) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat("landmarks: %d pairs are more than %d: send every %dth",
                                                    landmarks.size(), kMostPairs,
                                                    (landmarks.size() + kMostPairs - 1) / kMostPairs));
}

absl::StatusOr<Measured> KindOf(v1::MeasuredKind kind) {
  switch (kind) {
    case v1::MEASURED_KIND_LANDMARKS:
      return Measured::kLandmarks;
    case v1::MEASURED_KIND_EXHALE:
      return Measured::kExhale;
    case v1::MEASURED_KIND_DIAPHRAGM:
      return Measured::kDiaphragm;
    case v1::MEASURED_KIND_LUNGS:
      return Measured::kLungs;
    case v1::MEASURED_KIND_VOLUME:
      return Measured::kVolume;
    case v1::MEASURED_KIND_M_MODE:
      return Measured::kMMode;
    case v1::MEASURED_KIND_MARKERS:
      return Measured::kMarkers;
    default:
      return absl::InvalidArgumentError("unknown");
  }
}

absl::StatusOr<Evidence> ReadEvidence(const v1::FitMotionRequest& request) {
  if (request.measured_size() > kMostMeasuredFiles) {
    return absl::InvalidArgumentError(
        absl::StrCat("measured: ", request.measured_size(), " files are more than ", kMostMeasuredFiles));
  }
  std::size_t bytes = 0;
  std::vector<MeasuredFile> files;
  for (int i = 0; i < request.measured_size(); ++i) {
    const v1::MeasuredFile& sent = request.measured(i);
    const absl::StatusOr<Measured> kind = KindOf(sent.kind());
    if (!kind.ok()) return absl::InvalidArgumentError(absl::StrCat("measured[", i, "].kind: is unknown"));
    if (sent.name().size() > kLongestFileName || !IsPrintable(sent.name())) {
      return absl::InvalidArgumentError(
          absl::StrCat("measured[", i, "].name: give at most ", kLongestFileName, " characters of ASCII"));
    }
    if (sent.side() != v1::SIDE_UNSPECIFIED && *kind != Measured::kMMode) {
      return absl::InvalidArgumentError(absl::StrCat("measured[", i, "].side: only an M-mode has a side"));
    }
    bytes += sent.content().size();
    MeasuredFile& file = files.emplace_back();
    file.measured = *kind;
    file.name = sent.name();
    file.bytes = sent.content();
    if (sent.has_phase()) file.phase = sent.phase();
    if (sent.has_error()) file.error = sent.error();
    file.side = sent.side() == v1::SIDE_LEFT ? kLeft : kRight;
    file.at_exhale = sent.at_exhale();
  }
  if (bytes > kMostMeasuredBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat("measured: the files have more than ", kMostMeasuredBytes >> 20, " MiB"));
  }
  absl::StatusOr<Evidence> evidence = ParseEvidence(files);
  if (!evidence.ok()) return evidence;
  if (absl::Status status = CheckPairCount(evidence->landmarks); !status.ok()) return status;
  return evidence;
}

// Landmarks of several times, by a column of their file.
absl::StatusOr<Evidence> ReadPhases(const v1::FitMotionRequest& request) {
  if (request.assimilate()) return absl::InvalidArgumentError("assimilate: belongs to landmarks of one time");
  MeasuredFile file;
  file.name = request.landmarks(0).name().empty() ? "landmarks[0]" : request.landmarks(0).name();
  file.bytes = request.landmarks(0).content();
  return ParseEvidence({file});
}

std::string MeasuredNames(const v1::FitMotionRequest& request) {
  std::vector<std::string> names;
  for (const v1::MeasuredFile& file : request.measured()) names.push_back(file.name());
  return absl::StrJoin(names, ", ");
}

// Sets the scene, or the reason why the fit gives no scene.
void SetScene(v1::Scene scene, v1::MotionFitResult& result) {
  if (const absl::Status status = schema::Validate(scene); status.ok()) {
    *result.mutable_scene() = std::move(scene);
  } else {
    result.set_scene_problem(absl::StrCat("this motion is beyond that of a breath: ", status.message()));
  }
}

}  // namespace

absl::StatusOr<RequestedFit> ReadFitRequest(const v1::FitMotionRequest& request) {
  if (absl::Status status = CheckOptions(request); !status.ok()) return status;
  RequestedFit requested;
  if (request.measured_size() > 0) {
    absl::StatusOr<Evidence> evidence = ReadEvidence(request);
    if (!evidence.ok()) return evidence.status();
    requested.evidence = *std::move(evidence);
  } else {
    absl::StatusOr<Landmarks> landmarks = ReadFiles(request.landmarks(), "landmarks");
    if (!landmarks.ok()) return landmarks.status();
    if (absl::Status status = CheckPairCount(*landmarks); !status.ok()) return status;
    if (landmarks->phase.size() > 0) {
      absl::StatusOr<Evidence> evidence = ReadPhases(request);
      if (!evidence.ok()) return evidence.status();
      requested.evidence = *std::move(evidence);
    }
    requested.landmarks = *std::move(landmarks);
  }
  if (request.has_modes()) requested.options.numbers = request.modes();
  if (request.has_split()) requested.options.split = static_cast<std::uint64_t>(request.split());
  requested.options.assimilate = request.assimilate();
  requested.scene_name = request.scene_name().empty() ? "person" : request.scene_name();
  requested.source = request.measured_size() > 0 ? MeasuredNames(request) : SourceOf(request);
  requested.show_landmarks = request.show_landmarks();
  return requested;
}

absl::StatusOr<RequestedStudy> ReadStudyRequest(const v1::StudyMotionRequest& request) {
  if (absl::Status status = CheckModes(request.modes(), request.has_modes()); !status.ok()) return status;
  if (request.cases().empty() || request.cases_size() > kMostCases) {
    return absl::InvalidArgumentError(absl::StrCat("cases: give 1 to ", kMostCases, " people"));
  }
  RequestedStudy study;
  std::set<std::string> names;
  Eigen::Index pairs = 0;
  for (int i = 0; i < request.cases_size(); ++i) {
    const v1::MotionCase& each = request.cases(i);
    const std::string path = absl::StrCat("cases[", i, "]");
    if (each.name().empty() || each.name().size() > kLongestSceneName || !IsPrintable(each.name())) {
      return absl::InvalidArgumentError(
          absl::StrCat(path, ".name: give 1 to ", kLongestSceneName, " printable characters of ASCII"));
    }
    if (!names.insert(each.name()).second) {
      return absl::InvalidArgumentError(absl::StrCat(path, ".name: another case has the name ", each.name()));
    }
    absl::StatusOr<Landmarks> landmarks = ReadFiles(each.landmarks(), absl::StrCat(path, ".landmarks"));
    if (!landmarks.ok()) return landmarks.status();
    pairs += landmarks->size();
    if (pairs > kMostStudyPairs) {
      return absl::InvalidArgumentError(absl::StrCat("cases: more than ", kMostStudyPairs,
                                                     " pairs together: send fewer people or every second pair"));
    }
    study.cases.push_back({each.name(), *std::move(landmarks)});
  }
  if (request.has_modes()) study.options.numbers = request.modes();
  if (request.has_split()) study.options.split = static_cast<std::uint64_t>(request.split());
  return study;
}

absl::StatusOr<v1::MotionFitResult> FitRequested(const RequestedFit& requested, const SceneLungs& lungs,
                                                 const FitProgress& progress) {
  const int numbers = requested.options.numbers;
  if (requested.evidence) {
    const absl::StatusOr<JointFit> fit = FitJointly(lungs.templates, *requested.evidence, requested.options, progress);
    if (!fit.ok()) return fit.status();
    v1::MotionFitResult result = JointFitMessage(*fit, requested.options);
    SetScene(JointScene(requested.scene_name, requested.source, lungs, *fit, numbers, requested.show_landmarks),
             result);
    return result;
  }
  const absl::StatusOr<MotionFit> fit = FitMotion(lungs.templates, requested.landmarks, requested.options, progress);
  if (!fit.ok()) return fit.status();
  v1::MotionFitResult result = FitMessage(*fit, requested.options);
  SetScene(FittedScene(requested.scene_name, requested.source, lungs, *fit, numbers, requested.show_landmarks), result);
  return result;
}

}  // namespace phrenic::fit
