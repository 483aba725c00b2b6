#include "server/study/jobs.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/schema/id.h"
#include "server/schema/names.h"

namespace phrenic::study {
namespace {

v1::Study WithoutResult(const v1::Study& study) {
  v1::Study copy = study;
  copy.clear_result();
  return copy;
}

}  // namespace

Jobs::Jobs(int kept, Keeper keeper)
    : kept_(static_cast<size_t>(kept)), keeper_(std::move(keeper)), thread_([this] { Loop(); }) {}

Jobs::~Jobs() {
  {
    absl::MutexLock lock(&mutex_);
    closed_ = true;
    for (const auto& job : jobs_) job->cancelled = true;
  }
  thread_.join();
}

absl::StatusOr<v1::Study> Jobs::Add(const std::string& id, const std::string& kind, const std::string& scene,
                                    Work work) {
  auto job = std::make_shared<Job>();
  job->work = std::move(work);
  absl::MutexLock lock(&mutex_);
  if (closed_) return absl::UnavailableError("the server is shutting down");
  const absl::StatusOr<std::string> chosen = ChooseId(id, kind, scene);
  if (!chosen.ok()) return chosen.status();
  if (absl::Status status = MakeRoom(); !status.ok()) return status;
  v1::Study& study = job->seen.study;
  study.set_id(*chosen);
  study.set_scene(scene);
  study.set_state(v1::STUDY_STATE_QUEUED);
  study.set_doing("waiting for the studies before it");
  job->seen.version = 1;
  jobs_.push_back(job);
  return study;
}

void Jobs::Restore(v1::Study study) {
  auto job = std::make_shared<Job>();
  job->seen.study = std::move(study);
  job->seen.version = 1;
  job->seen.ended = true;
  absl::MutexLock lock(&mutex_);
  jobs_.push_back(std::move(job));
}

absl::StatusOr<std::string> Jobs::ChooseId(const std::string& wanted, const std::string& kind,
                                           const std::string& scene) const {
  if (absl::Status status = schema::CheckId("study_id", wanted); !status.ok()) return status;
  if (wanted.empty()) {
    return schema::FreeId(absl::StrCat(kind, "-", scene), "study", [this](const std::string& id) {
      mutex_.AssertHeld();
      return Find(id) != nullptr;
    });
  }
  if (Find(wanted) == nullptr) return wanted;
  return absl::AlreadyExistsError(absl::StrCat("study_id: there is a study \"", wanted, "\" already"));
}

absl::Status Jobs::MakeRoom() {
  if (jobs_.size() < kept_) return absl::OkStatus();
  const auto ended = std::find_if(jobs_.begin(), jobs_.end(), [](const auto& job) { return job->seen.ended; });
  if (ended == jobs_.end()) {
    return absl::ResourceExhaustedError(
        absl::StrCat(kept_, " studies wait or run, and no more are allowed: delete one, or wait for one to end"));
  }
  if (keeper_.gone) keeper_.gone((*ended)->seen.study.id());
  jobs_.erase(ended);
  return absl::OkStatus();
}

std::shared_ptr<Jobs::Job> Jobs::Find(const std::string& id) const {
  for (const auto& job : jobs_) {
    if (job->seen.study.id() == id) return job;
  }
  return nullptr;
}

std::shared_ptr<Jobs::Job> Jobs::NextQueued() const {
  for (const auto& job : jobs_) {
    if (job->seen.study.state() == v1::STUDY_STATE_QUEUED) return job;
  }
  return nullptr;
}

absl::Status Jobs::NoStudy(const std::string& id) const {
  std::vector<std::string> ids;
  for (const auto& job : jobs_) ids.push_back(job->seen.study.id());
  return absl::NotFoundError(
      absl::StrCat("study_id: there is no study \"", schema::ShortId(id), "\"", schema::ThereAre(id, ids)));
}

absl::StatusOr<Jobs::Seen> Jobs::Wait(const std::string& id, std::int64_t seen, absl::Duration longest) const {
  absl::MutexLock lock(&mutex_);
  const std::shared_ptr<Job> job = Find(id);
  if (job == nullptr) return NoStudy(id);
  const auto changed = [&] {
    mutex_.AssertHeld();
    return job->seen.version > seen || job->cancelled;
  };
  mutex_.AwaitWithTimeout(absl::Condition(&changed), longest);
  if (job->cancelled) return absl::CancelledError(absl::StrCat("study_id: the study \"", id, "\" was deleted"));
  return job->seen;
}

std::vector<v1::Study> Jobs::List() const {
  absl::MutexLock lock(&mutex_);
  std::vector<v1::Study> studies;
  for (const auto& job : jobs_) studies.push_back(WithoutResult(job->seen.study));
  return studies;
}

absl::Status Jobs::Delete(const std::string& id) {
  absl::MutexLock lock(&mutex_);
  const std::shared_ptr<Job> job = Find(id);
  if (job == nullptr) return NoStudy(id);
  job->cancelled = true;
  jobs_.remove(job);
  if (keeper_.gone) keeper_.gone(id);
  return absl::OkStatus();
}

void Jobs::Loop() {
  const auto wake = [this] {
    mutex_.AssertHeld();
    return closed_ || NextQueued() != nullptr;
  };
  while (true) {
    std::shared_ptr<Job> job;
    {
      absl::MutexLock lock(&mutex_);
      mutex_.Await(absl::Condition(&wake));
      if (closed_) return;
      job = NextQueued();
      job->seen.study.set_state(v1::STUDY_STATE_RUNNING);
      Change(*job);
    }
    RunOne(*job);
  }
}

void Jobs::RunOne(Job& job) {
  const auto progress = [&](double done, std::string_view doing) {
    absl::MutexLock lock(&mutex_);
    v1::Study& study = job.seen.study;
    const bool news = done >= study.progress() + 0.001 || study.doing() != doing;
    study.set_progress(std::clamp(done, study.progress(), 1.0));
    study.set_doing(std::string(doing));
    if (news) Change(job);
    return !job.cancelled;
  };
  absl::StatusOr<v1::StudyResult> result = job.work(progress);
  absl::MutexLock lock(&mutex_);
  v1::Study& study = job.seen.study;
  study.set_state(result.ok() ? v1::STUDY_STATE_DONE : v1::STUDY_STATE_FAILED);
  study.set_doing("");
  if (result.ok()) {
    study.set_progress(1);
    *study.mutable_result() = *std::move(result);
  } else {
    study.set_problem(std::string(result.status().message()));
  }
  job.seen.ended = true;
  Change(job);
  if (keeper_.ended && !job.cancelled) keeper_.ended(study);
}

}  // namespace phrenic::study
