#include "server/jobs/records.h"

#include "absl/strings/str_cat.h"

namespace phrenic::jobs {

void Records::Put(const std::string& id, std::string bytes) const {
  if (store_ != nullptr) store_->Put(kind_, id, std::move(bytes));
}

void Records::Remove(const std::string& id) const {
  if (store_ != nullptr) store_->Remove(kind_, id);
}

absl::Status Records::Flush() const { return store_ == nullptr ? absl::OkStatus() : store_->FlushRecords(); }

void Records::Restore(const std::vector<store::SavedRecord>& records,
                      absl::FunctionRef<absl::Status(const store::SavedRecord& record)> restore,
                      std::map<std::string, absl::Status>& lost) const {
  for (const store::SavedRecord& record : records) {
    if (record.kind != kind_) continue;
    const absl::Status restored = record.problem.ok() ? restore(record) : record.problem;
    if (!restored.ok()) lost[absl::StrCat(kind_, " ", record.id)] = restored;
  }
}

}  // namespace phrenic::jobs
