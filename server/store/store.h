// Sessions on disk: an SQLite file in which each has its scene, a state now and then, and what it was told since. A
// thread of the store writes; whoever has something to save hands it over and goes on, or waits for it.
#ifndef PHRENIC_SERVER_STORE_STORE_H_
#define PHRENIC_SERVER_STORE_STORE_H_

#include <cstdint>
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
#include "server/mechanics/state.h"
#include "server/store/layout.h"
#include "server/store/ownership.h"

namespace phrenic::store {

class Store;

// One session's part of a store, which outlives it. Any thread may call.
class Journal : public std::enable_shared_from_this<Journal> {
 public:
  // What the session was told, at its present tick. One that tells of time alone takes the place of another such one.
  void Append(v1::SavedMoment moment, bool time_alone);
  // A state; what was appended before is not needed any more.
  void Keep(v1::SavedMoment moment, std::shared_ptr<const State> state);
  // Removes the session from the store; what is saved afterwards is not.
  void Forget();
  // Waits until all this is on the disk. RESOURCE_EXHAUSTED where that is full, UNAVAILABLE with what else is wrong:
  // the store tries again every second.
  absl::Status Flush();
  // The last attempt's result.
  absl::Status problem() const;
  // More waits to be written than should: a state would replace it.
  bool wants_state() const;

 private:
  friend class Store;
  struct Kept {
    std::int64_t sequence = 0;
    v1::SavedMoment moment;
    std::shared_ptr<const State> state;
  };
  // What is not on the disk yet.
  struct Pending {
    std::optional<v1::SavedScene> scene;
    std::optional<Kept> kept;
    std::vector<std::pair<std::int64_t, v1::SavedMoment>> moments;
    bool forgotten = false;
    std::int64_t told = 0;
  };

  Journal(Store& store, std::string id, std::int64_t sequence)
      : store_(store), id_(std::move(id)), sequence_(sequence) {}

  Store& store_;
  const std::string id_;
  // Guarded by the store's mutex.
  Pending pending_;
  std::int64_t sequence_;
  bool time_alone_ = false;  // the last moment told of time alone
  bool forgotten_ = false;
  bool waiting_ = false;  // in the store's list
  std::int64_t told_ = 0, written_ = 0;
  absl::Status problem_;
};

class Store {
 public:
  // FOLDER/phrenic.db, made where it is missing. The errors of Database::Open and Prepare.
  static absl::StatusOr<std::unique_ptr<Store>> Open(const std::string& folder);
  // Writes what waits, once.
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  // What an earlier server left; before anything is saved.
  absl::StatusOr<std::vector<SavedSession>> Load();
  absl::StatusOr<std::vector<SavedRecord>> LoadRecords();
  // Saves a message by its kind and name, in the place of an earlier one, or removes it; on the disk within
  // milliseconds, or once that has room.
  void Put(const std::string& kind, const std::string& id, std::string bytes) ABSL_LOCKS_EXCLUDED(mutex_);
  void Remove(const std::string& kind, const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Waits until all that Put and Remove were told is on the disk. The errors of Journal::Flush.
  absl::Status FlushRecords() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Has every session's part copied there as well, once it is on the disk; before anything is saved. `ownership`
  // outlives the store.
  void set_ownership(Ownership* ownership) ABSL_LOCKS_EXCLUDED(mutex_);
  // Has all that the disk has of these copied there.
  void CopyWhole(const std::vector<std::string>& ids) ABSL_LOCKS_EXCLUDED(mutex_);
  // The file may grow no larger [bytes]: past that the disk counts as full.
  absl::Status LimitSize(std::int64_t bytes);
  // Of a new session, which is in the store with its first state.
  std::shared_ptr<Journal> Begin(const std::string& id, v1::SavedScene scene) ABSL_LOCKS_EXCLUDED(mutex_);
  // Of one that was loaded.
  std::shared_ptr<Journal> Continue(const SavedSession& saved) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  friend class Journal;
  using Batch = std::vector<std::pair<std::shared_ptr<Journal>, Journal::Pending>>;
  struct Record {
    std::string kind, id;
    std::optional<std::string> bytes;  // nothing: remove it
  };
  using Records = std::vector<Record>;  // in the order in which they were first told

  // How far the disk has what records were told.
  struct RecordsProgress {
    std::int64_t told = 0, written = 0;
    absl::Status problem;  // the last attempt's
  };

  explicit Store(Database database);
  void Tell(Record record) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Told(Journal& journal) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool Closing() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return closing_; }
  bool Stirred() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return closing_ || Waits(); }
  bool Waits() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return !waiting_.empty() || !records_.empty() || !whole_.empty();
  }
  void Run() ABSL_LOCKS_EXCLUDED(mutex_);
  Batch TakeBatch() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void PutBack(Batch& batch) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status Write(const Batch& batch, const Records& records);
  // What came of each of the batch: ABORTED for a session that is another server's by now.
  std::vector<absl::Status> Copy(Ownership* ownership, Batch& batch, const std::set<std::string>& whole);

  Database database_;  // of one thread at a time
  mutable absl::Mutex mutex_;
  std::vector<std::shared_ptr<Journal>> waiting_ ABSL_GUARDED_BY(mutex_);  // in the order in which they were told
  Records records_ ABSL_GUARDED_BY(mutex_);                                // that wait, each name once
  RecordsProgress progress_ ABSL_GUARDED_BY(mutex_);
  std::set<std::string> whole_ ABSL_GUARDED_BY(mutex_);  // to be copied
  Ownership* ownership_ ABSL_GUARDED_BY(mutex_) = nullptr;
  bool closing_ ABSL_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_STORE_H_
