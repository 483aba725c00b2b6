// Exports as jobs: queued, run a few at a time, kept for a while, whoever watches.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_EXPORTS_H_
#define PHRENIC_SERVER_SESSION_EXPORT_EXPORTS_H_

#include <atomic>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/functional/function_ref.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/session/export/exporter.h"
#include "server/session/limits.h"
#include "server/session/models.h"
#include "server/store/store.h"
#include "server/stream/clock.h"

namespace phrenic::session {

inline constexpr char kExportRecord[] = "export";  // the kind in a store

// Any thread may call. Its own threads: limits.exports.
class Exports {
 public:
  struct Seen {
    v1::Export job;
    std::int64_t version = 0;  // grows with every change
    bool ended = false;
  };

  // What an export starts from.
  struct Start {
    std::shared_ptr<const Model> model;
    Session::Fork fork;
    std::vector<Uploads::Held> surfaces = {};  // that clients gave, of which the scene is made
    std::string owner = {};                    // on a server with accounts
  };

  // `store` outlives it and keeps what makes the files again; null: nothing outlives the server.
  Exports(const Limits& limits, std::string spool_folder, const stream::Clock& clock, store::Store* store = nullptr);
  // Cancels what runs and waits for it; it stays in the store.
  ~Exports();

  // What an earlier server left is queued again, and comes to the same files. `found` hears of each and of its owner;
  // why one could not be is in `lost`, by "export NAME". Before any other call.
  void Restore(const std::vector<store::SavedRecord>& records, Models& models,
               absl::FunctionRef<void(const std::string& id, const std::string& owner)> found,
               std::map<std::string, absl::Status>& lost);

  // Plans the export and queues it, and returns once the store's disk has it; an empty id is chosen from the session's.
  // Errors of PlanExport and of Store::FlushRecords;
  // INVALID_ARGUMENT or ALREADY_EXISTS for an id that cannot be; RESOURCE_EXHAUSTED where limits.kept_exports are there
  // and none of them has ended: the oldest that has makes room.
  absl::StatusOr<v1::Export> Add(const v1::CreateExportRequest& request, Start start) ABSL_LOCKS_EXCLUDED(mutex_);
  // The export as soon as its version is above `seen`, or after `longest`. NOT_FOUND lists the ids there are.
  absl::StatusOr<Seen> Wait(const std::string& id, std::int64_t seen, absl::Duration longest) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Oldest first.
  std::vector<v1::Export> List() const ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status Delete(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // The file of an export that is done; it lives as long as somebody reads it. FAILED_PRECONDITION before.
  absl::StatusOr<std::shared_ptr<const record::SpoolFile>> File(const std::string& id) const
      ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Job {
    ExportPlan plan;
    Start start;
    std::shared_ptr<record::SpoolFile> spool;
    Seen seen;
    absl::Time started, expires = absl::InfiniteFuture();
    std::atomic<bool> cancelled = false;
  };

  absl::StatusOr<v1::Export> Queue(const v1::CreateExportRequest& request, Start start) ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status RestoreOne(Models& models, const store::SavedRecord& record, std::string& owner);
  absl::StatusOr<std::string> Record(const v1::CreateExportRequest& request, const Start& start) const;
  void Forget(const std::string& id) const;
  void Loop();
  void RunOne(Job& job);
  absl::Status Note(double share, double recorded_seconds, Job& job) ABSL_LOCKS_EXCLUDED(mutex_);
  void End(const absl::StatusOr<v1::ExportSummary>& summary, Job& job) ABSL_LOCKS_EXCLUDED(mutex_);
  void Expire() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Time NextExpiry() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::shared_ptr<Job> Find(const std::string& id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::shared_ptr<Job> NextQueued() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::StatusOr<std::string> ChooseId(const std::string& wanted, const std::string& session) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status MakeRoom() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status NoExport(const std::string& id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Change(Job& job) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { ++job.seen.version; }

  const Limits limits_;
  const std::string spool_folder_;
  const stream::Clock& clock_;
  store::Store* const store_;
  mutable absl::Mutex mutex_;
  std::list<std::shared_ptr<Job>> jobs_ ABSL_GUARDED_BY(mutex_);  // oldest first
  bool closed_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_EXPORTS_H_
