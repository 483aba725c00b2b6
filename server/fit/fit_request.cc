#include "server/fit/fit_request.h"

#include <algorithm>
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

absl::StatusOr<Landmarks> ReadFile(const v1::FitMotionRequest& request, int index) {
  const v1::LandmarkFile& file = request.landmarks(index);
  const std::string field = absl::StrCat("landmarks[", index, "]");
  if (file.name().size() > kLongestFileName) {
    return absl::InvalidArgumentError(
        absl::StrCat(field, ".name: has ", file.name().size(), " characters, more than ", kLongestFileName));
  }
  return ParseLandmarks(file.name().empty() ? field : file.name(), file.content());
}

absl::StatusOr<Landmarks> ReadFiles(const v1::FitMotionRequest& request) {
  if (request.landmarks_size() > 2) {
    return absl::InvalidArgumentError(
        absl::StrCat("landmarks: ", request.landmarks_size(),
                     " files: give one of pairs, or one of end exhale and one of end inhale"));
  }
  absl::StatusOr<Landmarks> first = ReadFile(request, 0);
  if (!first.ok() || request.landmarks_size() == 1) return first;
  absl::StatusOr<Landmarks> second = ReadFile(request, 1);
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

absl::Status CheckOptions(const v1::FitMotionRequest& request) {
  if (request.has_modes() && request.modes() != 8 && request.modes() != 12) {
    return absl::InvalidArgumentError(absl::StrCat("modes: ", request.modes(), " is neither 8 nor 12"));
  }
  if (!IsSceneName(request.scene_name())) {
    return absl::InvalidArgumentError(
        absl::StrFormat("scene_name: give at most %d characters of a-z, 0-9 and \"-\"", kLongestSceneName));
  }
  if (request.show_landmarks() && request.assimilate()) {
    return absl::InvalidArgumentError("show_landmarks: shows what the numbers leave: leave assimilate out");
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<RequestedFit> ReadFitRequest(const v1::FitMotionRequest& request) {
  if (absl::Status status = CheckOptions(request); !status.ok()) return status;
  absl::StatusOr<Landmarks> landmarks = ReadFiles(request);
  if (!landmarks.ok()) return landmarks.status();
  if (landmarks->size() > kMostPairs) {
    return absl::InvalidArgumentError(absl::StrFormat("landmarks: %d pairs are more than %d: send every %dth",
                                                      landmarks->size(), kMostPairs,
                                                      (landmarks->size() + kMostPairs - 1) / kMostPairs));
  }
  RequestedFit requested;
  requested.landmarks = *std::move(landmarks);
  if (request.has_modes()) requested.options.numbers = request.modes();
  if (request.has_split()) requested.options.split = static_cast<std::uint64_t>(request.split());
  requested.options.assimilate = request.assimilate();
  requested.scene_name = request.scene_name().empty() ? "person" : request.scene_name();
  requested.source = SourceOf(request);
  requested.show_landmarks = request.show_landmarks();
  return requested;
}

absl::StatusOr<v1::MotionFitResult> FitRequested(const RequestedFit& requested, const SceneLungs& lungs,
                                                 const FitProgress& progress) {
  const absl::StatusOr<MotionFit> fit = FitMotion(lungs.templates, requested.landmarks, requested.options, progress);
  if (!fit.ok()) return fit.status();
  v1::MotionFitResult result = FitMessage(*fit, requested.options);
  v1::Scene scene = FittedScene(requested.scene_name, requested.source, lungs, *fit, requested.options.numbers,
                                requested.show_landmarks);
  if (const absl::Status status = schema::Validate(scene); status.ok()) {
    *result.mutable_scene() = std::move(scene);
  } else {
    result.set_scene_problem(absl::StrCat("this motion is beyond that of a breath: ", status.message()));
  }
  return result;
}

}  // namespace phrenic::fit
