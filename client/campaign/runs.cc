#include "client/campaign/runs.h"

#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/connection/local_run.h"
#include "client/files/local_models.h"
#include "server/study/batch/batch.h"
#include "server/study/batch/run_pool.h"

namespace phrenic::client {
namespace {

// The runs of one scene and preset. Thread-safe once all runs are added.
class CellBatch {
 public:
  using Shared = absl::StatusOr<std::shared_ptr<const study::Batch>>;

  explicit CellBatch(const CampaignCell& first) : first_(first.row) {
    *request_.mutable_source() = first.source;
    request_.set_preset(first.row.preset());
    request_.set_seconds(first.seconds);
    request_.set_frames_per_second(kReadingsPerSecond);
    request_.set_most_seconds_a_run(HUGE_VAL);
    request_.set_summary(true);
  }

  // True if the cell belongs to this batch, and there is room for it.
  bool Takes(const CampaignCell& cell) const {
    return request_.runs_size() < study::kMostBatchRuns && cell.row.scene() == first_.scene() &&
           cell.row.resolution_mm() == first_.resolution_mm() && cell.row.preset() == first_.preset();
  }
  // Returns the number of the run in the batch.
  int Add(const CampaignCell& cell) {
    *request_.add_runs()->mutable_parameters() = cell.parameters;
    return request_.runs_size() - 1;
  }

  // Returns the batch for one of its runs. The first call makes it, and the others wait; after the last call the runs
  // alone keep it. Requires: called once a run.
  Shared Take(const study::Compiler& compile, const std::function<bool()>& cancelled) ABSL_LOCKS_EXCLUDED(mutex_) {
    const absl::MutexLock lock(&mutex_);
    if (taken_++ == 0) batch_ = Make(compile, cancelled);
    Shared batch = batch_;
    if (taken_ == request_.runs_size()) batch_ = absl::InternalError("every run has begun");
    return batch;
  }

 private:
  Shared Make(const study::Compiler& compile, const std::function<bool()>& cancelled) const {
    auto batch = study::Batch::Make(request_, compile, cancelled);
    if (!batch.ok()) return batch.status();
    return std::make_shared<const study::Batch>(*std::move(batch));
  }

