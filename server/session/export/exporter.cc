#include "server/session/export/exporter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/state_warnings.h"
#include "server/schema/thread_cpu.h"
#include "server/session/export/body_writer.h"
#include "server/session/export/page_writer.h"
#include "server/session/run.h"

namespace phrenic::session {
namespace {

using Wall = std::chrono::steady_clock;

constexpr auto kBetweenReports = std::chrono::milliseconds(200);  // of progress
constexpr double kRecordingShare = 0.5;  // of the work, for a format that writes its file from a spool at the end

// One export in progress. Not thread-safe.
class MotionExport {
 public:
  MotionExport(const ExportPlan& plan, Run& run, MotionWriter& writer, const ExportProgress& progress)
      : plan_(plan), model_(run.model()), run_(run), writer_(writer), progress_(progress), begin_(run.state().time) {}

  absl::Status Record() {
    if (absl::Status status = StepTo(plan_.start); !status.ok()) return status;
    if (absl::Status status = Begin(); !status.ok()) return status;
    absl::Status recorded = plan_.steps_per_frame > 0 ? RecordBySteps() : RecordByTime();
    if (!recorded.ok()) return recorded;
    return writer_.End([this](double share) {
      if (Wall::now() < last_report_ + kBetweenReports) return absl::OkStatus();
      last_report_ = Wall::now();
      return progress_(kRecordingShare + (1 - kRecordingShare) * share, plan_.seconds);
    });
  }

  void FillSummary(v1::ExportSummary& summary) const {
    summary.set_frames(frames_);
    summary.set_vertices(writer_.vertices());
    summary.set_steps(steps_);
    summary.set_simulated_seconds(run_.state().time - begin_);
    summary.set_step_wall_seconds(step_wall_);
    summary.set_step_cpu_seconds(step_cpu_);
    summary.set_state_hash(HashText(run_.state()));
    summary.set_end_time(run_.state().time);
    summary.set_end_tick(run_.state().tick);
    const ConstraintResidual residual = WorstResidual();
    summary.mutable_warnings()->Assign(motion_warnings_.begin(), motion_warnings_.end());
    if (std::string warning = ResidualWarning(model_, run_.parameters(), residual); !warning.empty()) {
      summary.add_warnings(std::move(warning));
    }
    if (model_.constraints.empty()) return;
    summary.set_constraint_residual(residual.metres);
    summary.set_residual_constraint(std::string(residual.constraint));
  }

 private:
  double end() const { return plan_.start + plan_.seconds; }

  // Of the frames and of the present state.
  ConstraintResidual WorstResidual() const {
    const ConstraintResidual now = LargestResidual(model_, run_.state());
    return now.metres > worst_.metres ? now : worst_;
  }

  absl::Status Begin() {
    if (absl::Status status = writer_.Begin(run_); !status.ok()) return status;
    return AddFrame();
  }

  absl::Status AddFrame() {
    ++frames_;
    worst_ = WorstResidual();
    if (motion_warnings_.empty()) motion_warnings_ = MotionWarnings(model_, run_.state());
    return writer_.AddFrame(run_);
  }

  absl::Status RecordByTime() {
    const auto frames = static_cast<std::int64_t>(std::floor(plan_.seconds * plan_.frames_per_second + 1e-6));
    for (std::int64_t frame = 1; frame <= frames; ++frame) {
      const double time = plan_.start + static_cast<double>(frame) / plan_.frames_per_second;
      if (absl::Status status = StepTo(time); !status.ok()) return status;
      if (absl::Status status = AddFrame(); !status.ok()) return status;
    }
    return StepTo(end());
  }

  absl::Status RecordBySteps() {
    while (true) {
      const std::int64_t next = steps_ + plan_.steps_per_frame;
      if (absl::Status status = StepTo(end(), next); !status.ok()) return status;
      if (steps_ < next) return absl::OkStatus();
      if (absl::Status status = AddFrame(); !status.ok()) return status;
    }
  }

  absl::Status StepTo(double time, std::int64_t most_steps = std::numeric_limits<std::int64_t>::max()) {
    while (steps_ < most_steps && run_.state().time < time - kTimeTolerance) {
      if (absl::Status status = StepUntilReport(time, most_steps); !status.ok()) return status;
      if (Wall::now() < last_report_ + kBetweenReports) continue;
      last_report_ = Wall::now();
      if (absl::Status status = Report(); !status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status Report() {
    const double time = run_.state().time, all = end() - begin_;
    const double share = all > 0 ? std::min(1.0, (time - begin_) / all) : 1;
    return progress_(share * (plan_.format.spool_bytes > 0 ? kRecordingShare : 1), std::max(0.0, time - plan_.start));
  }

  // Steps until `time`, `most_steps` steps in all, or until a report is due.
  absl::Status StepUntilReport(double time, std::int64_t most_steps) {
    const Wall::time_point start = Wall::now();
    const double cpu = ThreadCpuSeconds();
    absl::Status status;
    while (status.ok() && steps_ < most_steps && run_.state().time < time - kTimeTolerance &&
           Wall::now() < last_report_ + kBetweenReports) {
      status = run_.Step();
      ++steps_;
    }
    step_wall_ += std::chrono::duration<double>(Wall::now() - start).count();
    step_cpu_ += ThreadCpuSeconds() - cpu;
    return status;
  }

  const ExportPlan& plan_;
  const Model& model_;
  Run& run_;
  MotionWriter& writer_;
  const ExportProgress& progress_;
  const double begin_;                        // simulated time at which stepping began [s]
  ConstraintResidual worst_;                  // of the frames
  std::vector<std::string> motion_warnings_;  // of the first frame that has some
  Wall::time_point last_report_ = Wall::now();
  std::int64_t frames_ = 0, steps_ = 0;
  double step_wall_ = 0, step_cpu_ = 0;
};

// Returns the writer of the plan's format. NOT_FOUND if the format is a page and the viewer is not built.
absl::StatusOr<std::unique_ptr<MotionWriter>> MakeWriter(const ExportPlan& plan,
                                                         const std::shared_ptr<const Model>& model, ExportFile& file) {
  const record::Sink sink = [&file](std::string_view bytes) { return file.Append(bytes); };
  if (!plan.format.page) return std::make_unique<BodyWriter>(plan, sink);
  absl::StatusOr<std::string> page = ReadPageTemplate(plan.page_template);
  if (!page.ok()) return page.status();
  return std::make_unique<PageWriter>(model, plan.bodies, *std::move(page), sink);
}

}  // namespace

absl::StatusOr<v1::ExportSummary> ExportMotion(const ExportPlan& plan, const std::shared_ptr<const Model>& model,
                                               Fork fork, ExportFile& file, const ExportProgress& progress) {
  const auto writer = MakeWriter(plan, model, file);
  if (!writer.ok()) return writer.status();
  Run run(model, std::move(fork.parameters), std::move(fork.state));
  MotionExport work(plan, run, **writer, progress);
  if (absl::Status status = work.Record(); !status.ok()) return status;
  v1::ExportSummary summary;
  work.FillSummary(summary);
  summary.set_bytes(file.spool()->size());
  summary.set_sha256(file.Sha256Digits());
  return summary;
}

}  // namespace phrenic::session
