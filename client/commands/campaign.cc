// `phrenic campaign`: many runs on this machine's cores or on Slurm, their table and their page.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/campaign/report.h"
#include "client/campaign/results.h"
#include "client/campaign/worker.h"
#include "client/commands/commands.h"
#include "client/files/limits.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/terminal/progress.h"

namespace phrenic::client {
namespace {

constexpr int kSharesAWorker = 8;  // small enough shares that none is left over at the end

struct Opened {
  v1::Campaign campaign;
  std::vector<CampaignCell> cells;
  CampaignFolder folder;
};

absl::StatusOr<Opened> Open(const CampaignOptions& options) {
  auto campaign = ReadCampaign(options.file);
  if (!campaign.ok()) return campaign.status();
  auto cells = CellsOf(*campaign, options.file);
  if (!cells.ok()) return cells.status();
  auto folder = CampaignFolder::Open(options.out);
  if (!folder.ok()) return folder.status();
  return Opened{*std::move(campaign), *std::move(cells), *std::move(folder)};
}

std::string Absolute(const std::string& path) { return std::filesystem::absolute(path).string(); }

absl::Status RunAll(const Context& context, const CampaignOptions& options, const Opened& opened) {
  Workers workers;
  workers.arguments = {"campaign", "work", Absolute(options.file), "--out", Absolute(options.out)};
  if (!options.data_dir.empty()) {
    workers.arguments.insert(workers.arguments.end(), {"--data", Absolute(options.data_dir)});
  }
  workers.at_once =
      options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const auto total = static_cast<double>(opened.cells.size());
  const int shares = static_cast<int>(std::min<double>(total, kSharesAWorker * workers.at_once));
  Progress progress(opened.campaign.name(), total);
  int looks = 0;
  const auto wait = [&] {
    if (looks++ % 10 == 0) progress.Update(static_cast<double>(opened.folder.Finished(opened.cells)));
    return !context.interruption->happened();
  };
  if (options.on == "slurm") return RunOnSlurm(workers, shares, Absolute(options.out), wait);
  return RunHere(workers, shares, wait);
}

// The table, the page, and the limits; kMissed where one is passed, kFailed where runs are missing or failed.
int Report(const Context& context, const CampaignOptions& options, const Opened& opened) {
  const auto result = opened.folder.Read(opened.cells);
  if (!result.ok()) return Fail(result.status());
  v1::StudyLimits limits;
  *limits.mutable_limits() = opened.campaign.limits();
  const auto passed = PassedLimits(limits, *result);
  if (!passed.ok()) return Fail(passed.status());
  PrintList(context, *result, CampaignTable(*result));
  if (!options.page.empty()) {
    const std::string page = CampaignPage(opened.campaign, *result, *passed);
    if (absl::Status status = WriteWhole(options.page, page); !status.ok()) return Fail(status);
  }
  for (const std::string& sentence : *passed) std::cerr << "phrenic: limit passed: " << sentence << "\n";
  const auto failed = std::count_if(result->rows().begin(), result->rows().end(),
                                    [](const v1::CampaignRow& row) { return row.outcome() != "done"; });
  std::cerr << absl::StrFormat("%d of %d runs finished, %d of them diverged or failed; %d of %d limits kept\n",
                               result->rows_size(), static_cast<int>(opened.cells.size()), static_cast<int>(failed),
                               limits.limits_size() - static_cast<int>(passed->size()), limits.limits_size());
  if (result->rows_size() < static_cast<int>(opened.cells.size())) return kFailed;
  if (!passed->empty()) return kMissed;
  return failed == 0 ? kOk : kFailed;
}

}  // namespace

int RunCampaign(const Context& context, const CampaignOptions& options) {
  const auto opened = Open(options);
  if (!opened.ok()) return Fail(opened.status());
  const std::int64_t before = opened->folder.Finished(opened->cells);
  if (before > 0) std::cerr << absl::StrFormat("%d runs are finished already\n", before);
  if (before < static_cast<std::int64_t>(opened->cells.size())) {
    const absl::Status status = RunAll(context, options, *opened);
    if (absl::IsCancelled(status)) return kInterrupted;
    if (!status.ok()) return Fail(status);
  }
  return Report(context, options, *opened);
}

int WorkOnCampaign(const Context& context, const CampaignOptions& options) {
  const auto opened = Open(options);
  if (!opened.ok()) return Fail(opened.status());
  const auto share = ReadShare(options.share);
  if (!share.ok()) return Fail(share.status());
  const absl::Status status = Work(context, opened->cells, *share, options.data_dir, opened->folder);
  if (absl::IsCancelled(status)) return kInterrupted;
  return status.ok() ? kOk : Fail(status);
}

int ReportCampaign(const Context& context, const CampaignOptions& options) {
  const auto opened = Open(options);
  if (!opened.ok()) return Fail(opened.status());
  return Report(context, options, *opened);
}

}  // namespace phrenic::client
