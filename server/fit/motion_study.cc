#include "server/fit/motion_study.h"

#include <algorithm>
#include <filesystem>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/fit/read_landmarks.h"

namespace phrenic::fit {
namespace {

absl::Status Named(const std::string& name, const absl::Status& status) {
  return {status.code(), absl::StrCat(name, ": ", status.message())};
}

// Predicts each person from the others.
void PredictFromOthers(MotionStudy& study) {
  for (StudiedPerson& person : study.people) {
    std::vector<const PersonMotion*> others;
    for (const StudiedPerson& other : study.people) {
      if (&other != &person) others.push_back(&other.fit.person);
    }
    if (others.empty()) continue;
    const MotionFit& fit = person.fit;
    const Eigen::VectorXd predicted = fit.held_out_responses * (fit.descent * Summarise(others).mean);
    const Points motion = fit.motion(Eigen::all, fit.halves.held_out);
    person.from_one_number = Summarise(Points(motion - predicted.reshaped(3, motion.cols())));
  }
}

absl::StatusOr<MotionFit> FindOrFit(const LungTemplates& templates, const StudyCase& each, const FitOptions& options,
                                    const FitProgress& progress, const KeptFits& kept) {
  if (kept.find) {
    if (std::optional<MotionFit> found = kept.find(each)) return *std::move(found);
  }
  absl::StatusOr<MotionFit> fit = FitMotion(templates, each.landmarks, options, progress);
  if (!fit.ok() || !kept.keep) return fit;
  if (absl::Status status = kept.keep(each, *fit); !status.ok()) return status;
  return fit;
}

bool IsLandmarkFile(const std::string& name) {
  return absl::EndsWithIgnoreCase(name, ".csv") || absl::EndsWithIgnoreCase(name, ".fcsv") ||
         absl::EndsWithIgnoreCase(name, ".mrk.json");
}

}  // namespace

absl::StatusOr<MotionStudy> StudyMotion(const LungTemplates& templates, const std::vector<StudyCase>& cases,
                                        const FitOptions& options, const FitProgress& progress, const KeptFits& kept) {
  if (cases.empty()) return absl::InvalidArgumentError("a study of motion needs one case at least");
  for (const StudyCase& each : cases) {
    if (each.landmarks.phase.size() == 0) continue;
    return Named(each.name, absl::InvalidArgumentError(
                                "has a column phase: a study is of end exhale and end inhale; leave others out"));
  }
  MotionStudy study = {options.numbers, {}, {}};
  for (size_t i = 0; i < cases.size(); ++i) {
    const FitProgress whole = [&](double done, std::string_view stage) {
      return !progress || progress((static_cast<double>(i) + done) / static_cast<double>(cases.size()),
                                   cases[i].name + ", " + std::string(stage));
    };
    absl::StatusOr<MotionFit> fit = FindOrFit(templates, cases[i], options, whole, kept);
    if (!fit.ok()) return Named(cases[i].name, fit.status());
    study.people.push_back({cases[i].name, static_cast<int>(cases[i].landmarks.size()), *std::move(fit), {}});
  }
  PredictFromOthers(study);
  std::vector<const PersonMotion*> all;
  for (const StudiedPerson& person : study.people) all.push_back(&person.fit.person);
  study.together = Summarise(all);
  return study;
}

absl::StatusOr<std::vector<StudyCase>> ReadCases(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> files;
  for (auto at = std::filesystem::directory_iterator(folder, error);
       !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
    if (IsLandmarkFile(at->path().string())) files.push_back(at->path().string());
  }
  if (error) return absl::NotFoundError(absl::StrCat("cannot read the folder ", folder, ": ", error.message()));
  if (files.empty())
    return absl::NotFoundError(absl::StrCat(folder, " has no .csv, .fcsv or .mrk.json of landmark pairs"));
  std::sort(files.begin(), files.end());
  std::vector<StudyCase> cases;
  for (const std::string& file : files) {
    absl::StatusOr<Landmarks> landmarks = ReadLandmarks({file});
    if (!landmarks.ok()) return landmarks.status();
    cases.push_back({std::filesystem::path(file).stem().string(), *std::move(landmarks)});
  }
  return cases;
}

ErrorSummary MeanOf(const std::vector<ErrorSummary>& errors) {
  ErrorSummary mean;
  for (const ErrorSummary& error : errors) {
    mean.mean += error.mean / static_cast<double>(errors.size());
    mean.p95 += error.p95 / static_cast<double>(errors.size());
  }
  return mean;
}

}  // namespace phrenic::fit
