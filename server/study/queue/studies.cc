#include "server/study/queue/studies.h"

#include "absl/strings/str_cat.h"
#include "phrenic/v1/saved.pb.h"
#include "server/study/queue/request_size.h"
#include "server/study/queue/run.h"

namespace phrenic::study {
namespace {

static_assert(static_cast<int>(jobs::State::kQueued) == v1::STUDY_STATE_QUEUED);
static_assert(static_cast<int>(jobs::State::kRunning) == v1::STUDY_STATE_RUNNING);
static_assert(static_cast<int>(jobs::State::kDone) == v1::STUDY_STATE_DONE);
static_assert(static_cast<int>(jobs::State::kFailed) == v1::STUDY_STATE_FAILED);

constexpr char kRecord[] = "study";  // the kind of its records in a store
constexpr int kMostStudies = 16;
constexpr double kSmallestProgress = 0.001;  // smallest change of progress that is reported

// Null if the request names no kind of study.
const char* KindOf(const v1::CreateStudyRequest& request) {
  switch (request.what_case()) {
    case v1::CreateStudyRequest::kError:
      return "error";
    case v1::CreateStudyRequest::kStability:
      return "stability";
    case v1::CreateStudyRequest::kCost:
      return "cost";
    case v1::CreateStudyRequest::kStreaming:
      return "streaming";
    case v1::CreateStudyRequest::kSensitivity:
      return "sensitivity";
    case v1::CreateStudyRequest::kUncertainty:
      return "uncertainty";
    case v1::CreateStudyRequest::kConvergence:
      return "convergence";
    case v1::CreateStudyRequest::WHAT_NOT_SET:
      break;
  }
  return nullptr;
}

}  // namespace

absl::Status StudyJob::Run(jobs::Progress<v1::Study> progress) {
  auto result = work_([&](double done, std::string_view doing) {
    return progress(done, [&](v1::Study& message) {
      const bool changed = done >= message.progress() + kSmallestProgress || message.doing() != doing;
      message.set_doing(std::string(doing));
      return changed;
    });
  });
  if (!result.ok()) return result.status();
  result_ = *std::move(result);
  return absl::OkStatus();
}

void StudyJob::Finish(const absl::Status& status, absl::Time /*expires*/, v1::Study& message) {
  message.set_doing("");
  if (status.ok()) *message.mutable_result() = std::move(result_);
}

// A study that has not ended is saved with its request, so that it can run again.
void StudyJob::Save(const v1::Study& message, const jobs::Records& records) const {
  v1::SavedStudy saved;
  if (message.state() == v1::STUDY_STATE_QUEUED) {
    *saved.mutable_request() = request_;
    saved.mutable_request()->set_study_id(message.id());
  }
  *saved.mutable_study() = message;
  saved.set_owner(owner_);
  saved.set_owner_qualified(true);
  records.Put(message.id(), saved.SerializeAsString());
}

Studies::Studies(SceneName scene_name, OwnersCompiler compile, const Clock& clock, store::Store* store, double share)
    : scene_name_(std::move(scene_name)),
      compile_(std::move(compile)),
      queue_({.noun = {"study", "studies", "a"}, .threads = 1, .kept = kMostStudies, .share = share}, clock,
             jobs::Records(kRecord, store)) {}

absl::StatusOr<Studies::Draft> Studies::MakeDraft(const v1::CreateStudyRequest& request,
                                                  const std::string& owner) const {
  const char* kind = KindOf(request);
  if (kind == nullptr) return absl::InvalidArgumentError(kNoStudy);
  if (absl::Status small = CheckSize(request); !small.ok()) return small;
  const absl::StatusOr<std::string> scene = scene_name_(request);
  if (!scene.ok()) return scene.status();
  Draft draft;
  draft.id_base = request.source().has_scene() ? kind : absl::StrCat(kind, "-", *scene);
  draft.message.set_scene(*scene);
  draft.message.set_doing("waiting for earlier studies");
  draft.job = std::make_shared<StudyJob>(request, owner, [this, request, owner](const Progress& progress) {
    const auto cancelled = [&progress] { return !progress(0, "compiling the scene"); };
    const Compiler compile = [&](const v1::SceneSource& source) { return compile_(source, owner, cancelled); };
    return study::Run(request, compile, progress);
  });
  return draft;
}

absl::StatusOr<v1::Study> Studies::Add(const v1::CreateStudyRequest& request, const std::string& owner) {
  auto draft = MakeDraft(request, owner);
  if (!draft.ok()) return draft.status();
  return queue_.Add(owner, request.study_id(), draft->id_base, std::move(draft->message), std::move(draft->job));
}

absl::Status Studies::RestoreOne(const store::SavedRecord& record,
                                 absl::FunctionRef<std::string(const std::string& account)> account_of) {
  v1::SavedStudy saved;
  if (!saved.ParseFromString(record.bytes)) return absl::DataLossError("the record in the store is not a study");
  const std::string owner = saved.owner_qualified() ? saved.owner() : account_of(saved.owner());
  if (saved.has_request()) {
    auto draft = MakeDraft(saved.request(), owner);
    absl::Status resumed = draft.status();
    if (draft.ok()) {
      resumed =
          queue_.Resume(owner, record.id, draft->id_base, std::move(draft->message), std::move(draft->job)).status();
    }
    if (resumed.ok()) return resumed;
    saved.mutable_study()->set_state(v1::STUDY_STATE_FAILED);
    saved.mutable_study()->set_problem(std::string(resumed.message()));
  }
  queue_.RestoreEnded(owner, saved.study());
  return absl::OkStatus();
}

void Studies::Restore(const std::vector<store::SavedRecord>& records,
                      absl::FunctionRef<std::string(const std::string& account)> account_of,
                      std::map<std::string, absl::Status>& lost) {
  queue_.records().Restore(
      records, [&](const store::SavedRecord& record) { return RestoreOne(record, account_of); }, lost);
}

std::vector<v1::Study> Studies::List(const std::function<bool(const std::string& owner)>& visible) const {
  std::vector<v1::Study> studies = queue_.List(visible);
  for (v1::Study& study : studies) study.clear_result();
  return studies;
}

}  // namespace phrenic::study
