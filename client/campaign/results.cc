#include "client/campaign/results.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "absl/strings/str_cat.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "server/schema/file_bytes.h"

namespace phrenic::client {

absl::StatusOr<CampaignFolder> CampaignFolder::Open(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder + "/cells", error);
  if (error) return absl::PermissionDeniedError(absl::StrCat("cannot make ", folder, "/cells: ", error.message()));
  return CampaignFolder(folder);
}

std::string CampaignFolder::FileOf(const std::string& cell) const {
  return absl::StrCat(path_, "/cells/", cell, ".json");
}

bool CampaignFolder::Has(const CampaignCell& cell) const { return std::filesystem::exists(FileOf(cell.row.cell())); }

std::int64_t CampaignFolder::Finished(const std::vector<CampaignCell>& cells) const {
  return std::count_if(cells.begin(), cells.end(), [this](const CampaignCell& cell) { return Has(cell); });
}

absl::Status CampaignFolder::Write(const v1::CampaignResult& result) const {
  return WriteWhole(FileOf(result.rows(0).cell()), Json(result) + "\n");
}

absl::StatusOr<v1::CampaignResult> CampaignFolder::Read(const std::vector<CampaignCell>& cells) const {
  v1::CampaignResult all;
  for (const CampaignCell& cell : cells) {
    const std::string file = FileOf(cell.row.cell());
    const std::optional<std::string> text = ReadBytes(file);
    if (!text.has_value()) continue;  // not finished
    v1::CampaignResult one;
    if (!google::protobuf::util::JsonStringToMessage(*text, &one).ok() || one.rows_size() != 1) {
      return absl::DataLossError(absl::StrCat(file, " is not a run's result: remove it to repeat the run"));
    }
    all.MergeFrom(one);
  }
  return all;
}

}  // namespace phrenic::client
