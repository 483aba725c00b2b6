// A bounded queue of jobs, such as exports and studies, with progress, cancel and resume.
#ifndef PHRENIC_SERVER_JOBS_QUEUE_H_
#define PHRENIC_SERVER_JOBS_QUEUE_H_

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/jobs/noun.h"
#include "server/jobs/records.h"
#include "server/schema/clock.h"
#include "server/schema/part_of.h"

namespace phrenic::jobs {

// The states of ExportState and StudyState, which have the same numbers.
enum class State { kQueued = 1, kRunning = 2, kDone = 3, kFailed = 4 };

// Reports the progress of a running job: `done` of its work is done, 0 to 1, and `fill` sets other fields of the
// message that watchers see, and returns true if they are to be told. `fill` runs under the queue's lock; `progress` of
// the message is still the previous one. Returns false if the job is cancelled and must end soon.
template <typename Message>
using Progress = absl::FunctionRef<bool(double done, absl::FunctionRef<bool(Message& message)> fill)>;

struct QueueOptions {
  Noun noun;
  int threads = 1;                                     // jobs that run at the same time
  int kept = 16;                                       // jobs that wait, run or have ended
  double share = 1;                                    // fraction of both that one owner may have
  absl::Duration lifetime = absl::InfiniteDuration();  // of a job that has ended
};

// Runs the jobs of each owner in the order in which they were added, and of several owners in turn. Keeps each job
// until it is deleted, its lifetime is over, or its place is needed. Jobs without an owner have no limit of their own.
// Thread-safe; its own threads run the jobs.
//
// A Job has a type `Message`, a proto message with the fields id, state, progress and problem, and three methods:
//   absl::Status Run(Progress<Message> progress)
//     Does the work, on a thread of the queue and without its lock.
//   void Finish(const absl::Status& status, absl::Time expires, Message& message)
//     Completes the message when Run has returned `status`, and frees what the job needs no more. Under the lock.
//   void Save(const Message& message, const Records& records)
//     Writes what a restarted server needs to resume the job, when it is added and when it has ended but was not
//     deleted. Under the lock.
template <typename Job>
class Queue {
 public:
  using Message = typename Job::Message;
  // A job as its watchers see it.
  struct Seen {
    Message message;
    std::int64_t version = 0;  // grows with every change
    bool ended = false;
  };

  // `clock` outlives the queue.
  Queue(QueueOptions options, const Clock& clock, Records records);
  // Cancels running jobs and waits for them. Unfinished jobs stay in the store.
  ~Queue();
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  // Queues a job and returns once its record is on the disk. `message` holds the fields that watchers see first; the
  // queue sets its id and state. An empty `id` is chosen from `base`. The owner's oldest ended job makes room, or else
  // one of an owner who has more jobs; RESOURCE_EXHAUSTED if there is none. Also the errors of Noun::ChooseId and
  // Records::Flush.
  absl::StatusOr<Message> Add(const std::string& owner, const std::string& id, const std::string& base, Message message,
                              std::shared_ptr<Job> job) ABSL_LOCKS_EXCLUDED(mutex_);
  // Queues a job that the store has; the same without waiting for the disk.
  absl::StatusOr<Message> Resume(const std::string& owner, const std::string& id, const std::string& base,
                                 Message message, std::shared_ptr<Job> job) ABSL_LOCKS_EXCLUDED(mutex_);
  // Keeps a job that had ended before the server restarted.
  void RestoreEnded(const std::string& owner, Message message) ABSL_LOCKS_EXCLUDED(mutex_);

  // Returns the job as soon as its version is above `seen`, or after `longest`. NOT_FOUND lists the ids without an
  // owner; CANCELLED if it is deleted meanwhile.
  absl::StatusOr<Seen> Wait(const std::string& id, std::int64_t seen, absl::Duration longest) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Calls `write` with the job, and again after each change, until it has ended: then returns OK. Returns UNAVAILABLE
  // if `write` returns false or `gone` returns true (the watcher, or the server, is going away), which it looks at five
  // times a second; also the errors of Wait.
  absl::Status Watch(const std::string& id, absl::FunctionRef<bool()> gone,
                     absl::FunctionRef<bool(Message message)> write) const;
  // Calls `read` with the job under the lock; `job` is null if it had ended before the server restarted. The errors of
  // Wait, or of `read`.
  absl::Status Read(const std::string& id,
                    absl::FunctionRef<absl::Status(const Job* job, const Message& message)> read) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the owner of a job; nullopt if there is none of this id.
  std::optional<std::string> OwnerOf(const std::string& id) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the jobs whose owner is `visible`, oldest first; null: all.
  std::vector<Message> List(const std::function<bool(const std::string& owner)>& visible = nullptr) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Cancels the job if it runs, and removes it here and from the store. NOT_FOUND if there is none.
  absl::Status Delete(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);

  const Records& records() const { return records_; }

 private:
  struct Entry {
    std::string owner;
    std::shared_ptr<Job> job;
    Seen seen;
    State state = State::kQueued;
    absl::Time expires = absl::InfiniteFuture();
    std::atomic<bool> cancelled = false;
  };
  using Entries = std::list<std::shared_ptr<Entry>>;

  static constexpr absl::Duration kLook = absl::Milliseconds(200);  // between two looks at a watcher

  void Loop() ABSL_LOCKS_EXCLUDED(mutex_);
  // Waits for a job to run, and removes expired ones meanwhile. Returns null if the queue is destroyed.
  std::shared_ptr<Entry> Next() ABSL_LOCKS_EXCLUDED(mutex_);
  void Run(Entry& entry) ABSL_LOCKS_EXCLUDED(mutex_);
  bool Note(Entry& entry, double done, absl::FunctionRef<bool(Message&)> fill) ABSL_LOCKS_EXCLUDED(mutex_);
  void End(Entry& entry, const absl::Status& status) ABSL_LOCKS_EXCLUDED(mutex_);

  void SetState(Entry& entry, State state) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status MakeRoom(const std::string& owner) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the oldest ended job of `owner`, or of the owner who has most jobs, more than `owner`; the end if none.
  typename Entries::iterator FindEnded(const std::string& owner, bool of_others) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the number of the owner's jobs, and of those that run.
  int Kept(const std::string& owner) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  int Running(const std::string& owner) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  int OfOwner(const std::string& owner, int in_all) const {
    return owner.empty() ? in_all : PartOf(in_all, options_.share);
  }
  void RemoveExpired() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Time NextExpiry() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::shared_ptr<Entry> Find(const std::string& id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the oldest queued job of the owner whose turn it is; null if none may run.
  std::shared_ptr<Entry> NextQueued() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status NotFound(const std::string& id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const QueueOptions options_;
  const Clock& clock_;
  const Records records_;
  mutable absl::Mutex mutex_;
  Entries entries_ ABSL_GUARDED_BY(mutex_);                            // oldest first
  std::int64_t started_ ABSL_GUARDED_BY(mutex_) = 0;                   // jobs so far
  std::map<std::string, std::int64_t> turns_ ABSL_GUARDED_BY(mutex_);  // the number of each owner's last started job
  bool closed_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

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

#endif  // PHRENIC_SERVER_JOBS_QUEUE_H_
