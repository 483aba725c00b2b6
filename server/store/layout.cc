#include "server/store/layout.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "server/crypto/sha256.h"

namespace phrenic::store {
namespace {

constexpr int kApplication = 0x5068726e;  // "Phrn"

constexpr char kTables[] = R"(
  CREATE TABLE sessions (id TEXT PRIMARY KEY, scene BLOB NOT NULL, scene_sha256 TEXT NOT NULL,
                         sequence INTEGER, moment BLOB, state BLOB, sha256 TEXT) WITHOUT ROWID;
  CREATE TABLE journal (session TEXT NOT NULL, sequence INTEGER NOT NULL, moment BLOB NOT NULL, sha256 TEXT NOT NULL,
                        PRIMARY KEY (session, sequence)) WITHOUT ROWID;)";

// Since format 2.
constexpr char kRecordTable[] = R"(
  CREATE TABLE records (number INTEGER PRIMARY KEY, kind TEXT NOT NULL, id TEXT NOT NULL, bytes BLOB NOT NULL,
                        sha256 TEXT NOT NULL, UNIQUE (kind, id));)";

// Since format 3: one row (marker.h).
constexpr char kMarkerTable[] = R"(
  CREATE TABLE IF NOT EXISTS marker (number INTEGER PRIMARY KEY, id TEXT NOT NULL, saves INTEGER NOT NULL);)";

absl::Status Damaged(const std::string& id, const char* what) {
  return absl::DataLossError(absl::StrCat("session ", id, ": its ", what, " is damaged in the store"));
}

// Parses a message. Returns false if its checksum does not match.
template <typename Message>
bool Parse(std::string_view bytes, std::string_view sha256, Message& message) {
  return Sha256Hex(bytes) == sha256 && message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

absl::Status ReadState(const Statement& row, SavedSession& session) {
  const std::string_view moment = row.Bytes(4), state = row.Bytes(5);
  Sha256 hash;
  hash.Add(moment);
  hash.Add(state);
  const bool good = hash.Hex() == row.Bytes(6) &&
                    session.moment.ParseFromArray(moment.data(), static_cast<int>(moment.size())) &&
                    session.state.ParseFromArray(state.data(), static_cast<int>(state.size()));
  return good ? absl::OkStatus() : Damaged(session.id, "state");
}

absl::Status ReadJournal(Database& database, SavedSession& session) {
  auto rows =
      Statement::Prepare(database, "SELECT sequence, moment, sha256 FROM journal WHERE session = ? ORDER BY sequence");
  if (!rows.ok()) return rows.status();
  rows->Bind(1, session.id);
  for (;;) {
    const absl::StatusOr<bool> row = rows->Next();
    if (!row.ok()) return row.status();
    if (!*row) return absl::OkStatus();
    if (!Parse(rows->Bytes(1), rows->Bytes(2), session.later.emplace_back())) return Damaged(session.id, "journal");
    session.sequence = rows->Number(0);
    session.bytes += static_cast<std::int64_t>(rows->Bytes(1).size());
  }
}

}  // namespace

absl::Status Examine(const std::string& folder, Database& database) {
  const absl::StatusOr<std::int64_t> application = database.Number("PRAGMA application_id");
  if (!application.ok()) return application.status();
  const absl::StatusOr<std::int64_t> format = database.Number("PRAGMA user_version");
  if (!format.ok()) return format.status();
  if (*application != kApplication) {
    return absl::FailedPreconditionError(
        absl::StrCat(StoreFile(folder), " belongs to another program: name another folder with --store"));
  }
  if (*format > kFormat) {
    return absl::FailedPreconditionError(absl::StrCat(StoreFile(folder), " is of format ", *format,
                                                      ", written by a newer Phrenic; this one reads ", kFormat,
                                                      ". Nothing was changed: run the newer one, or name another "
                                                      "folder with --store"));
  }
  const absl::StatusOr<std::string> found = database.Text("PRAGMA quick_check(1)");
  if (!found.ok()) return found.status();
  if (*found == "ok") return absl::OkStatus();
  return absl::DataLossError(absl::StrCat(StoreFile(folder), " is damaged (", *found,
                                          "): nothing was changed; phrenicd check lists what can be read"));
}

