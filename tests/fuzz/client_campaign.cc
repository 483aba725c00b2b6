// Any bytes as a campaign file give runs with valid names and parameters, or an error; their results as any JSON give a
// table and a page, or an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "client/campaign/plan.h"
#include "client/campaign/report.h"
#include "google/protobuf/util/json_util.h"

namespace phrenic::client {
namespace {

constexpr std::size_t kMostCells = 2'000;  // for speed

void TryFile(const std::string& text) {
  const auto campaign = ParseCampaign("fuzz", text);
  if (!campaign.ok()) {
    if (campaign.status().message().substr(0, 5) != "fuzz:") std::abort();
    return;
  }
  double runs = 1;
  for (const v1::CampaignAxis& axis : campaign->axes()) runs *= axis.values_size();
  if (runs * campaign->scenes_size() > kMostCells && runs < 2e6) return;
  for (const std::string& scene : campaign->scenes()) {
    if (scene.find('/') != std::string::npos || scene.find('.') != std::string::npos) return;  // reads files
  }
  const auto cells = CellsOf(*campaign, "fuzz");
  if (!cells.ok()) return;
  v1::CampaignResult result;
  for (const CampaignCell& cell : *cells) {
    if (cell.row.cell().size() != 16 || !(cell.seconds > 0)) std::abort();
    *result.add_rows() = cell.row;
  }
  CampaignPage(*campaign, result, {});
}

void TryResult(const std::string& text) {
  v1::CampaignResult result;
  if (!google::protobuf::util::JsonStringToMessage(text, &result).ok()) return;
  std::ostringstream out;
  CampaignTable(result).Print(out, 80);
  CampaignTable(result).PrintCsv(out);
  CampaignPage(v1::Campaign(), result, {"a limit"});
}

}  // namespace
}  // namespace phrenic::client

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  phrenic::client::TryFile(text);
  phrenic::client::TryResult(text);
  return 0;
}
