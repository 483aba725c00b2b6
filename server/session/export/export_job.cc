#include "server/session/export/export_job.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "google/protobuf/util/time_util.h"

namespace phrenic::session {

ExportJob::ExportJob(ExportPlan plan, ExportStart start, std::shared_ptr<record::SpoolFile> file, std::string record,
                     const Clock& clock)
    : plan_(std::move(plan)),
      start_(std::move(start)),
      file_(std::move(file)),
      record_(std::move(record)),
      clock_(clock) {}

v1::Export ExportJob::Describe(const std::string& session_id) const {
  v1::Export message;
  message.set_session_id(session_id);
  message.set_format(plan_.format.name);
  message.set_file_name(absl::StrCat(plan_.file_stem, ".", plan_.format.ending));
  return message;
}

absl::Status ExportJob::Run(jobs::Progress<v1::Export> progress) {
  const absl::Time started = clock_.Now();
  const auto report = [&](double done, double recorded_seconds) -> absl::Status {
    const bool wanted = progress(done, [&](v1::Export& message) {
      FillProgress(done, recorded_seconds, clock_.Now() - started, message);
      return true;
    });
    return wanted ? absl::OkStatus() : absl::CancelledError("the export was deleted");
  };
  ExportFile file(file_);
  auto summary = ExportMotion(plan_, start_.model, std::move(start_.fork), file, report);
  if (!summary.ok()) return summary.status();
  summary_ = *std::move(summary);
  return absl::OkStatus();
}

void ExportJob::FillProgress(double done, double recorded_seconds, absl::Duration spent, v1::Export& message) const {
  message.set_recorded_seconds(recorded_seconds);
  message.set_bytes(file_->size());
  const double share = std::clamp(done, message.progress(), 1.0);
  if (share > 0) message.set_seconds_left(absl::ToDoubleSeconds(spent) * (1 - share) / share);
}

void ExportJob::Finish(const absl::Status& status, absl::Time expires, v1::Export& message) {
  message.clear_seconds_left();
  *message.mutable_expire_time() = google::protobuf::util::TimeUtil::NanosecondsToTimestamp(absl::ToUnixNanos(expires));
  start_ = {};
  if (!status.ok()) {
    file_ = nullptr;
    return;
  }
  message.set_recorded_seconds(plan_.seconds);
  message.set_bytes(summary_.bytes());
  *message.mutable_summary() = summary_;
}

// A finished export stays in the store: a restarted server makes its file again.
void ExportJob::Save(const v1::Export& message, const jobs::Records& records) {
  if (message.state() == v1::EXPORT_STATE_QUEUED) records.Put(message.id(), std::exchange(record_, {}));
  if (message.state() == v1::EXPORT_STATE_FAILED) records.Remove(message.id());
}

}  // namespace phrenic::session
