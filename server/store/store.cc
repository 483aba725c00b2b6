#include "server/store/store.h"

#include <pthread.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "absl/functional/function_ref.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "server/crypto/sha256.h"
#include "server/store/saved_state.h"

namespace phrenic::store {
namespace {

constexpr absl::Duration kAgain = absl::Seconds(1);  // after a failed attempt
// What is written is synced after this time, also if no call waits for it.
constexpr absl::Duration kSyncPeriod = absl::Milliseconds(500);
// The marker is written when a session or a job comes or goes, and this often while sessions change.
constexpr absl::Duration kMarkerPeriod = absl::Seconds(10);

// The statements of one transaction, each prepared when it is first used: most transactions are one moment.
class Writer {
 public:
  explicit Writer(const Database& database) : database_(database) {}

  absl::Status WriteScene(const std::string& id, const v1::SavedScene& saved) {
    const std::string bytes = saved.SerializeAsString();
    if (absl::Status status = Shorten(id, INT64_MAX); !status.ok()) return status;
    return Run(scene_, "INSERT OR REPLACE INTO sessions (id, scene, scene_sha256) VALUES (?, ?, ?)",
               [&](Statement& row) { row.Bind(1, id).BindBytes(2, bytes).Bind(3, Sha256Hex(bytes)); });
  }
  absl::Status WriteState(const std::string& id, std::int64_t sequence, const v1::SavedMoment& at, const State& saved) {
    const std::string words = at.SerializeAsString(), bytes = Save(saved).SerializeAsString();
    Sha256 hash;
    hash.Add(words);
    hash.Add(bytes);
    const absl::Status status =
        Run(state_, "UPDATE sessions SET sequence = ?2, moment = ?3, state = ?4, sha256 = ?5 WHERE id = ?1",
            [&](Statement& row) {
              row.Bind(1, id).Bind(2, sequence).BindBytes(3, words).BindBytes(4, bytes).Bind(5, hash.Hex());
            });
    return status.ok() ? Shorten(id, sequence) : status;
  }
  absl::Status WriteMoment(const std::string& id, std::int64_t sequence, const v1::SavedMoment& saved) {
    const std::string bytes = saved.SerializeAsString();
    return Run(moment_, "INSERT OR REPLACE INTO journal VALUES (?, ?, ?, ?)", [&](Statement& row) {
      row.Bind(1, id).Bind(2, sequence).BindBytes(3, bytes).Bind(4, Sha256Hex(bytes));
    });
  }
  absl::Status Forget(const std::string& id) {
    if (absl::Status status = Shorten(id, INT64_MAX); !status.ok()) return status;
    return Run(forget_, "DELETE FROM sessions WHERE id = ?", [&](Statement& row) { row.Bind(1, id); });
  }
  absl::Status WriteRecord(const std::string& kind, const std::string& id, const std::optional<std::string>& bytes) {
    if (!bytes.has_value()) {
      return Run(remove_, "DELETE FROM records WHERE kind = ? AND id = ?",
                 [&](Statement& row) { row.Bind(1, kind).Bind(2, id); });
    }
    return Run(record_,
               "INSERT INTO records (kind, id, bytes, sha256) VALUES (?1, ?2, ?3, ?4) ON "
               "CONFLICT (kind, id) DO UPDATE SET bytes = ?3, sha256 = ?4",
               [&](Statement& row) { row.Bind(1, kind).Bind(2, id).BindBytes(3, *bytes).Bind(4, Sha256Hex(*bytes)); });
  }

 private:
  using Prepared = std::optional<Statement>;

  absl::Status Shorten(const std::string& id, std::int64_t last) {
    return Run(shorten_, "DELETE FROM journal WHERE session = ? AND sequence <= ?",
               [&](Statement& row) { row.Bind(1, id).Bind(2, last); });
  }
  absl::Status Run(Prepared& statement, const char* sql, absl::FunctionRef<void(Statement& row)> bind) {
    if (!statement.has_value()) {
      auto prepared = Statement::Prepare(database_, sql);
      if (!prepared.ok()) return prepared.status();
      statement = *std::move(prepared);
    }
    bind(*statement);
    return statement->Run();
  }

