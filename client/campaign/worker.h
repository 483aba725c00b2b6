// The processes of a campaign and the runs of each.
#ifndef PHRENIC_CLIENT_CAMPAIGN_WORKER_H_
#define PHRENIC_CLIENT_CAMPAIGN_WORKER_H_

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/campaign/results.h"
#include "client/connection/context.h"

namespace phrenic::client {

// A share of the runs: those with index `number` modulo `count`.
struct Share {
  int number = 0, count = 1;
};
// Parses "3/16". INVALID_ARGUMENT quotes the text.
absl::StatusOr<Share> ReadShare(const std::string& text);

// Computes the unfinished runs of the share one after the other and writes a file for each. A run that diverges or that
// the server refuses is finished too; its row has the reason. CANCELLED after Ctrl-C.
absl::Status Work(const Context& context, const std::vector<CampaignCell>& cells, const Share& share,
                  const std::string& data_dir, const CampaignFolder& folder);

// Processes of this program that run `phrenic campaign work`.
struct Workers {
  std::vector<std::string> arguments;  // without --share
  int concurrent = 1;                  // number of processes at a time
};
// Runs `shares` shares, `concurrent` at a time, and waits for them. Calls `wait` ten times a second; if it returns
// false, ends all processes and returns CANCELLED. INTERNAL if a process fails.
absl::Status RunHere(const Workers& workers, int shares, const std::function<bool()>& wait);
// Runs the same as an array of Slurm jobs. Logs are written to `log_folder`. Requires: `sbatch`, `squeue` and `scancel`
// on the PATH.
absl::Status RunOnSlurm(const Workers& workers, int shares, const std::string& log_folder,
                        const std::function<bool()>& wait);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CAMPAIGN_WORKER_H_
