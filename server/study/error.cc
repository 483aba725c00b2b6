#include "server/study/error.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/skinning/probe_position.h"
#include "server/mechanics/skinning/tissue_bodies.h"
#include "server/study/error_rows.h"
#include "server/study/reference.h"
#include "server/study/refined_reference.h"
#include "server/study/subject.h"

namespace phrenic::study {
namespace {

// Fractions of the study's progress at which its parts end.
constexpr double kReferenceEnd = 0.3, kIntegratorsEnd = 0.85, kResidualsEnd = 0.9;

bool HasLinks(const v1::Scene& scene) {
  return std::any_of(scene.constraints().begin(), scene.constraints().end(),
                     [](const v1::Constraint& constraint) { return constraint.has_rigid_links(); });
}

void ProjectLinks(v1::Projection projection, v1::Scene& scene) {
  for (v1::Constraint& constraint : *scene.mutable_constraints()) {
    if (constraint.has_rigid_links()) constraint.mutable_rigid_links()->set_projection(projection);
  }
}

void UseDoublePrecision(v1::Scene& scene) {
  for (v1::Force& force : *scene.mutable_forces()) {
    if (force.has_springs()) force.mutable_springs()->set_precision(v1::PRECISION_DOUBLE);
    if (force.has_muscle()) force.mutable_muscle()->set_precision(v1::PRECISION_DOUBLE);
  }
}

absl::StatusOr<ReferenceSolution> MakeReference(const v1::CreateStudyRequest& request, const Subject& subject,
                                                const Compiler& compile, const Progress& progress,
                                                v1::ErrorTable& table) {
  const v1::ErrorStudy& study = request.error();
  v1::Scene scene = subject.model->scene;
  ProjectLinks(v1::PROJECTION_EXACT, scene);
  UseDoublePrecision(scene);
  const auto exact = Recompile(request, subject, scene, compile);
  if (!exact.ok()) return exact.status();
  ReferenceSolution solution;
  solution.moments = Moments(study.seconds(), study.moments());
  v1::Reference& report = *table.mutable_reference();
  const auto solve = IsSmooth(*exact->model) ? ConfirmedReference : RefinedReference;
  auto trajectory = solve(*exact, solution.moments, study.tolerance(), progress, report);
  if (!trajectory.ok()) return trajectory.status();
  solution.trajectory = *std::move(trajectory);
  solution.error_rms = 1e-3 * report.error_rms_mm();
  solution.error_max = 1e-3 * report.error_max_mm();
  return solution;
}

absl::Status AddIntegrators(const v1::ErrorStudy& study, const Subject& subject, const ReferenceSolution& solution,
                            const Progress& progress, v1::ErrorTable& table) {
  const std::vector<v1::Integrator> integrators = IntegratorsFor(study.integrators());
  const double part = (kIntegratorsEnd - kReferenceEnd) / static_cast<double>(integrators.size());
  double from = kReferenceEnd;
  for (const v1::Integrator integrator : integrators) {
    absl::Status added =
        AddIntegrator(With(subject, integrator), study, solution, Part(progress, from, from + part), table);
    if (!added.ok()) return added;
    from += part;
  }
  return absl::OkStatus();
}

absl::Status AddResiduals(const v1::CreateStudyRequest& request, const Subject& subject,
                          const ReferenceSolution& solution, const Compiler& compile, const Progress& progress,
                          v1::ErrorTable& table) {
  if (!HasLinks(subject.model->scene)) return absl::OkStatus();
  for (const v1::Projection projection : {v1::PROJECTION_EXACT, v1::PROJECTION_THESIS}) {
    v1::Scene scene = subject.model->scene;
    ProjectLinks(projection, scene);
    const auto projected = Recompile(request, subject, scene, compile);
    // The thesis' projection runs with explicit integrators only.
    if (projection == v1::PROJECTION_THESIS && absl::IsInvalidArgument(projected.status())) continue;
    if (!projected.ok()) return projected.status();
    const auto run = Simulate(*projected, solution.moments, subject.parameters.time_step(),
                              request.error().most_seconds_a_run(), progress);
    if (!run.ok()) return run.status();
    for (size_t i = 0; i < run->states.size(); ++i) {
      v1::ResidualRow& row = *table.add_residuals();
      row.set_projection(projection == v1::PROJECTION_EXACT ? "exact" : "thesis");
      row.set_time_s(solution.moments[i]);
      row.set_residual_mm(1e3 * LargestResidual(*projected->model, run->states[i]).metres);
      row.set_error_rms_mm(1e3 * RmsDistance(*projected->model, run->states[i].x, solution.trajectory.states[i].x));
    }
  }
  return absl::OkStatus();
}

// Displacements of the probes from rest at each moment [m].
std::vector<Eigen::Vector3d> ProbeDisplacements(const Model& model, const Trajectory& run) {
  std::vector<Eigen::Vector3d> displacements;
  for (const State& state : run.states) {
    for (const Probe& probe : model.probes) {
      const BodyModel& body = model.bodies[static_cast<size_t>(probe.body)];
      if (!FollowsTissue(model, body)) continue;
      displacements.emplace_back(ProbePosition(model, state, probe) - body.mesh.vertices.col(probe.vertex));
    }
  }
  return displacements;
}

// Sets the largest distance of probe displacements from those of the finest mesh.
void SetProbeError(const std::vector<Eigen::Vector3d>& displacements, const std::vector<Eigen::Vector3d>& finest,
                   v1::ResolutionRow& row) {
  if (displacements.size() != finest.size() || displacements.empty()) return;
  double largest = 0;
  for (size_t i = 0; i < displacements.size(); ++i) largest = std::max(largest, (displacements[i] - finest[i]).norm());
  row.set_error_probe_mm(1e3 * largest);
}

absl::Status AddResolutions(const v1::CreateStudyRequest& request, const ReferenceSolution& solution,
                            const Compiler& compile, const Progress& progress, v1::ErrorTable& table) {
  const v1::ErrorStudy& study = request.error();
  std::vector<double> sizes(study.resolutions_mm().begin(), study.resolutions_mm().end());
  std::sort(sizes.begin(), sizes.end());  // the finest first: the others are compared with it
  std::vector<Eigen::Vector3d> finest;
  for (const double size : sizes) {
    v1::SceneSource source = request.source();
    source.set_resolution_mm(size);
    v1::ResolutionRow& row = *table.add_resolutions();
    row.set_resolution_mm(size);
    const auto subject = MakeSubject(source, request.preset(), request.parameters(), compile);
    if (!subject.ok()) return subject.status();
    const double step = std::min(0.9 * PredictedStep(*subject), subject->parameters.time_step());
    const auto run = Simulate(*subject, solution.moments, step, study.most_seconds_a_run(), progress);
    if (!run.ok()) return run.status();
    row.set_vertices(subject->model->rest.cols());
    row.set_cpu_per_second(run->cpu_s / run->simulated_s);
    row.set_verdict(run->problem.empty() ? "ok" : run->problem);
    const std::vector<Eigen::Vector3d> displacements = ProbeDisplacements(*subject->model, *run);
    if (size == sizes.front()) finest = displacements;
    SetProbeError(displacements, finest, row);
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<v1::ErrorTable> StudyError(const v1::CreateStudyRequest& request, const Subject& subject,
                                          const Compiler& compile, const Progress& progress) {
  v1::ErrorTable table;
  table.set_seconds(request.error().seconds());
  const auto solution = MakeReference(request, subject, compile, Part(progress, 0, kReferenceEnd), table);
  if (!solution.ok()) return solution.status();
  absl::Status status = AddIntegrators(request.error(), subject, *solution, progress, table);
  if (!status.ok()) return status;
  status = AddResiduals(request, subject, *solution, compile, Part(progress, kIntegratorsEnd, kResidualsEnd), table);
  if (!status.ok()) return status;
  status = AddResolutions(request, *solution, compile, Part(progress, kResidualsEnd, 1), table);
  if (!status.ok()) return status;
  MarkPareto(table);
  table.set_advice(Advice(table, request.error().target()));
  return table;
}

}  // namespace phrenic::study