  const Database& database_;
  Prepared scene_, state_, shorten_, moment_, forget_, record_, remove_;
};

// Gives a store of an earlier release its marker. A full disk is reported by the first save.
void MarkOpened(const std::string& folder, Database& database) {
  if (!database.Run("BEGIN IMMEDIATE").ok()) return;
  const auto marker = UpdateMarker(database);
  const bool saved = marker.ok() && database.Run("COMMIT").ok() && database.Sync().ok();
  if (saved) WriteMarkerFile(folder, *marker).IgnoreError();
  if (!saved) database.Run("ROLLBACK").IgnoreError();
}

}  // namespace

Store::Store(std::string folder, Database database)
    : folder_(std::move(folder)), database_(std::move(database)), marked_(absl::Now()), thread_([this] { Run(); }) {}

absl::StatusOr<std::unique_ptr<Store>> Store::Open(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return absl::NotFoundError(absl::StrCat("cannot create the folder ", folder, ": ", error.message()));
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all, error);
  if (absl::Status status = CheckDatabaseExists(folder); !status.ok()) return status;
  auto database = Database::Open(StoreFile(folder), Access::kWrite);
  if (!database.ok()) return database.status();
  if (absl::Status status = Prepare(folder, *database); !status.ok()) return status;
  MarkOpened(folder, *database);
  return std::unique_ptr<Store>(new Store(folder, *std::move(database)));
}

Store::~Store() {
  {
    absl::MutexLock lock(&mutex_);
    closing_ = true;
  }
  thread_.join();
}

absl::StatusOr<std::vector<SavedSession>> Store::Load() { return ReadSessions(database_); }

absl::StatusOr<std::vector<SavedRecord>> Store::LoadRecords() { return ReadRecords(database_); }

void Store::Put(const std::string& kind, const std::string& id, std::string bytes) {
  absl::MutexLock lock(&mutex_);
  ++progress_.requested;
  Enqueue({kind, id, std::move(bytes)});
}

void Store::Remove(const std::string& kind, const std::string& id) {
  absl::MutexLock lock(&mutex_);
  ++progress_.requested;
  Enqueue({kind, id, std::nullopt});
}

absl::Status Store::FlushRecords() const {
  absl::MutexLock lock(&mutex_);
  const std::int64_t requested = progress_.requested;
  const auto settled = [this, requested] {
    mutex_.AssertReaderHeld();
    return progress_.written >= requested || !progress_.problem.ok();
  };
  mutex_.Await(absl::Condition(&settled));
  return progress_.written >= requested ? absl::OkStatus() : progress_.problem;
}

void Store::Enqueue(Record record) {
  const auto same = std::ranges::find_if(
      records_, [&](const Record& other) { return other.kind == record.kind && other.id == record.id; });
  if (same == records_.end()) {
    records_.push_back(std::move(record));
  } else {
    same->bytes = std::move(record.bytes);
  }
}

absl::Status Store::LimitSize(std::int64_t bytes) {
  const absl::StatusOr<std::int64_t> page = database_.Number("PRAGMA page_size");
  if (!page.ok()) return page.status();
  return database_.Run(absl::StrCat("PRAGMA max_page_count = ", bytes / *page));
}

std::shared_ptr<Journal> Store::Begin(const std::string& id, v1::SavedScene scene) {
  absl::MutexLock lock(&mutex_);
  std::shared_ptr<Journal> journal(new Journal(*this, id, 0));
  journal->pending_.scene = std::move(scene);
  return journal;
}

std::shared_ptr<Journal> Store::Continue(const SavedSession& saved) {
  return std::shared_ptr<Journal>(new Journal(*this, saved.id, saved.sequence));
}

void Store::Enqueue(Journal& journal) {
  ++journal.requested_;
  journal.pending_.requested = journal.requested_;
  if (journal.waiting_) return;
  journal.waiting_ = true;
  waiting_.push_back(journal.shared_from_this());
}

Store::Batch Store::TakeBatch() {
  Batch batch;
  for (auto& journal : waiting_) {
    journal->waiting_ = false;
    batch.emplace_back(journal, std::exchange(journal->pending_, {}));
  }
  waiting_.clear();
  return batch;
}

