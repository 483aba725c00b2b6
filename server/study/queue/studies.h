// The studies of a server: queued, run one at a time, kept with their results.
#ifndef PHRENIC_SERVER_STUDY_QUEUE_STUDIES_H_
#define PHRENIC_SERVER_STUDY_QUEUE_STUDIES_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "phrenic/v1/study.pb.h"
#include "server/jobs/queue.h"
#include "server/schema/clock.h"
#include "server/study/context.h"

namespace phrenic::study {

// One study as a job of a queue (jobs::Queue).
class StudyJob {
 public:
  using Message = v1::Study;
  using Work = std::function<absl::StatusOr<v1::StudyResult>(const Progress& progress)>;

  // `owner` is the account of the study; empty on a server without accounts. `work` runs the study.
  StudyJob(v1::CreateStudyRequest request, std::string owner, Work work)
      : request_(std::move(request)), owner_(std::move(owner)), work_(std::move(work)) {}

  // The interface of a job: see jobs::Queue.
  absl::Status Run(jobs::Progress<v1::Study> progress);
  void Finish(const absl::Status& status, absl::Time expires, v1::Study& message);
  void Save(const v1::Study& message, const jobs::Records& records) const;

 private:
  const v1::CreateStudyRequest request_;
  const std::string owner_;
  const Work work_;
  v1::StudyResult result_;  // of a study that succeeded
};

// Thread-safe. One background thread runs the studies in order; at most 16 studies are kept.
class Studies {
 public:
  using Seen = jobs::Queue<StudyJob>::Seen;
  // Returns the name of the scene that a request studies, or why it cannot be studied.
  using SceneName = std::function<absl::StatusOr<std::string>(const v1::CreateStudyRequest& request)>;
  // Compiles a scene for the owner of a study, until `cancelled` returns true.
  using OwnersCompiler = std::function<absl::StatusOr<std::shared_ptr<const Model>>(
      const v1::SceneSource& source, const std::string& owner, const std::function<bool()>& cancelled)>;

  // `share` is the fraction of the studies that one owner may have. Requires: `clock` and `store` outlive it. With a
  // null store, studies do not survive a restart of the server.
  Studies(SceneName scene_name, OwnersCompiler compile, const Clock& clock, store::Store* store, double share = 1);

  // Restores the studies of an earlier server: ended ones with their results; the others run again from their start.
  // `account_of` gives the present name of the account that a record names. `lost` gets the reason why one could not be
  // restored, by "study ID". Requires: no other call was made yet.
  void Restore(const std::vector<store::SavedRecord>& records,
               absl::FunctionRef<std::string(const std::string& account)> account_of,
               std::map<std::string, absl::Status>& lost);

  // Queues a study and returns after the store has written it to disk. An empty id is derived from kind and scene.
  // INVALID_ARGUMENT if the request names no kind; the errors of CheckSize, SceneName and
  // jobs::Queue::Add.
  absl::StatusOr<v1::Study> Add(const v1::CreateStudyRequest& request, const std::string& owner);
  // The same as the methods of jobs::Queue; List leaves out the results.
  absl::StatusOr<Seen> Wait(const std::string& id, std::int64_t seen, absl::Duration longest) const {
    return queue_.Wait(id, seen, longest);
  }
  absl::Status Watch(const std::string& id, absl::FunctionRef<bool()> gone,
                     absl::FunctionRef<bool(v1::Study message)> write) const {
    return queue_.Watch(id, gone, write);
  }
  std::vector<v1::Study> List(const std::function<bool(const std::string& owner)>& visible = nullptr) const;
  std::optional<std::string> OwnerOf(const std::string& id) const { return queue_.OwnerOf(id); }
  absl::Status Delete(const std::string& id) { return queue_.Delete(id); }

 private:
  // A job that is ready for the queue.
  struct Draft {
    std::string id_base;  // "error-thorax"; "error" if the scene came with the request, whose name may be a person's
    v1::Study message;
    std::shared_ptr<StudyJob> job;
  };
  absl::StatusOr<Draft> MakeDraft(const v1::CreateStudyRequest& request, const std::string& owner) const;
  absl::Status RestoreOne(const store::SavedRecord& record,
                          absl::FunctionRef<std::string(const std::string& account)> account_of);

  const SceneName scene_name_;
  const OwnersCompiler compile_;
  jobs::Queue<StudyJob> queue_;
};

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_QUEUE_STUDIES_H_
