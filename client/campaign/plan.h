// A campaign's file and the runs it defines.
#ifndef PHRENIC_CLIENT_CAMPAIGN_PLAN_H_
#define PHRENIC_CLIENT_CAMPAIGN_PLAN_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/campaign.pb.h"
#include "phrenic/v1/session.pb.h"

namespace phrenic::client {

// One run: one combination of the campaign's lists.
struct CampaignCell {
  v1::CampaignRow row;  // cell, scene, resolution, preset and settings are set
  v1::SceneSource source;
  v1::Parameters parameters;
  double seconds = 0;  // simulated time [s]
};

// Reads, parses and validates the file. Errors name the file and the line.
absl::StatusOr<v1::Campaign> ReadCampaign(const std::string& file);
// Parses and validates the file's text.
absl::StatusOr<v1::Campaign> ParseCampaign(const std::string& file, const std::string& text);

// Returns the runs in the order of the lists; the last axis varies fastest. A cell's name is a prefix of the SHA-256 of
// scene, preset, parameters, length and Phrenic's version, that is, of all that may change the result. Scene files are
// relative to the folder of the campaign's `file`. INVALID_ARGUMENT names the scene or the axis, or says that there are
// more than a million runs or 64 axes.
absl::StatusOr<std::vector<CampaignCell>> CellsOf(const v1::Campaign& campaign, const std::string& file);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CAMPAIGN_PLAN_H_
