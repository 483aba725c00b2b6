// What a campaign's runs came to: a file a run in FOLDER/cells, there whole or not at all, so that a run that was
// finished is never computed again, whoever was killed in between.
#ifndef PHRENIC_CLIENT_CAMPAIGN_RESULTS_H_
#define PHRENIC_CLIENT_CAMPAIGN_RESULTS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/campaign/plan.h"

namespace phrenic::client {

// Any number of processes may use one folder at once, on one machine or over a shared file system.
class CampaignFolder {
 public:
  // Makes the folder where it is missing; errors name it.
  static absl::StatusOr<CampaignFolder> Open(const std::string& folder);

  bool Has(const CampaignCell& cell) const;
  // How many of the runs are finished.
  std::int64_t Finished(const std::vector<CampaignCell>& cells) const;
  absl::Status Write(const v1::CampaignResult& result) const;
  // Of the finished ones, in the plan's order. DATA_LOSS names a file that cannot be read: remove it to run it again.
  absl::StatusOr<v1::CampaignResult> Read(const std::vector<CampaignCell>& cells) const;
  const std::string& path() const { return path_; }

 private:
  explicit CampaignFolder(std::string path) : path_(std::move(path)) {}
  std::string FileOf(const std::string& cell) const;

  std::string path_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CAMPAIGN_RESULTS_H_
