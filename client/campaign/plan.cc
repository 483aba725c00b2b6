#include "client/campaign/plan.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/scene_argument.h"
#include "client/files/whole_file.h"
#include "server/crypto/sha256.h"
#include "server/schema/schema.h"

namespace phrenic::client {
namespace {

constexpr size_t kNameDigits = 16;
constexpr double kMostCells = 1e6;
constexpr int kMostAxes = 64;

using Settings = std::vector<std::string>;  // "time_step=0.001"

// Checks the number of runs before they are made.
absl::Status CheckSize(const v1::Campaign& campaign) {
  if (campaign.axes_size() > kMostAxes) {
    return absl::InvalidArgumentError(absl::StrCat("axes: more than ", kMostAxes, " parameters: split the campaign"));
  }
  double runs = campaign.scenes_size() * std::max(1.0, static_cast<double>(campaign.resolutions_mm_size())) *
                std::max(1.0, static_cast<double>(campaign.presets_size()));
  for (const v1::CampaignAxis& axis : campaign.axes()) runs *= axis.values_size();
  if (runs <= kMostCells) return absl::OkStatus();
  return absl::InvalidArgumentError("more than a million runs: split the campaign");
}

// Returns all combinations of one value per axis.
std::vector<Settings> SettingsOf(const v1::Campaign& campaign) {
  std::vector<Settings> all(1);
  for (const v1::CampaignAxis& axis : campaign.axes()) {
    std::vector<Settings> longer;
    for (const Settings& settings : all) {
      for (const std::string& value : axis.values()) {
        longer.push_back(settings);
        longer.back().push_back(absl::StrCat(axis.parameter(), "=", value));
      }
    }
    all = std::move(longer);
  }
  return all;
}

std::string ScenePath(const std::string& scene, const std::string& campaign_file) {
  if (!absl::EndsWith(scene, ".textproto")) return scene;
  return (std::filesystem::path(campaign_file).parent_path() / scene).string();
}

// Returns the list, or `own` as its only entry if it is empty.
template <typename List, typename Value>
std::vector<Value> OrOne(const List& list, Value own) {
  std::vector<Value> all(list.begin(), list.end());
  if (all.empty()) all.push_back(own);
  return all;
}

std::string CellName(const CampaignCell& cell) {
  std::string bytes = absl::StrCat(PHRENIC_VERSION, "\n", cell.row.preset(), "\n", cell.seconds, "\n");
  absl::StrAppend(&bytes, cell.source.SerializeAsString(), "\n", cell.parameters.SerializeAsString());
  return Sha256Hex(bytes).substr(0, kNameDigits);
}

absl::StatusOr<CampaignCell> MakeCell(const v1::Campaign& campaign, const v1::SceneSource& source,
                                      const std::string& scene, const std::string& preset, const Settings& settings) {
  CampaignCell cell;
  const absl::StatusOr<v1::Parameters> parameters = ReadSettings(settings);
  if (!parameters.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("axes: ", std::string(parameters.status().message())));
  }
  cell.parameters = *parameters;
  cell.source = source;
  cell.seconds = campaign.seconds();
  cell.row.set_scene(scene);
  cell.row.set_resolution_mm(source.resolution_mm());
  cell.row.set_preset(preset);
  cell.row.set_settings(absl::StrJoin(settings, " "));
  cell.row.set_cell(CellName(cell));
  return cell;
}

}  // namespace

absl::StatusOr<v1::Campaign> ReadCampaign(const std::string& file) {
  const absl::StatusOr<std::string> text = ReadWhole(file, "the campaign");
  if (!text.ok()) return text.status();
  return ParseCampaign(file, *text);
}

absl::StatusOr<v1::Campaign> ParseCampaign(const std::string& file, const std::string& text) {
  v1::Campaign campaign;
  if (absl::Status status = schema::ParseText(file, text, &campaign); !status.ok()) return status;
  schema::FillDefaults(&campaign);
  return campaign;
}

absl::StatusOr<std::vector<CampaignCell>> CellsOf(const v1::Campaign& campaign, const std::string& file) {
  if (absl::Status status = CheckSize(campaign); !status.ok()) return status;
  const std::vector<Settings> settings = SettingsOf(campaign);
  std::vector<CampaignCell> cells;
  std::set<std::string> names;
  for (const std::string& scene : campaign.scenes()) {
    for (const double resolution : OrOne(campaign.resolutions_mm(), 0.0)) {
      const auto source = ReadScene({ScenePath(scene, file), resolution});
      if (!source.ok()) return source.status();
      for (const std::string& preset : OrOne(campaign.presets(), std::string())) {
        for (const Settings& chosen : settings) {
          auto cell = MakeCell(campaign, *source, scene, preset, chosen);
          if (!cell.ok()) return cell.status();
          if (names.insert(cell->row.cell()).second) cells.push_back(*std::move(cell));
        }
      }
    }
  }
  return cells;
}

}  // namespace phrenic::client
