// Many runs of one scene at different live parameters, each as a session would run it.
#ifndef PHRENIC_SERVER_STUDY_BATCH_BATCH_H_
#define PHRENIC_SERVER_STUDY_BATCH_BATCH_H_

#include <vector>

#include "phrenic/v1/batch.pb.h"
#include "server/stream/layout.h"
#include "server/study/context.h"

namespace phrenic::study {

inline constexpr int kMostBatchRuns = 100'000;          // of one request
inline constexpr double kMostSampledNumbers = 400'000;  // of one run: samples times measures

// A checked request. Immutable, thread-safe.
class Batch {
 public:
  // Compiles the scene, sets what the request leaves out and checks every run. INVALID_ARGUMENT names the field, such
  // as "runs[3].parameters.breath_force"; the errors of `compile`; CANCELLED if `cancelled`, asked for every run,
  // returns true.
  static absl::StatusOr<Batch> Make(v1::RunBatchRequest request, const Compiler& compile,
                                    const std::function<bool()>& cancelled);

  // Returns the runs that are wanted, all but `finished`, ascending.
  const std::vector<int>& wanted() const { return wanted_; }
  int threads() const;  // that the wanted runs are divided among; 0 if there are no such
  v1::BatchHeader Header() const;
  // Returns about the size of one result [byte].
  std::size_t ResultBytes() const;
  // Runs one of them on the calling thread. A divergence, or too much CPU time, is a result with `problem`. CANCELLED
  // if `cancelled`, asked every few steps, returns true. Requires: 0 <= run < runs_size() of the request.
  absl::StatusOr<v1::BatchResult> Run(int run, const std::function<bool()>& cancelled) const;

 private:
  Batch(v1::RunBatchRequest request, std::shared_ptr<const Model> model);
  absl::Status Check(const std::function<bool()>& cancelled) const;
  absl::Status CheckRun(int run) const;
  absl::Status SetWanted();
  // Returns what the request sets for a run.
  v1::Parameters ParametersOf(int run) const;
  // Returns the model with the parameters of a run, every field set, and its time step.
  absl::StatusOr<Subject> SubjectOf(int run) const;
  absl::StatusOr<State> StartOf(int run, const v1::Parameters& parameters) const;
  // Returns how many numbers a run's result has, without its state.
  double CountNumbers() const;

  v1::RunBatchRequest request_;
  std::vector<int> wanted_;
  std::shared_ptr<const Model> model_;
  stream::Layout layout_;
};

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_BATCH_BATCH_H_
