// Cluster's methods that write the copies of this server's sessions to Redis.
#include <utility>

#include "server/cluster/cluster.h"
#include "server/cluster/scripts.h"
#include "server/store/saved_state.h"

namespace phrenic::cluster {
namespace {

constexpr int kTombstoneSeconds = 30 * 24 * 3600;  // that the id of a deleted session is remembered

}  // namespace

void Cluster::SetCopyIncomplete(const std::string& id, bool incomplete) {
  absl::MutexLock lock(&mutex_);
  const auto own = owned_.find(id);
  if (own != owned_.end()) own->second.copy_incomplete = incomplete;
}

absl::StatusOr<std::int64_t> Cluster::WriteCopy(const std::string& id, std::vector<std::string> arguments) {
  const auto epoch = EpochOf(id);
  if (!epoch.has_value()) return 0;
  arguments.insert(arguments.begin(), {id, std::to_string(*epoch)});
  const auto saved = copies_.Run(kSave, arguments);
  if (!saved.ok()) {
    SetCopyIncomplete(id, true);
    return saved.status();
  }
  return saved->number;
}

bool Cluster::Copy(const store::Written& written) {
  const auto epoch = EpochOf(written.id);
  if (written.forgotten) {
    if (epoch.has_value()) {
      copies_.Run(kDelete, {written.id, std::to_string(*epoch), std::to_string(kTombstoneSeconds)}).IgnoreError();
      absl::MutexLock lock(&mutex_);
      owned_.erase(written.id);
    }
    return true;
  }
  if (!epoch.has_value()) return false;
  {
    absl::MutexLock lock(&mutex_);
    const auto own = owned_.find(written.id);
    if (own != owned_.end() && own->second.copy_incomplete) return true;  // CopyWhole will follow
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
  return WriteCopy(written.id, std::move(arguments)).value_or(1) == 1;
}

void Cluster::CopyWhole(const store::SavedSession& saved) {
  const auto first = saved.sequence - static_cast<std::int64_t>(saved.later.size());
  std::vector<std::string> arguments = {saved.scene.SerializeAsString(), std::to_string(first),
                                        saved.moment.SerializeAsString(), saved.state.SerializeAsString()};
  for (std::size_t i = 0; i < saved.later.size(); ++i) {
    arguments.push_back(std::to_string(first + 1 + static_cast<std::int64_t>(i)));
    arguments.push_back(saved.later[i].SerializeAsString());
  }
  if (WriteCopy(saved.id, std::move(arguments)).ok()) SetCopyIncomplete(saved.id, false);
}

}  // namespace phrenic::cluster
