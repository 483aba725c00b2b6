// Cluster's methods that write the copies of this server's sessions to Redis.
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/cluster/cluster.h"
#include "server/cluster/scripts.h"
#include "server/store/saved_state.h"

namespace phrenic::cluster {
namespace {

constexpr int kTombstoneSeconds = 30 * 24 * 3600;  // that the id of a deleted session is remembered

// Returns the result of kSave.
store::Copied ResultOf(const absl::StatusOr<std::int64_t>& saved) {
  if (!saved.ok()) return store::Copied::kLater;
  return *saved == 1 ? store::Copied::kYes : store::Copied::kLost;
}

}  // namespace

void Cluster::SetCopyIncomplete(const std::string& id, bool incomplete) {
  absl::MutexLock lock(&mutex_);
  const auto own = owned_.find(id);
  if (own != owned_.end()) own->second.copy_incomplete = incomplete;
}

absl::StatusOr<std::int64_t> Cluster::WriteCopy(const std::string& id, std::vector<std::string> arguments) {
  const auto epoch = EpochOf(id);
  if (!epoch.has_value()) return 0;
  arguments.insert(arguments.begin(), {id, std::to_string(*epoch), std::to_string(++writes_)});
  const auto saved = copies_.Run(kSave, arguments);
  if (!saved.ok()) {
    SetCopyIncomplete(id, true);
    return saved.status();
  }
  return saved->number;
}

store::Copied Cluster::CopyDeletion(const std::string& id) {
  const auto epoch = EpochOf(id);
  if (!epoch.has_value()) return store::Copied::kYes;
  if (!copies_.Run(kDelete, {id, std::to_string(*epoch), std::to_string(kTombstoneSeconds)}).ok()) {
    SetCopyIncomplete(id, true);
    return store::Copied::kLater;
  }
  absl::MutexLock lock(&mutex_);
  owned_.erase(id);
  return store::Copied::kYes;
}

store::Copied Cluster::Copy(const store::Written& written) {
  if (written.forgotten) return CopyDeletion(written.id);
  {
    absl::MutexLock lock(&mutex_);
    const auto own = owned_.find(written.id);
    if (own == owned_.end()) return store::Copied::kLost;
    if (own->second.copy_incomplete) return store::Copied::kLater;
  }
  std::vector<std::string> arguments = {written.scene.has_value() ? written.scene->SerializeAsString() : "", "", "",
                                        ""};
  if (written.state != nullptr) {
    arguments[1] = std::to_string(written.sequence);
    arguments[2] = written.moment.SerializeAsString();
    arguments[3] = store::Save(*written.state).SerializeAsString();
  }
  for (const auto& [sequence, moment] : written.moments) {
    arguments.push_back(std::to_string(sequence));
    arguments.push_back(moment.SerializeAsString());
  }
  return ResultOf(WriteCopy(written.id, std::move(arguments)));
}

store::Copied Cluster::CopyWhole(const store::SavedSession& saved) {
  const auto first = saved.sequence - static_cast<std::int64_t>(saved.later.size());
  std::vector<std::string> arguments = {saved.scene.SerializeAsString(), std::to_string(first),
                                        saved.moment.SerializeAsString(), saved.state.SerializeAsString()};
  for (std::size_t i = 0; i < saved.later.size(); ++i) {
    arguments.push_back(std::to_string(first + 1 + static_cast<std::int64_t>(i)));
    arguments.push_back(saved.later[i].SerializeAsString());
  }
  const store::Copied copied = ResultOf(WriteCopy(saved.id, std::move(arguments)));
  if (copied != store::Copied::kLater) SetCopyIncomplete(saved.id, false);
  return copied;
}

absl::Status Cluster::Delete(const std::string& id) {
  if (absl::Status lease = CheckLease(id); !lease.ok()) return lease;
  const std::int64_t epoch = EpochOf(id).value_or(0);
  const auto deleted = Run(kDelete, {id, std::to_string(epoch), std::to_string(kTombstoneSeconds)});
  if (!deleted.ok()) {
    return absl::UnavailableError(absl::StrCat("session \"", id,
                                               "\" may not be deleted for the cluster's other servers (",
                                               std::string(deleted.status().message()), "); try again"));
  }
  if (deleted->number == 0) {
    return absl::AbortedError(absl::StrCat("session \"", id, "\" continues on another server; call again"));
  }
  absl::MutexLock lock(&mutex_);
  owned_.erase(id);
  return absl::OkStatus();
}

}  // namespace phrenic::cluster
