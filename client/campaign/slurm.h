// A campaign as an array of Slurm jobs.
#ifndef PHRENIC_CLIENT_CAMPAIGN_SLURM_H_
#define PHRENIC_CLIENT_CAMPAIGN_SLURM_H_

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace phrenic::client {

// Jobs that run `phrenic campaign work`.
struct SlurmJobs {
  std::vector<std::string> arguments;  // without --share
  int shares = 1;                      // number of jobs
  int concurrent = 1;                  // of them at a time
};

// Starts the jobs and waits for them. Calls `wait` ten times a second; if it returns false, cancels the jobs and
// returns CANCELLED. Logs are written to `log_folder`. INTERNAL with Slurm's message if it refuses the jobs. Requires:
// `sbatch`, `squeue` and `scancel` on the PATH.
absl::Status RunOnSlurm(const SlurmJobs& jobs, const std::string& log_folder, const std::function<bool()>& wait);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CAMPAIGN_SLURM_H_
