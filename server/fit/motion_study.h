// Fits and judges many people: each by their own numbers, and by one number with what the others have in common.
#ifndef PHRENIC_SERVER_FIT_MOTION_STUDY_H_
#define PHRENIC_SERVER_FIT_MOTION_STUDY_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/fit/motion_fit.h"

namespace phrenic::fit {

struct StudyCase {
  std::string name;
  Landmarks landmarks;
};

struct StudiedPerson {
  std::string name;
  int pairs;
  MotionFit fit;
  // The held-out half, predicted from this person's descent and the other people's motion; empty with one person.
  std::optional<ErrorSummary> from_one_number;
};

struct MotionStudy {
  int numbers;
  std::vector<StudiedPerson> people;
  PeopleMotion together;  // of all people
};

// Where the fits of finished people are kept. Either function may be empty.
struct KeptFits {
  std::function<std::optional<MotionFit>(const StudyCase&)> find;
  std::function<absl::Status(const StudyCase&, const MotionFit&)> keep;
};

// Fits every case but those that `kept` finds, and keeps each when it is finished. The errors of FitMotion and of
// `keep`, with the case's name; INVALID_ARGUMENT without cases. `progress` as in FitMotion, of the whole study. The
// same cases and options give the same bits.
absl::StatusOr<MotionStudy> StudyMotion(const LungTemplates& templates, const std::vector<StudyCase>& cases,
                                        const FitOptions& options, const FitProgress& progress = {},
                                        const KeptFits& kept = {});

// Reads every file of pairs in a folder, by name: .csv, .fcsv and .mrk.json. NOT_FOUND if the folder does not exist or
// has none; the errors of ReadLandmarks.
absl::StatusOr<std::vector<StudyCase>> ReadCases(const std::string& folder);

// Returns the mean over people of the mean and of the 95th percentile.
ErrorSummary MeanOf(const std::vector<ErrorSummary>& errors);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_MOTION_STUDY_H_
