// A campaign's results for people: a table, and one HTML file that needs nothing else.
#ifndef PHRENIC_CLIENT_CAMPAIGN_REPORT_H_
#define PHRENIC_CLIENT_CAMPAIGN_REPORT_H_

#include <string>
#include <vector>

#include "client/print/table.h"
#include "phrenic/v1/campaign.pb.h"

namespace phrenic::client {

// A line a run: what was chosen, how it went, and the greatest value of each measure, in the units that people know.
// Columns in which all runs agree on nothing (no preset, no resolution) are left out.
Table CampaignTable(const v1::CampaignResult& result);

// The table, its numbers shaded from the column's least to its greatest, under what passed which limit.
std::string CampaignPage(const v1::Campaign& campaign, const v1::CampaignResult& result,
                         const std::vector<std::string>& passed_limits);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CAMPAIGN_REPORT_H_
