// Sessions and jobs on disk, in an SQLite file: of each session its scene, its last saved state, and a journal of its
// changes since; of each job one record. A thread of the store writes; callers hand over what to save and continue, or
// wait for it to be on the disk.
#ifndef PHRENIC_SERVER_STORE_STORE_H_
#define PHRENIC_SERVER_STORE_STORE_H_

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/mechanics/state.h"
#include "server/store/layout.h"
#include "server/store/marker.h"
#include "server/store/ownership.h"

namespace phrenic::store {

class Store;

// What a change survives once Journal::Flush returns.
enum class Durability {
  kProcess,  // the end of the server, as by SIGKILL; a power failure loses half a second of them at most
  kPower,    // a power failure as well
};

// The part of a store that belongs to one session. The store outlives it. Thread-safe.
class Journal : public std::enable_shared_from_this<Journal> {
 public:
  // Appends a moment: what has changed, at the session's present tick. A moment in which only time has changed
  // (`time_alone`) replaces a previous one of the same kind.
  void Append(v1::SavedMoment moment, bool time_alone);
  // Saves a state with its moment; the journal so far is no longer needed and is removed.
  void Keep(v1::SavedMoment moment, std::shared_ptr<const State> state);
  // Removes the session from the store. Later calls save nothing.
  void Forget();
  // Waits until the effects of all earlier calls are saved. RESOURCE_EXHAUSTED if the disk is full, UNAVAILABLE for any
  // other failure; the store tries again every second.
  absl::Status Flush(Durability durability = Durability::kPower);
  // In a cluster, waits until the effects of all earlier calls are in the session's copy, from which another server
  // would continue; otherwise returns at once. ABORTED if another server has the session, UNAVAILABLE once this server
  // cannot know whether one has it.
  absl::Status AwaitCopy();
  // Returns the errors of AwaitCopy that a change at present would have, without waiting.
  absl::Status CheckLease() const;
  // Returns the result of the last attempt to write; in a cluster also of the last attempt to copy.
  absl::Status problem() const;
  // True if too many moments wait to be written; a state would replace them.
  bool wants_state() const;

 private:
  friend class Store;
  struct Kept {
    std::int64_t sequence = 0;
    v1::SavedMoment moment;
    std::shared_ptr<const State> state;
  };
  // What is still to be written.
  struct Pending {
    std::optional<v1::SavedScene> scene;
    std::optional<Kept> kept;
    std::vector<std::pair<std::int64_t, v1::SavedMoment>> moments;
    bool forgotten = false;
    std::int64_t requested = 0;
  };

  Journal(Store& store, std::string id, std::int64_t sequence)
      : store_(store), id_(std::move(id)), sequence_(sequence) {}

