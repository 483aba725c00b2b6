// A small file beside a store's database that says what the database holds. SQLite opens an emptied file, or one whose
// write-ahead log was removed, without an error; the marker makes that loss visible.
//
//   FOLDER/phrenic.marker    "phrenic store ID", "saves N", "sessions N", "jobs N", one a line
//   table marker             the same in the database, written in the transaction that changes the numbers
//
// The file is written after the database is on the disk, so that it never says more than the database holds.
#ifndef PHRENIC_SERVER_STORE_MARKER_H_
#define PHRENIC_SERVER_STORE_MARKER_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "server/store/sqlite.h"

namespace phrenic::store {

struct Marker {
  std::string id;          // of the store, random
  std::int64_t saves = 0;  // how often the marker was written: a smaller number in the database means an older one
  std::int64_t sessions = 0;
  std::int64_t jobs = 0;  // studies and exports
};

// Return FOLDER/phrenic.db and FOLDER/phrenic.marker.
std::string StoreFile(const std::string& folder);
std::string MarkerFile(const std::string& folder);

// Returns the marker in the folder; nullopt if there is none. DATA_LOSS if it cannot be read.
absl::StatusOr<std::optional<Marker>> ReadMarkerFile(const std::string& folder);
// Replaces the file; it is on the disk when the call returns. RESOURCE_EXHAUSTED or UNAVAILABLE if it cannot be
// written.
absl::Status WriteMarkerFile(const std::string& folder, const Marker& marker);

// Returns DATA_LOSS if the marker says that the folder holds sessions or jobs, but its database file is missing or
// empty. Call it before SQLite opens, and so creates, the file.
absl::Status CheckDatabaseExists(const std::string& folder);
// Returns DATA_LOSS, with the remedy, if the database holds less than the marker file says. Requires: Examine has
// accepted the database.
absl::Status CheckMarker(const std::string& folder, Database& database);

// Counts a save in the database's table, with the present numbers of sessions and jobs, and returns the marker. Makes
// the first one. Requires: a transaction.
absl::StatusOr<Marker> UpdateMarker(Database& database);

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_MARKER_H_
