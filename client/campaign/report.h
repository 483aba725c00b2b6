// A campaign's results as a table and as a self-contained HTML page.
#ifndef PHRENIC_CLIENT_CAMPAIGN_REPORT_H_
#define PHRENIC_CLIENT_CAMPAIGN_REPORT_H_

#include <string>
#include <vector>

#include "client/print/table.h"
#include "phrenic/v1/campaign.pb.h"

namespace phrenic::client {

// Returns one row per run: its settings, its outcome and the greatest value of each measure, in the units of
// ReadingText. Leaves out columns that are empty in all rows.
Table CampaignTable(const v1::CampaignResult& result);

// Returns the HTML page: the exceeded limits, then the table, with numbers shaded from each column's smallest to its
// greatest.
std::string CampaignPage(const v1::Campaign& campaign, const v1::CampaignResult& result,
                         const std::vector<std::string>& exceeded_limits);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CAMPAIGN_REPORT_H_
