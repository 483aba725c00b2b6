// The runs of a campaign on this machine, as batches (study::Batch).
#ifndef PHRENIC_CLIENT_CAMPAIGN_RUNS_H_
#define PHRENIC_CLIENT_CAMPAIGN_RUNS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "client/campaign/results.h"
#include "client/connection/context.h"

namespace phrenic::client {

// A share of the runs: those with index `number` modulo `count`.
struct Share {
  int number = 0, count = 1;
};
// Parses "3/16". INVALID_ARGUMENT quotes the text.
absl::StatusOr<Share> ReadShare(const std::string& text);

// Computes the unfinished runs of the share and writes a file for each as it ends: `threads` at a time, 0: one per
// core, which is also the most. The runs of one scene and preset are a batch; its scene is compiled when its first run
// begins. A run has the same bits at any number of threads, and as `phrenic run` has them. A run that diverges, or
// whose scene or preset is refused, is finished too; its row has the reason. Calls `finished` on the calling thread
// after every file. CANCELLED after Ctrl-C; INTERNAL if the error concerns more than a scene.
absl::Status RunCells(const Context& context, const std::vector<CampaignCell>& cells, const Share& share, int threads,
                      const std::string& data_dir, const CampaignFolder& folder, absl::FunctionRef<void()> finished);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CAMPAIGN_RUNS_H_
