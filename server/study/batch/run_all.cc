#include "server/study/batch/run_all.h"

#include "server/jobs/thread_priority.h"
#include "server/study/batch/run_pool.h"

namespace phrenic::study {

absl::Status RunAll(const Batch& batch, absl::FunctionRef<bool(v1::BatchResult)> take,
                    absl::FunctionRef<bool()> cancelled) {
  const MakeResult<v1::BatchResult> make = [&batch](std::size_t run, const std::function<bool()>& ended) {
    jobs::LowerThreadPriority();
    return batch.Run(batch.wanted()[run], ended);
  };
  return RunOnThreads(batch.wanted().size(), batch.threads(), make, take, cancelled);
}

}  // namespace phrenic::study