  const v1::CampaignRow first_;
  v1::RunBatchRequest request_;
  absl::Mutex mutex_;
  int taken_ ABSL_GUARDED_BY(mutex_) = 0;
  Shared batch_ ABSL_GUARDED_BY(mutex_);
};

// A run of a batch, and the cell that it computes.
struct CellRun {
  const CampaignCell* cell;
  CellBatch* batch;
  int number;
};

// The unfinished runs of a share, in the order of the cells.
struct CellRuns {
  std::deque<CellBatch> batches;
  std::vector<CellRun> runs;
};

CellRuns UnfinishedRuns(const std::vector<CampaignCell>& cells, const Share& share, const CampaignFolder& folder) {
  CellRuns unfinished;
  for (auto i = static_cast<size_t>(share.number); i < cells.size(); i += static_cast<size_t>(share.count)) {
    if (folder.Has(cells[i])) continue;
    if (unfinished.batches.empty() || !unfinished.batches.back().Takes(cells[i])) {
      unfinished.batches.emplace_back(cells[i]);
    }
    CellBatch& batch = unfinished.batches.back();
    unfinished.runs.push_back({&cells[i], &batch, batch.Add(cells[i])});
  }
  return unfinished;
}

void WriteSummary(const v1::BatchHeader& header, const v1::BatchResult& run, v1::CampaignResult& result) {
  const v1::BatchSummary& summary = run.summary();
  v1::CampaignRow& row = *result.mutable_rows(0);
  row.set_outcome(run.problem().empty() ? "done" : "diverged");
  row.set_why(run.problem());
  row.set_simulated_seconds(summary.simulated_seconds());
  row.set_steps(summary.steps());
  if (summary.steps() > 0) row.set_cpu_us_a_step(1e6 * run.cpu_seconds() / static_cast<double>(summary.steps()));
  if (summary.wall_seconds() > 0) row.set_times_real_time(summary.simulated_seconds() / summary.wall_seconds());
  row.set_state_hash(run.state_hash());
  if (summary.has_constraint_residual()) row.set_constraint_residual_mm(1e3 * summary.constraint_residual());
  for (int i = 0; i < summary.last_size(); ++i) {
    v1::CampaignReading& reading = *result.add_readings();
    reading.set_cell(row.cell());
    reading.set_measure(header.measures(i));
    reading.set_unit(header.units(i));
    reading.set_last(summary.last(i));
    reading.set_least(summary.least(i));
    reading.set_greatest(summary.greatest(i));
  }
}

// True if the error concerns a scene only, so that the campaign continues.
bool ConcernsSceneOnly(const absl::Status& status) {
  return absl::IsInvalidArgument(status) || absl::IsNotFound(status) || absl::IsFailedPrecondition(status) ||
         absl::IsResourceExhausted(status);
}

// Returns the row of a run that was refused; the error itself if it ends the campaign.
absl::StatusOr<v1::CampaignResult> RefusedRun(const CampaignCell& cell, const absl::Status& status) {
  if (absl::IsCancelled(status)) return status;
  if (!ConcernsSceneOnly(status)) return absl::InternalError(status.message());
  v1::CampaignResult result;
  v1::CampaignRow& row = *result.add_rows();
  row = cell.row;
  row.set_outcome("failed");
  row.set_why(std::string(status.message()));
  return result;
}

absl::StatusOr<v1::CampaignResult> RunCell(const CellRun& run, const study::Compiler& compile,
                                           const std::function<bool()>& ended) {
  const auto batch = run.batch->Take(compile, ended);
  if (!batch.ok()) return RefusedRun(*run.cell, batch.status());
  const auto outcome = (*batch)->Run(run.number, ended);
  if (!outcome.ok()) return RefusedRun(*run.cell, outcome.status());
  v1::CampaignResult result;
  *result.add_rows() = run.cell->row;
  WriteSummary((*batch)->Header(), *outcome, result);
  return result;
}

}  // namespace

absl::StatusOr<Share> ReadShare(const std::string& text) {
  Share share;
  const size_t slash = text.find('/');
  if (slash != std::string::npos && absl::SimpleAtoi(text.substr(0, slash), &share.number) &&
      absl::SimpleAtoi(text.substr(slash + 1), &share.count) && share.number >= 0 && share.number < share.count) {
    return share;
  }
  return absl::InvalidArgumentError(
      absl::StrCat("--share \"", text, "\" is not of the form 3/16, between 0/16 and 15/16"));
}

absl::Status RunCells(const Context& context, const std::vector<CampaignCell>& cells, const Share& share, int threads,
                      const std::string& data_dir, const CampaignFolder& folder, absl::FunctionRef<void()> finished) {
  const CellRuns unfinished = UnfinishedRuns(cells, share, folder);
  const auto interrupted = [&context] { return context.interruption->happened(); };
  session::Models models = LocalModels(data_dir);
  const study::Compiler compile = [&](const v1::SceneSource& source) {
    return models.Get(source, {.cancelled = interrupted});
  };
  const study::MakeResult<v1::CampaignResult> make = [&](size_t run, const std::function<bool()>& ended) {
    return RunCell(unfinished.runs[run], compile, ended);
  };
  absl::Status written;
  const auto write = [&](const v1::CampaignResult& result) {
    written = folder.Write(result);
    if (written.ok()) finished();
    return written.ok();
  };
  const size_t runs = unfinished.runs.size();
  const absl::Status status =
      study::RunOnThreads<v1::CampaignResult>(runs, study::ThreadsFor(threads, runs), make, write, interrupted);
  return written.ok() ? status : written;
}

}  // namespace phrenic::client
