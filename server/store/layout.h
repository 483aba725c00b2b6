// The tables of a store, and whether a file is one.
#ifndef PHRENIC_SERVER_STORE_LAYOUT_H_
#define PHRENIC_SERVER_STORE_LAYOUT_H_

#include <string>
#include <vector>

#include "phrenic/v1/saved.pb.h"
#include "server/store/sqlite.h"

namespace phrenic::store {

inline constexpr int kFormat = 2;  // of the tables; grows when they change

// What the store has of one session.
struct SavedSession {
  std::string id;
  v1::SavedScene scene;
  v1::SavedMoment moment;  // at `state`
  v1::SavedState state;
  std::vector<v1::SavedMoment> later;  // since then, in their order
  std::int64_t sequence = 0;           // of the last one
  std::int64_t bytes = 0;
  absl::Status problem;  // DATA_LOSS: what was read is not what was written
};

// What the store has of something else: a message, by its kind ("study") and name.
struct SavedRecord {
  std::string kind, id, bytes;
  absl::Status problem;  // DATA_LOSS, as above
};

// FOLDER/phrenic.db
std::string StoreFile(const std::string& folder);

// Makes the tables in an empty file, and what a file of an earlier format lacks. Else FAILED_PRECONDITION where another
// program wrote it or a newer Phrenic, and DATA_LOSS where SQLite finds it damaged; nothing is changed then.
absl::Status Prepare(const std::string& folder, Database& database);
// The same checks, and nothing is made.
absl::Status Examine(const std::string& folder, Database& database);

// Every session, in the order of the ids; one with a `problem` does not keep the others from being read.
// `only` names the one to read; empty: all.
absl::StatusOr<std::vector<SavedSession>> ReadSessions(Database& database, const std::string& only = "");
// Every record, in the order in which they were first saved; as with sessions. A store of format 1 has none.
absl::StatusOr<std::vector<SavedRecord>> ReadRecords(Database& database);

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_LAYOUT_H_
