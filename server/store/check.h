// Reads a store without changing it, and checks that it is whole.
#ifndef PHRENIC_SERVER_STORE_CHECK_H_
#define PHRENIC_SERVER_STORE_CHECK_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/store/layout.h"

namespace phrenic::store {

struct CheckedStore {
  absl::Status problem;                // of the file as a whole, if sessions can be read nevertheless
  std::vector<SavedSession> sessions;  // each with its own problem
  std::vector<SavedRecord> records;    // of studies and exports, each with its own problem
  // True if there is no problem.
  bool whole() const;
};

// NOT_FOUND if there is no store, FAILED_PRECONDITION while a server uses it or if its format is newer, DATA_LOSS if
// nothing of it can be read, or if the database is missing or empty and its marker says otherwise.
absl::StatusOr<CheckedStore> CheckStore(const std::string& folder);

// Returns a text for people: one line per session, one for everything else that is damaged, and one for the whole.
std::string Describe(const std::string& folder, const CheckedStore& store);

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_CHECK_H_