// Puts what could not be written before what came meanwhile, unless a newer state makes it unnecessary.
void Store::PutBack(Batch& batch, Records& records) {
  std::vector<std::shared_ptr<Journal>> waiting;
  for (auto& [journal, before] : batch) {
    Journal::Pending& now = journal->pending_;
    now.requested = journal->requested_;
    if (before.scene.has_value() && !now.forgotten) now.scene = std::move(before.scene);
    now.forgotten = now.forgotten || before.forgotten;
    if (!now.kept.has_value() && !now.forgotten) {
      now.kept = std::move(before.kept);
      before.moments.insert(before.moments.end(), now.moments.begin(), now.moments.end());
      now.moments = std::move(before.moments);
    }
    if (!journal->waiting_) waiting.push_back(journal);
    journal->waiting_ = true;
  }
  waiting_.insert(waiting_.begin(), waiting.begin(), waiting.end());
  records_.swap(records);
  for (Record& newer : records) Enqueue(std::move(newer));
}

absl::Status Store::WriteRows(const Batch& batch, const Records& records) {
  Writer writer(database_);
  absl::Status status;
  for (const auto& [journal, pending] : batch) {
    if (!status.ok()) break;
    if (pending.forgotten) status = writer.Forget(journal->id_);
    if (status.ok() && pending.scene.has_value()) status = writer.WriteScene(journal->id_, *pending.scene);
    if (status.ok() && pending.kept.has_value()) {
      const Journal::Kept& kept = *pending.kept;
      status = writer.WriteState(journal->id_, kept.sequence, kept.moment, *kept.state);
    }
    for (const auto& [sequence, moment] : pending.moments) {
      if (status.ok()) status = writer.WriteMoment(journal->id_, sequence, moment);
    }
  }
  for (const auto& [kind, id, bytes] : records) {
    if (status.ok()) status = writer.WriteRecord(kind, id, bytes);
  }
  return status;
}

absl::Status Store::Write(const Batch& batch, const Records& records) {
  if (batch.empty() && records.empty()) return absl::OkStatus();
  if (absl::Status status = database_.Run("BEGIN IMMEDIATE"); !status.ok()) return status;
  absl::Status status = WriteRows(batch, records);
  const bool counts = !records.empty() || std::ranges::any_of(batch, [](const auto& each) {
    return each.second.scene.has_value() || each.second.forgotten;
  });
  std::optional<Marker> marker;
  if (status.ok() && (counts || absl::Now() - marked_ >= kMarkerPeriod)) {
    auto updated = UpdateMarker(database_);
    status = updated.status();
    if (updated.ok()) marker = *std::move(updated);
  }
  if (status.ok()) status = database_.Run("COMMIT");
  if (!status.ok()) database_.Run("ROLLBACK").IgnoreError();
  if (status.ok() && marker.has_value()) marker_ = std::move(marker);
  return status;
}

void Store::NoteWritten(const Batch& batch, bool nothing, const absl::Status& status) {
  for (const auto& [journal, pending] : batch) {
    journal->problem_ = status;
    if (status.ok()) journal->written_ = pending.requested;
  }
  if (!status.ok() || nothing) return;
  if (synced_ == commits_) unsynced_since_ = absl::Now();
  ++commits_;
}

void Store::Sync() {
  std::int64_t commits = 0;
  {
    absl::MutexLock lock(&mutex_);
    commits = commits_;
    sync_wanted_ = false;
  }
  absl::Status status = database_.Sync();
  {
    absl::MutexLock lock(&mutex_);
    sync_problem_ = status;
    if (status.ok()) synced_ = commits;
    if (!status.ok()) unsynced_since_ = absl::Now() + kAgain;
  }
  if (!status.ok() || !marker_.has_value()) return;
  // A marker that cannot be written says too little, and the next one is tried.
  WriteMarkerFile(folder_, *std::exchange(marker_, std::nullopt)).IgnoreError();
  marked_ = absl::Now();
}

absl::Status Store::AwaitSync() {
  const std::int64_t commits = commits_;
  if (synced_ >= commits) return absl::OkStatus();
  sync_wanted_ = true;
  const auto settled = [this, commits] {
    mutex_.AssertReaderHeld();
    return synced_ >= commits || !sync_problem_.ok();
  };
  mutex_.Await(absl::Condition(&settled));
  return synced_ >= commits ? absl::OkStatus() : sync_problem_;
}

