// A fit as a server is asked for it: v1.FitMotionRequest to v1.MotionFitResult, with the numbers of `phrenic fit`.
#ifndef PHRENIC_SERVER_FIT_FIT_REQUEST_H_
#define PHRENIC_SERVER_FIT_FIT_REQUEST_H_

#include <functional>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/fit.pb.h"
#include "server/fit/evidence.h"
#include "server/fit/motion_fit.h"
#include "server/fit/motion_study.h"
#include "server/fit/scene_lungs.h"

namespace phrenic::fit {

inline constexpr int kMostPairs = 20'000;  // of one request: a fit of so many takes 3 s

inline constexpr int kMostMeasuredFiles = 64;
inline constexpr std::size_t kMostMeasuredBytes = 64 << 20;  // of all files together

// A checked request.
struct RequestedFit {
  Landmarks landmarks;               // fitted alone, if there is no evidence
  std::optional<Evidence> evidence;  // of several kinds
  FitOptions options;
  std::string scene_name;
  std::string source;  // the files' names, for the scene's description
  bool show_landmarks = false;
};

// Parses the landmarks and checks the options. INVALID_ARGUMENT "name:line: ...", or names the field. Requires:
// schema::Validate. Thread-safe, like FitRequested.
absl::StatusOr<RequestedFit> ReadFitRequest(const v1::FitMotionRequest& request);

// Fits. The errors of FitMotion or FitJointly.
absl::StatusOr<v1::MotionFitResult> FitRequested(const RequestedFit& requested, const SceneLungs& lungs,
                                                 const FitProgress& progress);

inline constexpr int kMostCases = 64;                    // people of one study
inline constexpr Eigen::Index kMostStudyPairs = 50'000;  // of all of them

struct RequestedStudy {
  std::vector<StudyCase> cases;
  FitOptions options;
};

// Parses the landmarks of each case, as ReadFitRequest does, and checks names and options.
absl::StatusOr<RequestedStudy> ReadStudyRequest(const v1::StudyMotionRequest& request);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_FIT_REQUEST_H_
