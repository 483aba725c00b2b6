// Studies that run one after the other on a thread of their own, whoever watches.
#ifndef PHRENIC_SERVER_STUDY_JOBS_H_
#define PHRENIC_SERVER_STUDY_JOBS_H_

#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Any thread may call.
class Jobs {
 public:
  using Work = std::function<absl::StatusOr<v1::StudyResult>(const Progress&)>;
  struct Seen {
    v1::Study study;
    std::int64_t version = 0;  // grows with every change
    bool ended = false;
  };

  // What becomes of a study, for whoever writes it down; called by a thread of the jobs or a caller of theirs, and may
  // not call them.
  struct Keeper {
    std::function<void(const v1::Study& study)> ended;      // with its result
    std::function<void(const std::string& study_id)> gone;  // deleted, or made room
  };

  // Keeps `kept` studies, waiting, running and ended.
  explicit Jobs(int kept, Keeper keeper = Keeper());
  // Cancels what runs and waits for it; it has not ended then.
  ~Jobs();

  // Queues a study; an empty id is chosen from `kind` and the scene. The oldest that has ended makes room;
  // RESOURCE_EXHAUSTED where none has. INVALID_ARGUMENT or ALREADY_EXISTS for an id that cannot be.
  absl::StatusOr<v1::Study> Add(const std::string& id, const std::string& kind, const std::string& scene, Work work)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // One that ended before.
  void Restore(v1::Study study) ABSL_LOCKS_EXCLUDED(mutex_);
  // The study as soon as its version is above `seen`, or after `longest`. NOT_FOUND lists the ids there are.
  absl::StatusOr<Seen> Wait(const std::string& id, std::int64_t seen, absl::Duration longest) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Oldest first, without results.
  std::vector<v1::Study> List() const ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status Delete(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Job {
    Work work;
    Seen seen;
    std::atomic<bool> cancelled = false;
  };

  void Loop();
  void RunOne(Job& job);
  std::shared_ptr<Job> Find(const std::string& id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::shared_ptr<Job> NextQueued() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::StatusOr<std::string> ChooseId(const std::string& wanted, const std::string& kind,
                                       const std::string& scene) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status MakeRoom() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status NoStudy(const std::string& id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Change(Job& job) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { ++job.seen.version; }

  const size_t kept_;
  const Keeper keeper_;
  mutable absl::Mutex mutex_;
  std::list<std::shared_ptr<Job>> jobs_ ABSL_GUARDED_BY(mutex_);  // oldest first
  bool closed_ ABSL_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_JOBS_H_
