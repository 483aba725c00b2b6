// `phrenic campaign`: many runs, on this machine's cores or on Slurm, and their results.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/campaign/report.h"
#include "client/campaign/results.h"
#include "client/campaign/runs.h"
#include "client/campaign/slurm.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/files/study_limits.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/terminal/progress.h"

namespace phrenic::client {
namespace {

constexpr int kSharesPerJob = 8;  // small shares, so that all jobs end at about the same time

struct CampaignOptions {
  std::string file;  // the campaign, in text format
  std::string out;   // folder of results
  int jobs = 0;      // number of runs, or of Slurm's jobs, at a time; 0: one per core
  std::string on = "here";
  std::string share;  // of `campaign work`
  std::string page, data_dir;
};

// A campaign and its results so far.
struct OpenCampaign {
  v1::Campaign campaign;
  std::vector<CampaignCell> cells;
  CampaignFolder folder;
};

absl::StatusOr<OpenCampaign> Open(const CampaignOptions& options) {
  auto campaign = ReadCampaign(options.file);
  if (!campaign.ok()) return campaign.status();
  auto cells = CellsOf(*campaign, options.file);
  if (!cells.ok()) return cells.status();
  auto folder = CampaignFolder::Open(options.out);
  if (!folder.ok()) return folder.status();
  return OpenCampaign{*std::move(campaign), *std::move(cells), *std::move(folder)};
}

std::string AbsolutePath(const std::string& path) { return std::filesystem::absolute(path).string(); }

absl::Status RunHere(const Context& context, const CampaignOptions& options, const OpenCampaign& opened) {
  auto done = static_cast<double>(opened.folder.Finished(opened.cells));
  Progress progress(opened.campaign.name(), static_cast<double>(opened.cells.size()));
  progress.Update(done);
  return RunCells(context, opened.cells, Share(), options.jobs, options.data_dir, opened.folder,
                  [&] { progress.Update(++done); });
}

absl::Status RunAsJobs(const Context& context, const CampaignOptions& options, const OpenCampaign& opened) {
  SlurmJobs jobs;
  jobs.arguments = {"campaign", "work", AbsolutePath(options.file), "--out", AbsolutePath(options.out)};
  if (!options.data_dir.empty()) {
    jobs.arguments.insert(jobs.arguments.end(), {"--data", AbsolutePath(options.data_dir)});
  }
  jobs.concurrent =
      options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const auto total = static_cast<double>(opened.cells.size());
  jobs.shares = static_cast<int>(std::min<double>(total, kSharesPerJob * jobs.concurrent));
  Progress progress(opened.campaign.name(), total);
  int calls = 0;
  const auto wait = [&] {
    if (calls++ % 10 == 0) progress.Update(static_cast<double>(opened.folder.Finished(opened.cells)));
    return !context.interruption->happened();
  };
  return RunOnSlurm(jobs, AbsolutePath(options.out), wait);
}

// Prints the table, writes the page and checks the limits. Returns kMissed if a limit is exceeded, kFailed if runs are
// missing or failed.
int ReportResults(const Context& context, const CampaignOptions& options, const OpenCampaign& opened) {
  const auto result = opened.folder.Read(opened.cells);
  if (!result.ok()) return Fail(result.status());
  v1::StudyLimits limits;
  *limits.mutable_limits() = opened.campaign.limits();
  const auto exceeded = ExceededLimits(limits, *result);
  if (!exceeded.ok()) return Fail(exceeded.status());
  PrintList(context, *result, CampaignTable(*result));
  if (!options.page.empty()) {
    const std::string page = CampaignPage(opened.campaign, *result, *exceeded);
    if (absl::Status status = WriteWhole(options.page, page); !status.ok()) return Fail(status);
  }
  for (const std::string& sentence : *exceeded) std::cerr << "phrenic: limit exceeded: " << sentence << "\n";
  const auto failed = std::count_if(result->rows().begin(), result->rows().end(),
                                    [](const v1::CampaignRow& row) { return row.outcome() != "done"; });
  std::cerr << absl::StrFormat("%d of %d runs finished, %d of them diverged or failed; %d of %d limits met\n",
                               result->rows_size(), static_cast<int>(opened.cells.size()), static_cast<int>(failed),
                               limits.limits_size() - static_cast<int>(exceeded->size()), limits.limits_size());
  if (result->rows_size() < static_cast<int>(opened.cells.size())) return kFailed;
  if (!exceeded->empty()) return kMissed;
  return failed == 0 ? kOk : kFailed;
}

int RunCampaign(const Context& context, const CampaignOptions& options) {
  const auto opened = Open(options);
  if (!opened.ok()) return Fail(opened.status());
  const std::int64_t finished = opened->folder.Finished(opened->cells);
  if (finished > 0) std::cerr << absl::StrFormat("%d runs are already finished\n", finished);
  if (finished < static_cast<std::int64_t>(opened->cells.size())) {
    const absl::Status status =
        options.on == "slurm" ? RunAsJobs(context, options, *opened) : RunHere(context, options, *opened);
    if (absl::IsCancelled(status)) return kInterrupted;
    if (!status.ok()) return Fail(status);
  }
  return ReportResults(context, options, *opened);
}

int WorkOnCampaign(const Context& context, const CampaignOptions& options) {
  const auto opened = Open(options);
  if (!opened.ok()) return Fail(opened.status());
  const auto share = ReadShare(options.share);
  if (!share.ok()) return Fail(share.status());
  const absl::Status status = RunCells(context, opened->cells, *share, 1, options.data_dir, opened->folder, [] {});
  if (absl::IsCancelled(status)) return kInterrupted;
  return status.ok() ? kOk : Fail(status);
}

int ReportCampaign(const Context& context, const CampaignOptions& options) {
  const auto opened = Open(options);
  if (!opened.ok()) return Fail(opened.status());
  return ReportResults(context, options, *opened);
}

// Adds the options of all three subcommands.
std::shared_ptr<CampaignOptions> AddCampaign(CLI::App& command) {
  auto options = std::make_shared<CampaignOptions>();
  command.add_option("FILE", options->file, "campaign in text format (phrenic/v1/campaign.proto)")->required();
  command.add_option("--out", options->out, "folder of the results, one file per run")->required();
  return options;
}

void AddPage(CLI::App& command, CampaignOptions& options) {
  command.add_option("--page", options.page, "also write the table as an HTML page");
}

}  // namespace

CommandFunction SetUpCampaignRun(CLI::App& command) {
  const auto options = AddCampaign(command);
  AddDataFolder(command, options->data_dir);
  AddPage(command, *options);
  command
      .add_option("--jobs", options->jobs, "number of runs at a time (one per core, here the most), or of Slurm's jobs")
      ->check(NumberIn(1, 10'000));
  command.add_option("--on", options->on, "where to run: here or slurm")->capture_default_str();
  return Bind(&RunCampaign, options);
}

CommandFunction SetUpCampaignReport(CLI::App& command) {
  const auto options = AddCampaign(command);
  AddPage(command, *options);
  return Bind(&ReportCampaign, options);
}

CommandFunction SetUpCampaignWork(CLI::App& command) {
  const auto options = AddCampaign(command);
  AddDataFolder(command, options->data_dir);
  command.add_option("--share", options->share, "which share of how many: 0/16 to 15/16")->required();
  return Bind(&WorkOnCampaign, options);
}

}  // namespace phrenic::client
