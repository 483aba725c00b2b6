// The copies of a server's sessions in Redis.
#include <utility>

#include "server/cluster/cluster.h"
#include "server/cluster/scripts.h"
#include "server/store/saved_state.h"

namespace phrenic::cluster {
namespace {

constexpr int kRemembered = 30 * 24 * 3600;  // [s]

}  // namespace

void Cluster::SetBehind(const std::string& id, bool behind) {
  absl::MutexLock lock(&mutex_);
  const auto own = own_.find(id);
  if (own != own_.end()) own->second.behind = behind;
}

absl::StatusOr<std::int64_t> Cluster::Save(const std::string& id, std::vector<std::string> words) {
  const auto epoch = EpochOf(id);
  if (!epoch.has_value()) return 0;
  words.insert(words.begin(), {id, std::to_string(*epoch)});
  const auto saved = saving_.Run(kSave, words);
  if (!saved.ok()) {
    SetBehind(id, true);
    return saved.status();
  }
  return saved->number;
}

bool Cluster::Copy(const store::Written& written) {
  const auto epoch = EpochOf(written.id);
  if (written.forgotten) {
    if (epoch.has_value()) {
      saving_.Run(kForget, {written.id, std::to_string(*epoch), std::to_string(kRemembered)}).IgnoreError();
      absl::MutexLock lock(&mutex_);
      own_.erase(written.id);
    }
    return true;
  }
  if (!epoch.has_value()) return false;
  {
    absl::MutexLock lock(&mutex_);
    const auto own = own_.find(written.id);
    if (own != own_.end() && own->second.behind) return true;  // the whole is to come
  }
  std::vector<std::string> words = {written.scene.has_value() ? written.scene->SerializeAsString() : "", "", "", ""};
  if (written.state != nullptr) {
    words[1] = std::to_string(written.sequence);
    words[2] = written.moment.SerializeAsString();
    words[3] = store::Save(*written.state).SerializeAsString();
  }
  for (const auto& [sequence, moment] : written.moments) {
    words.push_back(std::to_string(sequence));
    words.push_back(moment.SerializeAsString());
  }
  return Save(written.id, std::move(words)).value_or(1) == 1;
}

void Cluster::CopyWhole(const store::SavedSession& saved) {
  const auto first = saved.sequence - static_cast<std::int64_t>(saved.later.size());
  std::vector<std::string> words = {saved.scene.SerializeAsString(), std::to_string(first),
                                    saved.moment.SerializeAsString(), saved.state.SerializeAsString()};
  for (std::size_t i = 0; i < saved.later.size(); ++i) {
    words.push_back(std::to_string(first + 1 + static_cast<std::int64_t>(i)));
    words.push_back(saved.later[i].SerializeAsString());
  }
  if (Save(saved.id, std::move(words)).ok()) SetBehind(saved.id, false);
}

}  // namespace phrenic::cluster
