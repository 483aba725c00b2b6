#include "server/store/store.h"

#include <pthread.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/schema/sha256.h"
#include "server/store/saved_state.h"

namespace phrenic::store {
namespace {

constexpr absl::Duration kAgain = absl::Seconds(1);  // after a failed attempt

// The statements of one transaction.
struct Writer {
  static absl::StatusOr<Writer> Make(const Database& database) {
    auto scene =
        Statement::Prepare(database, "INSERT OR REPLACE INTO sessions (id, scene, scene_sha256) VALUES (?, ?, ?)");
    auto state = Statement::Prepare(
        database, "UPDATE sessions SET sequence = ?2, moment = ?3, state = ?4, sha256 = ?5 WHERE id = ?1");
    auto shorten = Statement::Prepare(database, "DELETE FROM journal WHERE session = ? AND sequence <= ?");
    auto moment = Statement::Prepare(database, "INSERT OR REPLACE INTO journal VALUES (?, ?, ?, ?)");
    auto forget = Statement::Prepare(database, "DELETE FROM sessions WHERE id = ?");
    auto record = Statement::Prepare(database,
                                     "INSERT INTO records (kind, id, bytes, sha256) VALUES (?1, ?2, ?3, ?4) ON "
                                     "CONFLICT (kind, id) DO UPDATE SET bytes = ?3, sha256 = ?4");
    auto remove = Statement::Prepare(database, "DELETE FROM records WHERE kind = ? AND id = ?");
    for (const auto* statement : {&scene, &state, &shorten, &moment, &forget, &record, &remove}) {
      if (!statement->ok()) return statement->status();
    }
    return Writer{*std::move(scene),  *std::move(state),  *std::move(shorten), *std::move(moment),
                  *std::move(forget), *std::move(record), *std::move(remove)};
  }

  absl::Status Shorten(const std::string& id, std::int64_t last) { return shorten.Bind(1, id).Bind(2, last).Run(); }
  absl::Status WriteScene(const std::string& id, const v1::SavedScene& saved) {
    const std::string bytes = saved.SerializeAsString();
    if (absl::Status status = Shorten(id, INT64_MAX); !status.ok()) return status;
    return scene.Bind(1, id).BindBytes(2, bytes).Bind(3, Sha256Hex(bytes)).Run();
  }
  absl::Status WriteState(const std::string& id, std::int64_t sequence, const v1::SavedMoment& at, const State& saved) {
    const std::string words = at.SerializeAsString(), bytes = Save(saved).SerializeAsString();
    Sha256 hash;
    hash.Add(words);
    hash.Add(bytes);
    state.Bind(1, id).Bind(2, sequence).BindBytes(3, words).BindBytes(4, bytes).Bind(5, hash.Hex());
    if (absl::Status status = state.Run(); !status.ok()) return status;
    return Shorten(id, sequence);
  }
  absl::Status WriteMoment(const std::string& id, std::int64_t sequence, const v1::SavedMoment& saved) {
    const std::string bytes = saved.SerializeAsString();
    return moment.Bind(1, id).Bind(2, sequence).BindBytes(3, bytes).Bind(4, Sha256Hex(bytes)).Run();
  }
  absl::Status Forget(const std::string& id) {
    if (absl::Status status = Shorten(id, INT64_MAX); !status.ok()) return status;
    return forget.Bind(1, id).Run();
  }

  absl::Status WriteRecord(const std::string& kind, const std::string& id, const std::optional<std::string>& bytes) {
    if (!bytes.has_value()) return remove.Bind(1, kind).Bind(2, id).Run();
    return record.Bind(1, kind).Bind(2, id).BindBytes(3, *bytes).Bind(4, Sha256Hex(*bytes)).Run();
  }

