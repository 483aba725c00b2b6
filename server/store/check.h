// What is in a store, and whether it is whole; nothing in it is changed.
#ifndef PHRENIC_SERVER_STORE_CHECK_H_
#define PHRENIC_SERVER_STORE_CHECK_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/store/layout.h"

namespace phrenic::store {

struct CheckedStore {
  absl::Status problem;                // of the file as a whole, where sessions can be read all the same
  std::vector<SavedSession> sessions;  // each with its own problem
  std::vector<SavedRecord> records;    // studies and the like; as with sessions
  bool whole() const;
};

// NOT_FOUND where there is no store, FAILED_PRECONDITION while a server uses it, or where it is of a newer format,
// DATA_LOSS where nothing of it can be read.
absl::StatusOr<CheckedStore> CheckStore(const std::string& folder);

// A line a session, one for each other thing that is damaged, and one for the whole, as people read it.
std::string Describe(const std::string& folder, const CheckedStore& store);

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_CHECK_H_
