// A campaign's results: one file per finished run, FOLDER/cells/NAME.json. Files are written whole, so that a finished
// run is never repeated.
#ifndef PHRENIC_CLIENT_CAMPAIGN_RESULTS_H_
#define PHRENIC_CLIENT_CAMPAIGN_RESULTS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/campaign/plan.h"

namespace phrenic::client {

// Several processes may use one folder at a time, on one machine or over a shared file system.
class CampaignFolder {
 public:
  // Creates missing folders. PERMISSION_DENIED names the folder.
  static absl::StatusOr<CampaignFolder> Open(const std::string& folder);

  // True if the run is finished.
  bool Has(const CampaignCell& cell) const;
  // Returns the number of finished runs.
  std::int64_t Finished(const std::vector<CampaignCell>& cells) const;
  // Writes the result of one run. DATA_LOSS names the file if it cannot be written.
  absl::Status Write(const v1::CampaignResult& result) const;
  // Returns the results of the finished runs, in the order of `cells`. DATA_LOSS names a file that cannot be read.
  absl::StatusOr<v1::CampaignResult> Read(const std::vector<CampaignCell>& cells) const;
  const std::string& path() const { return path_; }

 private:
  explicit CampaignFolder(std::string path) : path_(std::move(path)) {}
  std::string FileOf(const std::string& cell) const;

  std::string path_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CAMPAIGN_RESULTS_H_