namespace {

// Adds the tables that an earlier format lacks. Requires: Examine has accepted the file.
absl::Status Upgrade(Database& database) {
  const absl::StatusOr<std::int64_t> format = database.Number("PRAGMA user_version");
  if (!format.ok() || *format == kFormat) return format.status();
  return database.Run(
      absl::StrCat("PRAGMA user_version = ", kFormat, ";", *format < 2 ? kRecordTable : "", kMarkerTable));
}

absl::Status ExamineAll(const std::string& folder, Database& database) {
  const absl::Status status = Examine(folder, database);
  return status.ok() ? CheckMarker(folder, database) : status;
}

}  // namespace

absl::Status Prepare(const std::string& folder, Database& database) {
  if (absl::Status status = database.Run("PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE"); !status.ok())
    return status;
  const absl::StatusOr<std::int64_t> tables = database.Number("SELECT count(*) FROM sqlite_master");
  if (!tables.ok()) return tables.status();
  absl::Status status =
      *tables > 0
          ? ExamineAll(folder, database)
          : database.Run(absl::StrCat("PRAGMA application_id = ", kApplication, "; PRAGMA user_version = ", kFormat,
                                      ";", kTables, kRecordTable, kMarkerTable));
  if (status.ok()) status = Upgrade(database);
  if (!status.ok()) {
    database.Run("ROLLBACK").IgnoreError();
    return status;
  }
  // NORMAL: the store syncs what callers wait for (Database::Sync). Steps write a page each: the log may grow to 16 MB,
  // so that it is rarely copied into the file.
  return database.Run(
      "COMMIT; PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; PRAGMA wal_autocheckpoint = 4000");
}

absl::StatusOr<std::vector<SavedSession>> ReadSessions(Database& database, const std::string& only) {
  auto rows = Statement::Prepare(database,
                                 "SELECT id, scene, scene_sha256, sequence, moment, state, sha256 FROM sessions "
                                 "WHERE state IS NOT NULL AND (?1 = '' OR id = ?1) ORDER BY id");
  if (!rows.ok()) return rows.status();
  rows->Bind(1, only);
  std::vector<SavedSession> sessions;
  for (;;) {
    const absl::StatusOr<bool> row = rows->Next();
    if (!row.ok()) return row.status();
    if (!*row) return sessions;
    SavedSession& session = sessions.emplace_back();
    session.id = std::string(rows->Bytes(0));
    session.sequence = rows->Number(3);
    for (const int column : {1, 4, 5}) session.bytes += static_cast<std::int64_t>(rows->Bytes(column).size());
    session.problem =
        Parse(rows->Bytes(1), rows->Bytes(2), session.scene) ? ReadState(*rows, session) : Damaged(session.id, "scene");
    if (session.problem.ok()) session.problem = ReadJournal(database, session);
  }
}

absl::StatusOr<std::vector<SavedRecord>> ReadRecords(Database& database) {
  std::vector<SavedRecord> records;
  const auto tables = database.Number("SELECT count(*) FROM sqlite_master WHERE name = 'records'");
  if (!tables.ok()) return tables.status();
  if (*tables == 0) return records;
  auto rows = Statement::Prepare(database, "SELECT kind, id, bytes, sha256 FROM records ORDER BY number");
  if (!rows.ok()) return rows.status();
  for (;;) {
    const absl::StatusOr<bool> row = rows->Next();
    if (!row.ok()) return row.status();
    if (!*row) return records;
    SavedRecord& record = records.emplace_back();
    record.kind = std::string(rows->Bytes(0));
    record.id = std::string(rows->Bytes(1));
    record.bytes = std::string(rows->Bytes(2));
    if (Sha256Hex(record.bytes) == rows->Bytes(3)) continue;
    record.problem = absl::DataLossError(absl::StrCat(record.kind, " ", record.id, " is damaged in the store"));
  }
}

}  // namespace phrenic::store
