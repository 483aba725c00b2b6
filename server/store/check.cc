#include "server/store/check.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/store/marker.h"

namespace phrenic::store {

bool CheckedStore::whole() const {
  const auto good = [](const auto& one) { return one.problem.ok(); };
  return problem.ok() && std::ranges::all_of(sessions, good) && std::ranges::all_of(records, good);
}

absl::StatusOr<CheckedStore> CheckStore(const std::string& folder) {
  const std::string file = StoreFile(folder);
  if (absl::Status status = CheckDatabaseExists(folder); !status.ok()) return status;
  if (!std::filesystem::exists(file)) return absl::NotFoundError(absl::StrCat("there is no ", file));
  auto database = Database::Open(file, Access::kRead);
  if (!database.ok()) return database.status();
  CheckedStore checked;
  checked.problem = Examine(folder, *database);
  if (absl::IsFailedPrecondition(checked.problem)) return checked.problem;
  if (checked.problem.ok()) checked.problem = CheckMarker(folder, *database);
  auto sessions = ReadSessions(*database);
  if (!sessions.ok()) return checked.problem.ok() ? sessions.status() : checked.problem;
  checked.sessions = *std::move(sessions);
  auto records = ReadRecords(*database);
  if (!records.ok()) return checked.problem.ok() ? records.status() : checked.problem;
  checked.records = *std::move(records);
  return checked;
}

std::string Describe(const std::string& folder, const CheckedStore& store) {
  std::string text =
      absl::StrFormat("%-24s %-20s %12s %10s %8s %10s\n", "session", "scene", "tick", "time [s]", "changes", "kB");
  for (const SavedSession& session : store.sessions) {
    if (!session.problem.ok()) {
      absl::StrAppend(&text, session.id, ": ", session.problem.message(), "\n");
      continue;
    }
    const v1::Session& last = session.later.empty() ? session.moment.session() : session.later.back().session();
    absl::StrAppendFormat(&text, "%-24s %-20s %12d %10.3f %8d %10.1f\n", session.id, last.scene(), last.tick(),
                          last.time(), session.later.size(), 1e-3 * static_cast<double>(session.bytes));
  }
  std::map<std::string, int> others;
  for (const SavedRecord& record : store.records) {
    ++others[record.kind];
    if (!record.problem.ok()) absl::StrAppend(&text, record.problem.message(), "\n");
  }
  if (!store.problem.ok()) absl::StrAppend(&text, store.problem.message(), "\n");
  absl::StrAppend(&text, StoreFile(folder), ": ", store.sessions.size(), " sessions, ");
  for (const auto& [kind, count] : others) absl::StrAppend(&text, kind, " records: ", count, ", ");
  absl::StrAppend(&text, store.whole() ? "whole" : "damaged", "\n");
  return text;
}

}  // namespace phrenic::store
