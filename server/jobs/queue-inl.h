// The functions of jobs::Queue. Included by queue.h alone.
#ifndef PHRENIC_SERVER_JOBS_QUEUE_INL_H_
#define PHRENIC_SERVER_JOBS_QUEUE_INL_H_

#include <algorithm>

#include "server/jobs/queue.h"
#include "server/jobs/thread_priority.h"

namespace phrenic::jobs {

template <typename Job>
Queue<Job>::Queue(QueueOptions options, const Clock& clock, Records records)
    : options_(std::move(options)), clock_(clock), records_(std::move(records)) {
  for (int i = 0; i < options_.threads; ++i) threads_.emplace_back([this] { Loop(); });
}

template <typename Job>
Queue<Job>::~Queue() {
  {
    absl::MutexLock lock(&mutex_);
    closed_ = true;
    for (const auto& entry : entries_) entry->cancelled = true;
  }
  for (std::thread& thread : threads_) thread.join();
}

template <typename Job>
auto Queue<Job>::Add(const std::string& owner, const std::string& id, const std::string& base, Message message,
                     std::shared_ptr<Job> job) -> absl::StatusOr<Message> {
  auto added = Resume(owner, id, base, std::move(message), std::move(job));
  if (!added.ok()) return added;
  if (absl::Status saved = records_.Flush(); !saved.ok()) {
    Delete(added->id()).IgnoreError();
    return saved;
  }
  return added;
}

template <typename Job>
auto Queue<Job>::Resume(const std::string& owner, const std::string& id, const std::string& base, Message message,
                        std::shared_ptr<Job> job) -> absl::StatusOr<Message> {
  absl::MutexLock lock(&mutex_);
  if (closed_) return absl::UnavailableError("the server is shutting down");
  const auto taken = [this](const std::string& other) {
    mutex_.AssertHeld();
    return Find(other) != nullptr;
  };
  absl::StatusOr<std::string> chosen = options_.noun.ChooseId(id, base, taken);
  if (!chosen.ok()) return chosen.status();
  if (absl::Status status = MakeRoom(owner); !status.ok()) return status;
  auto entry = std::make_shared<Entry>();
  entry->owner = owner;
  entry->job = std::move(job);
  entry->seen.message = std::move(message);
  entry->seen.message.set_id(*std::move(chosen));
  SetState(*entry, State::kQueued);
  entries_.push_back(entry);
  entry->job->Save(entry->seen.message, records_);
  return entry->seen.message;
}

template <typename Job>
void Queue<Job>::RestoreEnded(const std::string& owner, Message message) {
  auto entry = std::make_shared<Entry>();
  entry->owner = owner;
  entry->state = State{static_cast<int>(message.state())};
  entry->seen = {std::move(message), 1, true};
  absl::MutexLock lock(&mutex_);
  entries_.push_back(std::move(entry));
}

template <typename Job>
auto Queue<Job>::Wait(const std::string& id, std::int64_t seen, absl::Duration longest) const -> absl::StatusOr<Seen> {
  absl::MutexLock lock(&mutex_);
  const std::shared_ptr<Entry> entry = Find(id);
  if (entry == nullptr) return NotFound(id);
  const auto changed = [&] {
    mutex_.AssertHeld();
    return entry->seen.version > seen || entry->cancelled;
  };
  mutex_.AwaitWithTimeout(absl::Condition(&changed), longest);
  if (entry->cancelled) return options_.noun.Deleted(id);
  return entry->seen;
}

template <typename Job>
absl::Status Queue<Job>::Watch(const std::string& id, absl::FunctionRef<bool()> gone,
                               absl::FunctionRef<bool(Message message)> write) const {
  std::int64_t version = 0;
  while (!gone()) {
    absl::StatusOr<Seen> seen = Wait(id, version, kLook);
    if (!seen.ok()) return seen.status();
    if (seen->version == version) continue;
    version = seen->version;
    if (!write(std::move(seen->message))) break;
    if (seen->ended) return absl::OkStatus();
  }
  return absl::UnavailableError("the server is shutting down");  // or the watcher is gone, and does not get this
}

template <typename Job>
absl::Status Queue<Job>::Read(const std::string& id,
                              absl::FunctionRef<absl::Status(const Job* job, const Message& message)> read) const {
  absl::MutexLock lock(&mutex_);
  const std::shared_ptr<Entry> entry = Find(id);
  return entry == nullptr ? NotFound(id) : read(entry->job.get(), entry->seen.message);
}

template <typename Job>
std::optional<std::string> Queue<Job>::OwnerOf(const std::string& id) const {
  absl::MutexLock lock(&mutex_);
  const std::shared_ptr<Entry> entry = Find(id);
  return entry == nullptr ? std::nullopt : std::optional(entry->owner);
}

template <typename Job>
auto Queue<Job>::List(const std::function<bool(const std::string& owner)>& visible) const -> std::vector<Message> {
  absl::MutexLock lock(&mutex_);
  std::vector<Message> messages;
  for (const auto& entry : entries_) {
    if (visible == nullptr || visible(entry->owner)) messages.push_back(entry->seen.message);
  }
  return messages;
}

template <typename Job>
absl::Status Queue<Job>::Delete(const std::string& id) {
  absl::MutexLock lock(&mutex_);
  const std::shared_ptr<Entry> entry = Find(id);
  if (entry == nullptr) return NotFound(id);
  entry->cancelled = true;
  records_.Remove(id);
  entries_.remove(entry);
  return absl::OkStatus();
}

template <typename Job>
void Queue<Job>::Loop() {
  LowerThreadPriority();
  while (const std::shared_ptr<Entry> entry = Next()) Run(*entry);
}

template <typename Job>
auto Queue<Job>::Next() -> std::shared_ptr<Entry> {
  const auto wake = [this] {
    mutex_.AssertHeld();
    return closed_ || NextQueued() != nullptr || NextExpiry() <= clock_.Now();
  };
  absl::MutexLock lock(&mutex_);
  while (true) {
    clock_.Await(mutex_, absl::Condition(&wake), NextExpiry());
    if (closed_) return nullptr;
    RemoveExpired();
    if (std::shared_ptr<Entry> entry = NextQueued(); entry != nullptr) {
      std::erase_if(turns_, [this](const auto& each) {
        mutex_.AssertHeld();
        return Kept(each.first) == 0;
      });
      turns_[entry->owner] = ++started_;
      SetState(*entry, State::kRunning);
      return entry;
    }
  }
}

template <typename Job>
void Queue<Job>::Run(Entry& entry) {
  const auto progress = [&](double done, absl::FunctionRef<bool(Message&)> fill) { return Note(entry, done, fill); };
  End(entry, entry.job->Run(progress));
}

template <typename Job>
bool Queue<Job>::Note(Entry& entry, double done, absl::FunctionRef<bool(Message&)> fill) {
  if (entry.cancelled) return false;
  absl::MutexLock lock(&mutex_);
  Message& message = entry.seen.message;
  const bool changed = fill(message);
  message.set_progress(std::clamp(done, message.progress(), 1.0));
  if (changed) ++entry.seen.version;
  return !entry.cancelled;
}

template <typename Job>
void Queue<Job>::End(Entry& entry, const absl::Status& status) {
  absl::MutexLock lock(&mutex_);
  Message& message = entry.seen.message;
  if (status.ok()) {
    message.set_progress(1);
  } else {
    message.set_problem(std::string(status.message()));
  }
  entry.expires = clock_.Now() + options_.lifetime;
  entry.job->Finish(status, entry.expires, message);
  entry.seen.ended = true;
  SetState(entry, status.ok() ? State::kDone : State::kFailed);
  if (!entry.cancelled) entry.job->Save(message, records_);
}

template <typename Job>
void Queue<Job>::SetState(Entry& entry, State state) {
  entry.state = state;
  entry.seen.message.set_state(static_cast<decltype(entry.seen.message.state())>(state));
  ++entry.seen.version;
}

template <typename Job>
int Queue<Job>::Kept(const std::string& owner) const {
  return static_cast<int>(
      std::count_if(entries_.begin(), entries_.end(), [&owner](const auto& entry) { return entry->owner == owner; }));
}

template <typename Job>
int Queue<Job>::Running(const std::string& owner) const {
  return static_cast<int>(std::count_if(entries_.begin(), entries_.end(), [&owner](const auto& entry) {
    return entry->owner == owner && entry->state == State::kRunning;
  }));
}

template <typename Job>
auto Queue<Job>::FindEnded(const std::string& owner, bool of_others) -> typename Entries::iterator {
  auto best = entries_.end();
  int most = of_others ? Kept(owner) : 0;
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    if (!(*entry)->seen.ended || ((*entry)->owner == owner) == of_others) continue;
    const int kept = Kept((*entry)->owner);
    if (kept > most) best = entry, most = kept;
  }
  return best;
}

