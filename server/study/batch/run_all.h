// The runs of a batch, on several threads.
#ifndef PHRENIC_SERVER_STUDY_BATCH_RUN_ALL_H_
#define PHRENIC_SERVER_STUDY_BATCH_RUN_ALL_H_

#include "absl/functional/function_ref.h"
#include "server/study/batch/batch.h"

namespace phrenic::study {

// Runs all wanted ones by RunOnThreads, on batch.threads() threads of low priority. Its errors.
absl::Status RunAll(const Batch& batch, absl::FunctionRef<bool(v1::BatchResult)> take,
                    absl::FunctionRef<bool()> cancelled);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_BATCH_RUN_ALL_H_
