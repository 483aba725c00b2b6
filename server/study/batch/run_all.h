// The runs of a batch, on several threads.
#ifndef PHRENIC_SERVER_STUDY_BATCH_RUN_ALL_H_
#define PHRENIC_SERVER_STUDY_BATCH_RUN_ALL_H_

#include "absl/functional/function_ref.h"
#include "server/study/batch/batch.h"

namespace phrenic::study {

// Runs all wanted ones on batch.threads() threads of low priority, and calls `take` on the calling thread with each
// result as it ends. While `take` falls behind, runs wait: no more results than two a thread are in memory. CANCELLED
// if `take` returns false, or `cancelled`, which is asked often and on several threads, returns true; the first other
// error of a run.
absl::Status RunAll(const Batch& batch, absl::FunctionRef<bool(v1::BatchResult)> take,
                    const std::function<bool()>& cancelled);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_BATCH_RUN_ALL_H_
