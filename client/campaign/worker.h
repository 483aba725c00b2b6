// One process' share of a campaign, and the processes that take them.
#ifndef PHRENIC_CLIENT_CAMPAIGN_WORKER_H_
#define PHRENIC_CLIENT_CAMPAIGN_WORKER_H_

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/campaign/results.h"
#include "client/connection/connection.h"

namespace phrenic::client {

// Of `of` shares the one with this number, from 0: every `of`th run.
struct Share {
  int number = 0, of = 1;
};
// From "3/16"; INVALID_ARGUMENT says what is wrong.
absl::StatusOr<Share> ReadShare(const std::string& text);

// Runs those of the share that are not finished, one after the other, each to a file of its own. A run that diverges,
// or that the server refuses, is finished too: its row says why. CANCELLED where somebody interrupts.
absl::Status Work(const Context& context, const std::vector<CampaignCell>& cells, const Share& share,
                  const std::string& data_dir, const CampaignFolder& folder);

// `phrenic campaign work` as processes of this program: what they are called with, but for the share.
struct Workers {
  std::vector<std::string> arguments;
  int at_once = 1;
};
// Runs as many shares as there are, `at_once` processes at a time, until all have ended; `wait` is called ten times a
// second. Where it gives false they are ended. INTERNAL names the first that failed.
absl::Status RunHere(const Workers& workers, int shares, const std::function<bool()>& wait);
// The same as an array of Slurm jobs: `sbatch` and `squeue` must be on the path. Logs go to the folder.
absl::Status RunOnSlurm(const Workers& workers, int shares, const std::string& log_folder,
                        const std::function<bool()>& wait);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CAMPAIGN_WORKER_H_