void Store::set_ownership(Ownership* ownership) {
  absl::MutexLock lock(&mutex_);
  ownership_ = ownership;
}

void Store::CopyWhole(const std::vector<std::string>& ids) {
  absl::MutexLock lock(&mutex_);
  whole_.insert(ids.begin(), ids.end());
}

void Store::CopyOne(Ownership& ownership, Journal& journal, Journal::Pending& pending) {
  Written written;
  written.id = journal.id_;
  written.forgotten = pending.forgotten;
  written.scene = std::move(pending.scene);
  if (pending.kept.has_value()) {
    written.sequence = pending.kept->sequence;
    written.moment = std::move(pending.kept->moment);
    written.state = std::move(pending.kept->state);
  }
  written.moments = std::move(pending.moments);
  const Copied copied = ownership.Copy(written);
  absl::MutexLock lock(&mutex_);
  journal.lags_ = copied == Copied::kLater;
  if (copied == Copied::kYes) journal.copied_ = pending.requested;
  if (copied == Copied::kLost) journal.lost_ = true;
  if (copied == Copied::kLater) {
    lagging_[journal.id_] = journal.shared_from_this();
  } else {
    lagging_.erase(journal.id_);
  }
}

void Store::CompleteCopy(Ownership& ownership, const std::string& id) {
  const auto sessions = ReadSessions(database_, id);
  if (!sessions.ok()) return;
  Copied copied = Copied::kLater;
  if (sessions->empty()) {
    Written gone;
    gone.id = id;
    gone.forgotten = true;
    copied = ownership.Copy(gone);
  } else if (sessions->front().problem.ok()) {
    copied = ownership.CopyWhole(sessions->front());
  }
  absl::MutexLock lock(&mutex_);
  const auto found = lagging_.find(id);
  if (found == lagging_.end() || copied == Copied::kLater) return;
  Journal& journal = *found->second;
  journal.lags_ = false;
  if (copied == Copied::kYes) journal.copied_ = journal.written_;  // only this thread writes
  if (copied == Copied::kLost) journal.lost_ = true;
  lagging_.erase(found);
}

void Store::Copy(Ownership& ownership, Batch& batch, const std::set<std::string>& whole) {
  for (auto& [journal, pending] : batch) CopyOne(ownership, *journal, pending);
  for (const std::string& id : whole) CompleteCopy(ownership, id);
}

bool Store::AwaitWork() {
  if (synced_ == commits_) {
    mutex_.Await(absl::Condition(this, &Store::Awake));
  } else if (!mutex_.AwaitWithDeadline(absl::Condition(this, &Store::Awake), unsynced_since_ + kSyncPeriod)) {
    sync_wanted_ = true;
  }
  const bool due = absl::Now() >= unsynced_since_ + kSyncPeriod || (closing_ && sync_problem_.ok());
  if (synced_ != commits_ && due) sync_wanted_ = true;
  return HasWork();
}

void Store::Run() {
  pthread_setname_np(pthread_self(), "saving");
  absl::MutexLock lock(&mutex_);
  while (AwaitWork()) {
    const bool last = closing_;
    Batch batch = TakeBatch();
    Records records = std::exchange(records_, {});
    const std::int64_t records_requested = progress_.requested;
    const std::set<std::string> whole = std::exchange(whole_, {});
    Ownership* const ownership = ownership_;
    mutex_.Unlock();
    absl::Status status = Write(batch, records);
    mutex_.Lock();
    NoteWritten(batch, batch.empty() && records.empty(), status);
    const bool sync = status.ok() && (sync_wanted_ || !records.empty());
    mutex_.Unlock();
    if (sync) Sync();
    if (status.ok() && ownership != nullptr) Copy(*ownership, batch, whole);
    mutex_.Lock();
    if (!records.empty() && status.ok() && !sync_problem_.ok()) {
      status = sync_problem_;
      batch.clear();  // it is written
    }
    progress_.problem = status;
    if (status.ok()) progress_.written = records_requested;
    if (status.ok()) continue;
    if (last) return;
    PutBack(batch, records);
    mutex_.AwaitWithTimeout(absl::Condition(this, &Store::Closing), kAgain);
  }
}

}  // namespace phrenic::store
