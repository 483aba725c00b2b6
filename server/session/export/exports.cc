#include "server/session/export/exports.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/session/export/saved_export.h"

namespace phrenic::session {
namespace {

// States of waiting exports, in scenes of --max-vertices.
constexpr std::int64_t kExportsOfOwner = 2, kExportsInAll = 4;

}  // namespace

static_assert(static_cast<int>(jobs::State::kQueued) == v1::EXPORT_STATE_QUEUED);
static_assert(static_cast<int>(jobs::State::kRunning) == v1::EXPORT_STATE_RUNNING);
static_assert(static_cast<int>(jobs::State::kDone) == v1::EXPORT_STATE_DONE);
static_assert(static_cast<int>(jobs::State::kFailed) == v1::EXPORT_STATE_FAILED);

Exports::Exports(const Limits& limits, std::string spool_folder, const Clock& clock, store::Store* store,
                 std::string page_template)
    : vertices_(limits.vertices),
      spool_folder_(std::move(spool_folder)),
      page_template_(std::move(page_template)),
      clock_(clock),
      queue_({.noun = {"export", "exports", "an"},
              .threads = limits.exports,
              .kept = limits.kept_exports,
              .share = limits.share,
              .lifetime = absl::Minutes(limits.export_minutes)},
             clock, jobs::Records(kExportRecord, store)) {}

absl::StatusOr<std::shared_ptr<ExportJob>> Exports::MakeJob(const v1::CreateExportRequest& request, Start start) const {
  auto plan = PlanExport(request, *start.model, start.fork, spool_folder_, page_template_);
  if (!plan.ok()) return plan.status();
  auto file = record::SpoolFile::Open(spool_folder_);
  if (!file.ok()) return file.status();
  absl::StatusOr<std::string> record = "";
  if (queue_.records().kept()) record = SaveExport(request, start);
  if (!record.ok()) return record.status();
  return std::make_shared<ExportJob>(*std::move(plan), std::move(start), *std::move(file), *std::move(record), clock_);
}

// Each waiting export has a state of its own, so those of large scenes are fewer: as if all that wait were as large.
absl::Status Exports::CheckVertices(const Model& model, const std::string& owner) const {
  const auto open = [](const std::vector<v1::Export>& exports) {
    return std::count_if(exports.begin(), exports.end(), [](const v1::Export& each) {
      return each.state() == v1::EXPORT_STATE_QUEUED || each.state() == v1::EXPORT_STATE_RUNNING;
    });
  };
  const std::int64_t own = 1 + open(List([&owner](const std::string& other) { return other == owner; }));
  const std::int64_t all = 1 + open(List());
  const std::int64_t each = model.rest.cols();
  if (own * each <= kExportsOfOwner * vertices_ && all * each <= kExportsInAll * vertices_) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      absl::StrCat("too many exports wait for one more of ", each,
                   " vertices; wait until one has ended, or start the server with a larger --max-vertices"));
}

absl::StatusOr<v1::Export> Exports::Add(const v1::CreateExportRequest& request, Start start) {
  const std::string owner = start.owner;
  if (absl::Status room = CheckVertices(*start.model, owner); !room.ok()) return room;
  auto job = MakeJob(request, std::move(start));
  if (!job.ok()) return job.status();
  return queue_.Add(owner, request.export_id(), request.session_id(), (*job)->Describe(request.session_id()), *job);
}

void Exports::Restore(const std::vector<store::SavedRecord>& records, Models& models,
                      absl::FunctionRef<std::string(const std::string& account)> account_of,
                      std::map<std::string, absl::Status>& lost) {
  const auto restore = [&](const store::SavedRecord& record) -> absl::Status {
    auto saved = RestoreExport(record, models, account_of);
    if (!saved.ok()) return saved.status();
    const std::string owner = saved->start.owner, session = saved->request.session_id();
    auto job = MakeJob(saved->request, std::move(saved->start));
    if (!job.ok()) return job.status();
    return queue_.Resume(owner, record.id, session, (*job)->Describe(session), *job).status();
  };
  queue_.records().Restore(records, restore, lost);
}

absl::StatusOr<std::shared_ptr<const record::SpoolFile>> Exports::File(const std::string& id) const {
  std::shared_ptr<const record::SpoolFile> file;
  const absl::Status read = queue_.Read(id, [&](const ExportJob* job, const v1::Export& message) -> absl::Status {
    if (message.state() == v1::EXPORT_STATE_DONE) {
      file = job->file();
      return absl::OkStatus();
    }
    const bool failed = message.state() == v1::EXPORT_STATE_FAILED;
    return absl::FailedPreconditionError(absl::StrCat("export_id: the export \"", id, "\" ",
                                                      failed ? "has failed: " : "is not done yet: watch it",
                                                      message.problem()));
  });
  if (!read.ok()) return read;
  return file;
}

}  // namespace phrenic::session