  Store& store_;
  const std::string id_;
  // Guarded by the store's mutex.
  Pending pending_;
  std::int64_t sequence_;
  bool time_alone_ = false;  // only time had changed in the last moment
  bool forgotten_ = false;
  absl::Status LeaseProblem() const;                       // Requires: the store's mutex
  bool waiting_ = false;                                   // in the store's list of journals to write
  std::int64_t requested_ = 0, written_ = 0, copied_ = 0;  // changes
  bool lost_ = false;                                      // another server has the session
  bool lags_ = false;                                      // its copy is incomplete
  absl::Status problem_;
};

// Thread-safe, except that Load, LoadRecords and LimitSize come before anything is saved.
class Store {
 public:
  // Opens FOLDER/phrenic.db, and creates it if it is missing. The errors of Database::Open, Prepare and CheckMarker.
  static absl::StatusOr<std::unique_ptr<Store>> Open(const std::string& folder);
  // Tries once to write what waits.
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  // Return what an earlier server saved. Requires: nothing has been saved yet.
  absl::StatusOr<std::vector<SavedSession>> Load();
  absl::StatusOr<std::vector<SavedRecord>> LoadRecords();
  // Saves a record by its kind and id, and replaces an earlier one; Remove removes it. The disk has it within
  // milliseconds, or once it has room.
  void Put(const std::string& kind, const std::string& id, std::string bytes) ABSL_LOCKS_EXCLUDED(mutex_);
  void Remove(const std::string& kind, const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Waits until the effects of all earlier Put and Remove are on the disk. The errors of Journal::Flush.
  absl::Status FlushRecords() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Makes the store copy every session's part to `ownership` as well, once it is on the disk. Requires: nothing has
  // been saved yet. `ownership` outlives the store.
  void set_ownership(Ownership* ownership) ABSL_LOCKS_EXCLUDED(mutex_);
  // Makes the store copy everything that it has of these sessions to the ownership.
  void CopyWhole(const std::vector<std::string>& ids) ABSL_LOCKS_EXCLUDED(mutex_);
  // Limits the size of the file [bytes]; beyond it the disk counts as full.
  absl::Status LimitSize(std::int64_t bytes);
  // Returns the journal of a new session. The store has the session once its first state is kept.
  std::shared_ptr<Journal> Begin(const std::string& id, v1::SavedScene scene) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the journal of a session that was loaded.
  std::shared_ptr<Journal> Continue(const SavedSession& saved) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  friend class Journal;
  using Batch = std::vector<std::pair<std::shared_ptr<Journal>, Journal::Pending>>;
  struct Record {
    std::string kind, id;
    std::optional<std::string> bytes;  // nullopt: to be removed
  };
  using Records = std::vector<Record>;  // in the order of the first call for each

  // How many changes of records were requested, and how many are on the disk.
  struct RecordsProgress {
    std::int64_t requested = 0, written = 0;
    absl::Status problem;  // of the last attempt
  };

  Store(std::string folder, Database database);
  void Enqueue(Record record) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Enqueue(Journal& journal) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool Closing() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return closing_; }
  bool Awake() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return closing_ || HasWork(); }
  bool HasWork() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return !waiting_.empty() || !records_.empty() || !whole_.empty() || sync_wanted_;
  }
  // The store's thread: takes what waits, writes it in one transaction, syncs it if a call waits for that, copies it.
  void Run() ABSL_LOCKS_EXCLUDED(mutex_);
  // Waits for work, or until what is written must be synced. Returns false if the store closes and nothing waits.
  bool AwaitWork() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Batch TakeBatch() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void PutBack(Batch& batch, Records& records) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status Write(const Batch& batch, const Records& records) ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status WriteRows(const Batch& batch, const Records& records);
  void NoteWritten(const Batch& batch, bool nothing, const absl::Status& status) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Syncs what is written, and then the marker if it has changed.
  void Sync() ABSL_LOCKS_EXCLUDED(mutex_);
  // Waits until everything written so far is synced.
  absl::Status AwaitSync() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Copies the batch, and completes copies, for a server in a cluster.
  void Copy(Ownership& ownership, Batch& batch, const std::set<std::string>& whole) ABSL_LOCKS_EXCLUDED(mutex_);
  void CopyOne(Ownership& ownership, Journal& journal, Journal::Pending& pending) ABSL_LOCKS_EXCLUDED(mutex_);
  void CompleteCopy(Ownership& ownership, const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);

  const std::string folder_;
  Database database_;             // used by the caller of Load first, and then by thread_ alone
  std::optional<Marker> marker_;  // not in its file yet; as database_
  absl::Time marked_;             // when the marker was written last; as database_
  mutable absl::Mutex mutex_;
  std::vector<std::shared_ptr<Journal>> waiting_
      ABSL_GUARDED_BY(mutex_);               // journals to write, in the order of their calls
  Records records_ ABSL_GUARDED_BY(mutex_);  // to write, each id once
  RecordsProgress progress_ ABSL_GUARDED_BY(mutex_);
  std::set<std::string> whole_ ABSL_GUARDED_BY(mutex_);                              // to be copied
  std::map<std::string, std::shared_ptr<Journal>> lagging_ ABSL_GUARDED_BY(mutex_);  // whose copies are incomplete
  std::int64_t commits_ ABSL_GUARDED_BY(mutex_) = 0, synced_ ABSL_GUARDED_BY(mutex_) = 0;  // transactions
  bool sync_wanted_ ABSL_GUARDED_BY(mutex_) = false;
  absl::Time unsynced_since_ ABSL_GUARDED_BY(mutex_);
  absl::Status sync_problem_ ABSL_GUARDED_BY(mutex_);
  Ownership* ownership_ ABSL_GUARDED_BY(mutex_) = nullptr;
  bool closing_ ABSL_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_STORE_H_
