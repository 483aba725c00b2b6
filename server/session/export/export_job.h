// One export as a job of a queue.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_EXPORT_JOB_H_
#define PHRENIC_SERVER_SESSION_EXPORT_EXPORT_JOB_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/jobs/queue.h"
#include "server/session/export/exporter.h"
#include "server/session/uploads.h"

namespace phrenic::session {

// What an export starts from.
struct ExportStart {
  std::shared_ptr<const Model> model;
  Fork fork;
  std::vector<Uploads::Held> surfaces = {};  // uploaded files that the scene uses
  std::string owner = {};                    // on a server with accounts
};

// Writes a motion to a file of the spool folder. The queue calls it (jobs::Queue), file() under its lock. Run uses a
// thread of the queue, and is called once.
class ExportJob {
 public:
  using Message = v1::Export;

  // `record` is what the store keeps of it (SaveExport). `clock` outlives the job.
  ExportJob(ExportPlan plan, ExportStart start, std::shared_ptr<record::SpoolFile> file, std::string record,
            const Clock& clock);

  // Returns the fields of the job's message that are known before it runs.
  v1::Export Describe(const std::string& session_id) const;
  // Null if the export has failed.
  std::shared_ptr<const record::SpoolFile> file() const { return file_; }

  // The errors of ExportMotion; CANCELLED if the export was deleted.
  absl::Status Run(jobs::Progress<v1::Export> progress);
  // Frees the model, the state and the uploaded files; also the file, if `status` is an error.
  void Finish(const absl::Status& status, absl::Time expires, v1::Export& message);
  // Puts the record when the export is queued, and removes it if it has failed.
  void Save(const v1::Export& message, const jobs::Records& records);

 private:
  // Fills in what has been recorded so far. `done` is 0 to 1; `spent` is wall-clock time, from which the seconds left
  // are estimated.
  void FillProgress(double done, double recorded_seconds, absl::Duration spent, v1::Export& message) const;

  const ExportPlan plan_;
  ExportStart start_;  // empty after Finish
  std::shared_ptr<record::SpoolFile> file_;
  std::string record_;  // handed to the store when queued
  const Clock& clock_;
  v1::ExportSummary summary_;  // of an export that succeeded
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_EXPORT_JOB_H_
