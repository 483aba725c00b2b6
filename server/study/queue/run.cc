#include "server/study/queue/run.h"

#include <chrono>
#include <utility>

#include "server/schema/schema.h"
#include "server/study/cost.h"
#include "server/study/error.h"
#include "server/study/stability.h"
#include "server/study/streaming.h"
#include "server/study/subject.h"
#include "server/study/uncertainty/convergence.h"
#include "server/study/uncertainty/sensitivity.h"
#include "server/study/uncertainty/uncertainty.h"

namespace phrenic::study {
namespace {

// Leaves out parameters and scene: their defaults are set by the compile step.
void FillStudy(v1::CreateStudyRequest& request) {
  if (request.has_error()) schema::FillDefaults(request.mutable_error());
  if (request.has_stability()) schema::FillDefaults(request.mutable_stability());
  if (request.has_cost()) schema::FillDefaults(request.mutable_cost());
  if (request.has_streaming()) schema::FillDefaults(request.mutable_streaming());
  if (request.has_sensitivity()) schema::FillDefaults(request.mutable_sensitivity());
  if (request.has_uncertainty()) schema::FillDefaults(request.mutable_uncertainty());
  if (request.has_convergence()) schema::FillDefaults(request.mutable_convergence());
}

template <typename Table>
absl::Status Put(absl::StatusOr<Table> table, Table& result) {
  if (!table.ok()) return table.status();
  result = *std::move(table);
  return absl::OkStatus();
}

absl::Status Fill(const v1::CreateStudyRequest& request, const Subject& subject, const Compiler& compile,
                  const Progress& progress, v1::StudyResult& result) {
  switch (request.what_case()) {
    case v1::CreateStudyRequest::kError:
      return Put(StudyError(request, subject, compile, progress), *result.mutable_error());
    case v1::CreateStudyRequest::kCost:
      return Put(StudyCost(request, subject, compile, progress), *result.mutable_cost());
    case v1::CreateStudyRequest::kStability:
      return Put(StudyStability(request, subject, progress), *result.mutable_stability());
    case v1::CreateStudyRequest::kStreaming:
      return Put(StudyStreaming(request, subject, progress), *result.mutable_streaming());
    case v1::CreateStudyRequest::kSensitivity:
      return Put(StudySensitivity(request, subject, progress), *result.mutable_sensitivity());
    case v1::CreateStudyRequest::kUncertainty:
      return Put(StudyUncertainty(request, subject, progress), *result.mutable_uncertainty());
    case v1::CreateStudyRequest::kConvergence:
      return Put(StudyConvergence(request, subject, compile, progress), *result.mutable_convergence());
    case v1::CreateStudyRequest::WHAT_NOT_SET:
      break;
  }
  return absl::InvalidArgumentError(kNoStudy);
}

}  // namespace

absl::StatusOr<v1::StudyResult> Run(v1::CreateStudyRequest request, const Compiler& compile, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  FillStudy(request);
  if (!progress(0, "compiling the scene")) return Cancelled();
  const auto subject = MakeSubject(request.source(), request.preset(), request.parameters(), compile);
  if (!subject.ok()) return subject.status();
  v1::StudyResult result;
  if (absl::Status status = Fill(request, *subject, compile, progress, result); !status.ok()) return status;
  result.set_scene(subject->model->scene.name());
  result.set_scene_hash(subject->model->report.scene_hash());
  *result.mutable_parameters() = subject->parameters;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  result.set_took_s(took.count());
  return result;
}

}  // namespace phrenic::study
