// A bounded queue of jobs, such as exports and studies, with progress, cancel and resume.
#ifndef PHRENIC_SERVER_JOBS_QUEUE_H_
#define PHRENIC_SERVER_JOBS_QUEUE_H_

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
// Thread-safe; its own threads run the jobs, at a lower priority than sessions have (thread_priority.h).
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
  // one of an owner who has more jobs; RESOURCE_EXHAUSTED if no job may go. Also the errors of Noun::ChooseId and
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
  // Returns the owner of a job; nullopt if no job has this id.
  std::optional<std::string> OwnerOf(const std::string& id) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the jobs whose owner is `visible`, oldest first; null: all.
  std::vector<Message> List(const std::function<bool(const std::string& owner)>& visible = nullptr) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Cancels the job if it runs, and removes it here and from the store. NOT_FOUND if no job has this id.
  absl::Status Delete(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);

  // What the store keeps of the jobs.
  const Records& records() const { return records_; }

 private:
  // A job in the queue. The lock guards all fields but `cancelled`, which the thread that runs the job reads without
  // it.
  struct Entry {
    std::string owner;                            // empty: none
    std::shared_ptr<Job> job;                     // null if it had ended before the server restarted
    Seen seen;                                    // its message has the id
    State state = State::kQueued;                 // also in the message
    absl::Time expires = absl::InfiniteFuture();  // once it has ended
    std::atomic<bool> cancelled = false;          // deleted, or the queue is being destroyed
  };
  using Entries = std::list<std::shared_ptr<Entry>>;

  static constexpr absl::Duration kLook = absl::Milliseconds(200);  // between two looks at a watcher

  // Runs jobs until the queue is destroyed: the function of each thread.
  void Loop() ABSL_LOCKS_EXCLUDED(mutex_);
  // Waits for a job to run, and removes expired ones meanwhile. Returns null if the queue is destroyed.
  std::shared_ptr<Entry> Next() ABSL_LOCKS_EXCLUDED(mutex_);
  // Runs one job and ends it.
  void Run(Entry& entry) ABSL_LOCKS_EXCLUDED(mutex_);
  // Applies what a running job reports (Progress).
  bool Note(Entry& entry, double done, absl::FunctionRef<bool(Message&)> fill) ABSL_LOCKS_EXCLUDED(mutex_);
  // Completes a job that has returned `status`, tells its watchers, and saves it.
  void End(Entry& entry, const absl::Status& status) ABSL_LOCKS_EXCLUDED(mutex_);

  // Sets the state here and in the message, as a new version.
  void SetState(Entry& entry, State state) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Removes an ended job if there is no place for another of `owner`. RESOURCE_EXHAUSTED if none may go.
  absl::Status MakeRoom(const std::string& owner) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the oldest ended job of `owner`, or of the owner who has most jobs, more than `owner`; the end if none.
  typename Entries::iterator FindEnded(const std::string& owner, bool of_others) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the number of the owner's jobs, and of those that run.
  int Kept(const std::string& owner) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  int Running(const std::string& owner) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns how many of `in_all` threads or places one owner may have.
  int OfOwner(const std::string& owner, int in_all) const {
    return owner.empty() ? in_all : PartOf(in_all, options_.share);
  }
  // Removes the jobs whose lifetime is over.
  void RemoveExpired() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns when the next lifetime is over; the infinite future if no job has ended.
  absl::Time NextExpiry() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the job with this id; null if no job has it.
  std::shared_ptr<Entry> Find(const std::string& id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the oldest queued job of the owner whose turn it is; null if none may run.
  std::shared_ptr<Entry> NextQueued() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // NOT_FOUND; lists the ids of jobs without an owner, which every caller may see.
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

}  // namespace phrenic::jobs

#include "server/jobs/queue-inl.h"

#endif  // PHRENIC_SERVER_JOBS_QUEUE_H_