template <typename Job>
absl::Status Queue<Job>::MakeRoom(const std::string& owner) {
  const int own = OfOwner(owner, options_.kept);
  const bool own_full = Kept(owner) >= own;
  if (!own_full && entries_.size() < static_cast<std::size_t>(options_.kept)) return absl::OkStatus();
  auto ended = FindEnded(owner, false);
  if (ended == entries_.end() && !own_full) ended = FindEnded(owner, true);
  if (ended == entries_.end())
    return own_full ? options_.noun.NoRoomForOwner(own) : options_.noun.NoRoom(options_.kept);
  records_.Remove((*ended)->seen.message.id());
  entries_.erase(ended);
  return absl::OkStatus();
}

template <typename Job>
void Queue<Job>::RemoveExpired() {
  entries_.remove_if([this, now = clock_.Now()](const auto& entry) {
    if (entry->expires > now) return false;
    records_.Remove(entry->seen.message.id());
    return true;
  });
}

template <typename Job>
absl::Time Queue<Job>::NextExpiry() const {
  absl::Time next = absl::InfiniteFuture();
  for (const auto& entry : entries_) next = std::min(next, entry->expires);
  return next;
}

template <typename Job>
auto Queue<Job>::Find(const std::string& id) const -> std::shared_ptr<Entry> {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&id](const auto& entry) { return entry->seen.message.id() == id; });
  return found == entries_.end() ? nullptr : *found;
}

template <typename Job>
auto Queue<Job>::NextQueued() const -> std::shared_ptr<Entry> {
  std::shared_ptr<Entry> next;
  std::int64_t turn = 0;
  for (const auto& entry : entries_) {
    if (entry->state != State::kQueued) continue;
    if (Running(entry->owner) >= OfOwner(entry->owner, options_.threads)) continue;
    const auto last = turns_.find(entry->owner);
    const std::int64_t own = last == turns_.end() ? 0 : last->second;
    if (next == nullptr || own < turn) next = entry, turn = own;
  }
  return next;
}

template <typename Job>
absl::Status Queue<Job>::NotFound(const std::string& id) const {
  std::vector<std::string> ids;  // those that every caller may see
  for (const auto& entry : entries_) {
    if (entry->owner.empty()) ids.push_back(entry->seen.message.id());
  }
  return options_.noun.NotFound(id, ids);
}

}  // namespace phrenic::jobs

#endif  // PHRENIC_SERVER_JOBS_QUEUE_INL_H_