  Statement scene, state, shorten, moment, forget, record, remove;
};

}  // namespace

Store::Store(Database database) : database_(std::move(database)), thread_([this] { Run(); }) {}

absl::StatusOr<std::unique_ptr<Store>> Store::Open(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return absl::NotFoundError(absl::StrCat("cannot create the folder ", folder, ": ", error.message()));
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all, error);
  auto database = Database::Open(StoreFile(folder), Access::kWrite);
  if (!database.ok()) return database.status();
  if (absl::Status status = Prepare(folder, *database); !status.ok()) return status;
  return std::unique_ptr<Store>(new Store(*std::move(database)));
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
void Store::PutBack(Batch& batch) {
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
}

absl::Status Store::Write(const Batch& batch, const Records& records) {
  if (absl::Status status = database_.Run("BEGIN IMMEDIATE"); !status.ok()) return status;
  absl::StatusOr<Writer> writer = Writer::Make(database_);
  absl::Status status = writer.status();
  for (const auto& [journal, pending] : batch) {
    if (!status.ok()) break;
    if (pending.forgotten) status = writer->Forget(journal->id_);
    if (status.ok() && pending.scene.has_value()) status = writer->WriteScene(journal->id_, *pending.scene);
    if (status.ok() && pending.kept.has_value()) {
      const Journal::Kept& kept = *pending.kept;
      status = writer->WriteState(journal->id_, kept.sequence, kept.moment, *kept.state);
    }
    for (const auto& [sequence, moment] : pending.moments) {
      if (status.ok()) status = writer->WriteMoment(journal->id_, sequence, moment);
    }
  }
  for (const auto& [kind, id, bytes] : records) {
    if (status.ok()) status = writer->WriteRecord(kind, id, bytes);
  }
  if (status.ok()) status = database_.Run("COMMIT");
  if (!status.ok()) database_.Run("ROLLBACK").IgnoreError();
  return status;
}

void Store::set_ownership(Ownership* ownership) {
  absl::MutexLock lock(&mutex_);
  ownership_ = ownership;
}

void Store::CopyWhole(const std::vector<std::string>& ids) {
  absl::MutexLock lock(&mutex_);
  whole_.insert(ids.begin(), ids.end());
}

std::vector<absl::Status> Store::Copy(Ownership* ownership, Batch& batch, const std::set<std::string>& whole) {
  std::vector<absl::Status> results(batch.size());
  if (ownership == nullptr) return results;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    auto& [journal, pending] = batch[i];
    Written written;
    written.id = journal->id_;
    written.forgotten = pending.forgotten;
    written.scene = std::move(pending.scene);
    if (pending.kept.has_value()) {
      written.sequence = pending.kept->sequence;
      written.moment = std::move(pending.kept->moment);
      written.state = std::move(pending.kept->state);
    }
    written.moments = std::move(pending.moments);
    if (ownership->Copy(written)) continue;
    results[i] = absl::AbortedError(absl::StrCat(
        "session ", journal->id_, " continues on another server, without this change; repeat the change there"));
  }
  for (const std::string& id : whole) {
    const auto sessions = ReadSessions(database_, id);
    if (sessions.ok() && !sessions->empty() && sessions->front().problem.ok()) ownership->CopyWhole(sessions->front());
  }
  return results;
}

void Store::Run() {
  pthread_setname_np(pthread_self(), "saving");
  absl::MutexLock lock(&mutex_);
  for (;;) {
    mutex_.Await(absl::Condition(this, &Store::Awake));
    if (!HasWork()) return;
    const bool last = closing_;
    Batch batch = TakeBatch();
    Records records = std::exchange(records_, {});
    const std::int64_t records_requested = progress_.requested;
    const std::set<std::string> whole = std::exchange(whole_, {});
    Ownership* const ownership = ownership_;
    mutex_.Unlock();
    const absl::Status status = Write(batch, records);
    std::vector<absl::Status> results(batch.size(), status);
    if (status.ok()) results = Copy(ownership, batch, whole);
    mutex_.Lock();
    progress_.problem = status;
    if (status.ok()) progress_.written = records_requested;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      Journal& journal = *batch[i].first;
      journal.problem_ = results[i];
      if (results[i].ok()) journal.written_ = batch[i].second.requested;
    }
    if (status.ok()) continue;
    if (last) return;
    PutBack(batch);
    records_.swap(records);
    for (Record& newer : records) Enqueue(std::move(newer));
    mutex_.AwaitWithTimeout(absl::Condition(this, &Store::Closing), kAgain);
  }
}

}  // namespace phrenic::store
