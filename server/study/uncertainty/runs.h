// Many runs of one scene on several threads.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_RUNS_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_RUNS_H_

#include <span>
#include <string>
#include <vector>

#include "server/study/uncertainty/distribution.h"
#include "server/study/uncertainty/outputs.h"
#include "server/study/uncertainty/samples.h"

namespace phrenic::study {

inline constexpr long kMostRuns = 200'000;          // of one study
inline constexpr double kMostNumbers = 20'000'000;  // that the runs of one study give together, 8 bytes each

// INVALID_ARGUMENT "samples: ..." if so many runs, or what they give, are more than a study may have.
absl::Status CheckRuns(double runs, size_t numbers_per_run);

// What several runs gave, in the order of their parameters.
struct RunSet {
  std::vector<RunOutputs> each;
  // Returns the values of one output, one per run.
  std::vector<double> ValuesOf(size_t output) const;
  long CountFailed() const;
  std::string FirstProblem() const;  // empty if none failed
};

// Runs the scene with each of the parameters, every field set, on `threads` threads; 0: one per core. The number of
// threads changes no bit of the result. `progress` is called on the caller's thread, with `doing` and the number of
// runs. CANCELLED if it returns false, within a few steps of every run.
absl::StatusOr<RunSet> RunAll(const Outputs& outputs, std::span<const v1::Parameters> parameters, int threads,
                              const std::string& doing, const Progress& progress);

// The same with the inputs at each of the points and all else as in `nominal`.
absl::StatusOr<RunSet> RunAt(const Outputs& outputs, const std::vector<Input>& inputs, const v1::Parameters& nominal,
                             const UnitPoints& points, int threads, const std::string& doing, const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_RUNS_H_
