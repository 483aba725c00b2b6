// The tables of a store's SQLite file, and checks of a file.
#ifndef PHRENIC_SERVER_STORE_LAYOUT_H_
#define PHRENIC_SERVER_STORE_LAYOUT_H_

#include <string>
#include <vector>

#include "phrenic/v1/saved.pb.h"
#include "server/store/marker.h"
#include "server/store/sqlite.h"

namespace phrenic::store {

inline constexpr int kFormat = 3;  // version of the tables

// What a store has of one session.
struct SavedSession {
  std::string id;
  v1::SavedScene scene;
  v1::SavedMoment moment;  // at `state`
  v1::SavedState state;
  std::vector<v1::SavedMoment> later;  // the journal since then, in order
  std::int64_t sequence = 0;           // of the last moment
  std::int64_t bytes = 0;
  absl::Status problem;  // DATA_LOSS if a checksum does not match
};

// What a store has of a job: a message, by its kind ("study", "export") and id.
struct SavedRecord {
  std::string kind, id, bytes;
  absl::Status problem;  // DATA_LOSS, as above
};

// Creates the tables in an empty file, and those that a file of an earlier format lacks; transactions are on the disk
// after Database::Sync. FAILED_PRECONDITION if another
// program or a newer Phrenic wrote the file, DATA_LOSS if SQLite finds it damaged; the file is then left unchanged.
absl::Status Prepare(const std::string& folder, Database& database);
// Makes the same checks, and creates nothing.
absl::Status Examine(const std::string& folder, Database& database);

// Reads all sessions, sorted by id, or only the session `only`. A damaged session has a `problem`, and the others are
// read nevertheless.
absl::StatusOr<std::vector<SavedSession>> ReadSessions(Database& database, const std::string& only = "");
// Reads all records, in the order in which they were first saved; a damaged one has a `problem`. A store of format 1
// has none.
absl::StatusOr<std::vector<SavedRecord>> ReadRecords(Database& database);

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_LAYOUT_H_
