// What the result of a batch's run keeps of its states: samples of the measures, or a summary of them.
#ifndef PHRENIC_SERVER_STUDY_BATCH_RUN_READER_H_
#define PHRENIC_SERVER_STUDY_BATCH_RUN_READER_H_

#include <cstdint>
#include <memory>

#include "phrenic/v1/batch.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Reads one run into its result. Not thread-safe.
class RunReader {
 public:
  // Requires: seconds and frames_per_second of the request are set. `subject` and `result` outlive the reader.
  static std::unique_ptr<RunReader> Make(const v1::RunBatchRequest& request, const Subject& subject, const State& start,
                                         v1::BatchResult& result);
  virtual ~RunReader() = default;
  RunReader(const RunReader&) = delete;
  RunReader& operator=(const RunReader&) = delete;

  // Requires: called with the state after every step, in their order. Reads those that are due.
  void Look(const State& state);
  // Returns the number of steps of the whole run.
  virtual std::int64_t steps() const = 0;
  // Returns the state that was read last, or `otherwise` if none was.
  const State& LastOr(const State& otherwise) const { return has_read_ ? last_ : otherwise; }

 protected:
  RunReader(const Subject& subject, const State& start);

 private:
  // True if the state after that many steps is read.
  virtual bool IsDue(std::int64_t step) = 0;
  virtual void Read(const State& state, const EvalContext& at) = 0;

  const Subject& subject_;
  Workspace work_;
  const std::int64_t start_;
  bool has_read_ = false;
  State last_;
};

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_BATCH_RUN_READER_H_
