#include "server/session/export/exports.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "google/protobuf/util/time_util.h"
#include "server/schema/id.h"
#include "server/schema/names.h"

namespace phrenic::session {

Exports::Exports(const Limits& limits, std::string spool_folder, const stream::Clock& clock, store::Store* store)
    : limits_(limits), spool_folder_(std::move(spool_folder)), clock_(clock), store_(store) {
  for (int i = 0; i < limits_.exports; ++i) threads_.emplace_back([this] { Loop(); });
}

Exports::~Exports() {
  {
    absl::MutexLock lock(&mutex_);
    closed_ = true;
    for (const auto& job : jobs_) job->cancelled = true;
  }
  for (std::thread& thread : threads_) thread.join();
}

absl::StatusOr<v1::Export> Exports::Add(const v1::CreateExportRequest& request, Start start) {
  auto added = Queue(request, std::move(start));
  if (!added.ok() || store_ == nullptr) return added;
  if (absl::Status saved = store_->FlushRecords(); !saved.ok()) {
    Delete(added->id()).IgnoreError();
    return saved;
  }
  return added;
}

absl::StatusOr<v1::Export> Exports::Queue(const v1::CreateExportRequest& request, Start start) {
  auto plan = PlanExport(request, *start.model, start.fork, spool_folder_);
  if (!plan.ok()) return plan.status();
  auto spool = record::SpoolFile::Open(spool_folder_);
  if (!spool.ok()) return spool.status();
  auto record = Record(request, start);
  if (!record.ok()) return record.status();
  auto job = std::make_shared<Job>();
  job->plan = *std::move(plan);
  job->start = std::move(start);
  job->spool = *std::move(spool);
  absl::MutexLock lock(&mutex_);
  if (closed_) return absl::UnavailableError("the server is shutting down");
  const absl::StatusOr<std::string> id = ChooseId(request.export_id(), request.session_id());
  if (!id.ok()) return id.status();
  if (absl::Status status = MakeRoom(); !status.ok()) return status;
  v1::Export& seen = job->seen.job;
  seen.set_id(*id);
  seen.set_session_id(request.session_id());
  seen.set_format(job->plan.format.name);
  seen.set_file_name(absl::StrCat(job->plan.file_stem, ".", job->plan.format.ending));
  seen.set_state(v1::EXPORT_STATE_QUEUED);
  job->seen.version = 1;
  jobs_.push_back(job);
  if (store_ != nullptr) store_->Put(kExportRecord, *id, *std::move(record));
  return seen;
}

absl::StatusOr<std::string> Exports::ChooseId(const std::string& wanted, const std::string& session) const {
  if (absl::Status status = schema::CheckId("export_id", wanted); !status.ok()) return status;
  if (wanted.empty()) {
    return schema::FreeId(session, "export", [this](const std::string& id) {
      mutex_.AssertHeld();
      return Find(id) != nullptr;
    });
  }
  if (Find(wanted) == nullptr) return wanted;
  return absl::AlreadyExistsError(absl::StrCat("export_id: there is an export \"", wanted, "\" already"));
}

absl::Status Exports::MakeRoom() {
  if (jobs_.size() < static_cast<std::size_t>(limits_.kept_exports)) return absl::OkStatus();
  const auto ended = std::find_if(jobs_.begin(), jobs_.end(), [](const auto& job) { return job->seen.ended; });
  if (ended == jobs_.end()) {
    return absl::ResourceExhaustedError(absl::StrCat(
        limits_.kept_exports, " exports wait or run, and no more are allowed: delete one, or wait for one to end"));
  }
  Forget((*ended)->seen.job.id());
  jobs_.erase(ended);
  return absl::OkStatus();
}

std::shared_ptr<Exports::Job> Exports::Find(const std::string& id) const {
  for (const auto& job : jobs_) {
    if (job->seen.job.id() == id) return job;
  }
  return nullptr;
}

std::shared_ptr<Exports::Job> Exports::NextQueued() const {
  for (const auto& job : jobs_) {
    if (job->seen.job.state() == v1::EXPORT_STATE_QUEUED) return job;
  }
  return nullptr;
}

absl::Status Exports::NoExport(const std::string& id) const {
  std::vector<std::string> ids;
  for (const auto& job : jobs_) ids.push_back(job->seen.job.id());
  return absl::NotFoundError(
      absl::StrCat("export_id: there is no export \"", schema::ShortId(id), "\"", schema::ThereAre(id, ids)));
}

absl::StatusOr<Exports::Seen> Exports::Wait(const std::string& id, std::int64_t seen, absl::Duration longest) const {
  absl::MutexLock lock(&mutex_);
  const std::shared_ptr<Job> job = Find(id);
  if (job == nullptr) return NoExport(id);
  const auto changed = [&] {
    mutex_.AssertHeld();
    return job->seen.version > seen || job->cancelled;
  };
  mutex_.AwaitWithTimeout(absl::Condition(&changed), longest);
  if (job->cancelled) return absl::CancelledError(absl::StrCat("export_id: the export \"", id, "\" was deleted"));
  return job->seen;
}

std::vector<v1::Export> Exports::List() const {
  absl::MutexLock lock(&mutex_);
  std::vector<v1::Export> exports;
  for (const auto& job : jobs_) exports.push_back(job->seen.job);
  return exports;
}

absl::Status Exports::Delete(const std::string& id) {
  absl::MutexLock lock(&mutex_);
  const std::shared_ptr<Job> job = Find(id);
  if (job == nullptr) return NoExport(id);
  job->cancelled = true;
  Forget(id);
  jobs_.remove(job);
  return absl::OkStatus();
}

absl::StatusOr<std::shared_ptr<const record::SpoolFile>> Exports::File(const std::string& id) const {
  absl::MutexLock lock(&mutex_);
  const std::shared_ptr<Job> job = Find(id);
  if (job == nullptr) return NoExport(id);
  if (job->seen.job.state() == v1::EXPORT_STATE_DONE) return job->spool;
  return absl::FailedPreconditionError(absl::StrCat("export_id: the export \"", id, "\" ",
                                                    job->seen.ended ? "has failed: " : "is not done yet: watch it",
                                                    job->seen.job.problem()));
}

void Exports::Expire() {
  jobs_.remove_if([this, now = clock_.Now()](const auto& job) {
    if (job->expires > now) return false;
    Forget(job->seen.job.id());
    return true;
  });
}

absl::Time Exports::NextExpiry() const {
  absl::Time next = absl::InfiniteFuture();
  for (const auto& job : jobs_) next = std::min(next, job->expires);
  return next;
}

void Exports::Loop() {
  const auto wake = [this] {
    mutex_.AssertHeld();
    return closed_ || NextQueued() != nullptr || NextExpiry() <= clock_.Now();
  };
  while (true) {
    std::shared_ptr<Job> job;
    {
      absl::MutexLock lock(&mutex_);
      clock_.Await(mutex_, absl::Condition(&wake), NextExpiry());
      if (closed_) return;
      Expire();
      job = NextQueued();
      if (job == nullptr) continue;
      job->seen.job.set_state(v1::EXPORT_STATE_RUNNING);
      job->started = clock_.Now();
      Change(*job);
    }
    RunOne(*job);
  }
}

void Exports::RunOne(Job& job) {
  ExportFile file(job.spool);
  End(ExportMotion(job.plan, job.start.model, std::move(job.start.fork), file,
                   [&](double share, double recorded) { return Note(share, recorded, job); }),
      job);
}

absl::Status Exports::Note(double share, double recorded_seconds, Job& job) {
  if (job.cancelled) return absl::CancelledError("the export was deleted");
  absl::MutexLock lock(&mutex_);
  v1::Export& seen = job.seen.job;
  seen.set_progress(std::clamp(share, seen.progress(), 1.0));
  seen.set_recorded_seconds(recorded_seconds);
  seen.set_bytes(job.spool->size());
  const double spent = absl::ToDoubleSeconds(clock_.Now() - job.started);
  if (seen.progress() > 0) seen.set_seconds_left(spent * (1 - seen.progress()) / seen.progress());
  Change(job);
  return absl::OkStatus();
}

void Exports::End(const absl::StatusOr<v1::ExportSummary>& summary, Job& job) {
  absl::MutexLock lock(&mutex_);
  v1::Export& seen = job.seen.job;
  seen.set_state(summary.ok() ? v1::EXPORT_STATE_DONE : v1::EXPORT_STATE_FAILED);
  seen.clear_seconds_left();
  if (summary.ok()) {
    seen.set_progress(1);
    seen.set_recorded_seconds(job.plan.seconds);
    seen.set_bytes(summary->bytes());
    *seen.mutable_summary() = *summary;
  } else {
    seen.set_problem(std::string(summary.status().message()));
    job.spool = nullptr;  // the disk is not kept for what is no file
    if (!job.cancelled) Forget(seen.id());
  }
  job.start = {};
  job.expires = clock_.Now() + absl::Minutes(limits_.export_minutes);
  *seen.mutable_expire_time() =
      google::protobuf::util::TimeUtil::NanosecondsToTimestamp(absl::ToUnixNanos(job.expires));
  job.seen.ended = true;
  Change(job);
}

}  // namespace phrenic::session
