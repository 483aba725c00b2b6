// What a campaign is made of: its file, and the runs that it asks for.
#ifndef PHRENIC_CLIENT_CAMPAIGN_PLAN_H_
#define PHRENIC_CLIENT_CAMPAIGN_PLAN_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/campaign.pb.h"
#include "phrenic/v1/session.pb.h"

namespace phrenic::client {

// One run: a cell of the product of what the campaign lists.
struct CampaignCell {
  v1::CampaignRow row;  // with what names it: cell, scene, resolution, preset, settings
  v1::SceneSource source;
  v1::Parameters parameters;
  double seconds = 0;
};

// Reads, parses and validates the file; errors name it and the line.
absl::StatusOr<v1::Campaign> ReadCampaign(const std::string& file);

// The runs in the order of the lists, the last axis fastest. A cell's name is the SHA-256 of scene, parameters, length
// and Phrenic's version, so that it changes with whatever may change the result. `file` is the campaign's: scenes are
// looked for beside it. Errors name the scene or the axis.
absl::StatusOr<std::vector<CampaignCell>> CellsOf(const v1::Campaign& campaign, const std::string& file);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CAMPAIGN_PLAN_H_
