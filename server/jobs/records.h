// What a store keeps of jobs, so that they resume after the server restarts.
#ifndef PHRENIC_SERVER_JOBS_RECORDS_H_
#define PHRENIC_SERVER_JOBS_RECORDS_H_

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "server/store/store.h"

namespace phrenic::jobs {

// The records of one kind, such as "export" or "study", each under the id of its job. Without a store, nothing is kept
// and every call succeeds. Thread-safe.
class Records {
 public:
  // `store` outlives the records; null: there is none.
  Records(std::string kind, store::Store* store) : kind_(std::move(kind)), store_(store) {}

  // True if there is a store: jobs resume after a restart.
  bool kept() const { return store_ != nullptr; }
  // Writes or replaces a record, on the disk within milliseconds. Does not wait; errors are those of Flush.
  void Put(const std::string& id, std::string bytes) const;
  // Removes a record, if there is one, in the same way.
  void Remove(const std::string& id) const;
  // Waits until all earlier calls are on the disk. Returns the errors of Store::FlushRecords.
  absl::Status Flush() const;

  // Calls `restore` with each record of this kind among `records`, which Store::LoadRecords returned, in the order in
  // which they were added. A record that is damaged or that `restore` refuses is in `lost`, by "KIND ID", with the
  // reason, and stays in the store.
  void Restore(const std::vector<store::SavedRecord>& records,
               absl::FunctionRef<absl::Status(const store::SavedRecord& record)> restore,
               std::map<std::string, absl::Status>& lost) const;

 private:
  const std::string kind_;
  store::Store* const store_;
};

}  // namespace phrenic::jobs

#endif  // PHRENIC_SERVER_JOBS_RECORDS_H_
