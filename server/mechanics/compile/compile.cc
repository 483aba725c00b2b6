#include "server/mechanics/compile/compile.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/compile/bodies.h"
#include "server/mechanics/compile/catalogue.h"
#include "server/mechanics/compile/idle_parameters.h"
#include "server/mechanics/compile/initial_velocities.h"
#include "server/mechanics/compile/masses.h"
#include "server/mechanics/compile/presets.h"
#include "server/mechanics/integrators/catalogue.h"
#include "server/mechanics/skinning/tissue_bodies.h"
#include "server/mechanics/stability/largest_step.h"
#include "server/mechanics/step/combination.h"
#include "server/mechanics/step/step_plan.h"
#include "server/schema/body_size.h"
#include "server/schema/physique.h"
#include "server/schema/schema.h"

namespace phrenic {
namespace {

// Adds the duration of each stage, and their sum, to a report.
class StageClock {
 public:
  void End(const char* stage, v1::CompileReport& report) {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    v1::StageTime& row = *report.add_stages();
    row.set_name(stage);
    row.set_seconds(seconds);
    report.set_compile_seconds(report.compile_seconds() + seconds);
    start_ = now;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Returns the name of the kind, such as "action_line": the field of the oneof that is set.
std::string KindOf(const v1::Force& force) {
  return v1::Force::descriptor()->FindFieldByNumber(force.kind_case())->name();
}

// Lets the forces that can choose a prestress balance all others at rest, one after another.
absl::Status BalanceForces(ModelBuilder& builder) {
  const Model& model = builder.model;
  const State rest = model.InitialState();
  EvalContext at = MakeEvalContext(model, model.parameters, rest);
  at.releases_all = true;
  for (const auto& force : model.forces) {
    if (!force->balances_at_rest()) continue;
    Points load = Points::Zero(3, model.rest.cols()), normals = load;
    for (const auto& other : model.forces) {
      if (other != force) other->AddForce(at, load);
      other->AddContactNormals(at, normals);
    }
    for (const auto& motion : model.motions) motion->TransferForces(at, load);
    Eigen::VectorXd pushes = Eigen::VectorXd::Zero(model.rest.cols());
    if (absl::Status balanced = force->BalanceAtRest(load, normals, builder, pushes); !balanced.ok()) return balanced;
    if (pushes.isZero()) continue;
    for (const auto& other : builder.model.forces) other->RestOnSurface(pushes);
  }
  return absl::OkStatus();
}

absl::Status CheckTrace(const v1::Breath& breath) {
  if (breath.waveform() != v1::WAVEFORM_TRACE) return absl::OkStatus();
  if (breath.trace_size() < 2) return FieldError("breath.trace", "WAVEFORM_TRACE needs two values or more");
  for (int i = 0; i < breath.trace_size(); ++i) {
    if (breath.trace(i) >= 0 && breath.trace(i) <= 1) continue;
    return FieldError(absl::StrCat("breath.trace[", i, "]"), absl::StrCat(breath.trace(i), " is outside 0 to 1"));
  }
  return absl::OkStatus();
}

absl::Status AddElements(ModelBuilder& builder) {
  const v1::Scene& scene = builder.model.scene;
  if (absl::Status s = CheckTrace(scene.breath()); !s.ok()) return s;
  for (int i = 0; i < scene.motions_size(); ++i) {
    if (absl::Status s = AddMotion(scene.motions(i), absl::StrCat("motions[", i, "]"), builder); !s.ok()) return s;
    if (builder.stop.Stopped()) return builder.stop.status();
  }
  for (int i = 0; i < scene.forces_size(); ++i) {
    auto force = MakeForce(scene.forces(i), absl::StrCat("forces[", i, "]"), builder);
    if (!force.ok()) return force.status();
    if (builder.stop.Stopped()) return builder.stop.status();
    if (*force == nullptr) continue;
    builder.model.forces.push_back(*std::move(force));
    builder.model.force_kinds.push_back(KindOf(scene.forces(i)));
  }
  if (absl::Status s = BalanceForces(builder); !s.ok()) return s;
  if (builder.stop.Stopped()) return builder.stop.status();
  if (absl::Status s = SpreadMassByStiffness(builder.model); !s.ok()) return s;
  for (int i = 0; i < scene.constraints_size(); ++i) {
    auto constraint = MakeConstraint(scene.constraints(i), absl::StrCat("constraints[", i, "]"), builder);
    if (!constraint.ok()) return constraint.status();
    if (builder.stop.Stopped()) return builder.stop.status();
    if (*constraint != nullptr) builder.model.constraints.push_back(*std::move(constraint));
  }
  const Integrator& integrator = FindIntegrator(builder.model.parameters.integrator());
  if (absl::Status runs = CheckCombination(builder.model, integrator, builder.model.parameters); !runs.ok()) {
    return FieldError("parameters.integrator", std::string(runs.message()));
  }
  builder.ReportElement("integrator", integrator.name(), builder.model.rest.cols(), "vertices",
                        absl::StrFormat("order %d", integrator.order()));
  return absl::OkStatus();
}

absl::Status AddMeasures(ModelBuilder& builder) {
  std::set<std::string> names;
  for (int i = 0; i < builder.model.scene.measures_size(); ++i) {
    const v1::Measure& scene = builder.model.scene.measures(i);
    const std::string path = absl::StrCat("measures[", i, "]");
    if (!names.insert(scene.name()).second) {
      return FieldError(path + ".name", absl::StrCat("there are two measures named \"", scene.name(), "\""));
    }
    auto measure = MakeMeasure(scene, path, builder);
    if (!measure.ok()) return measure.status();
    if (builder.stop.Stopped()) return builder.stop.status();
    builder.model.measures.push_back(*std::move(measure));
  }
  return absl::OkStatus();
}

// Reports the parts of the simulation that the scene does not need. Elements have reported themselves before.
void ReportUnused(ModelBuilder& builder) {
  const Model& model = builder.model;
  if (model.rest.cols() == 0) builder.ReportLeftOut("integration", "no body is deformable");
  if (model.constraints.empty()) builder.ReportLeftOut("constraints", "the scene has no rigid links");
  if (model.motions.empty()) builder.ReportLeftOut("motions", "the scene has no prescribed motion");
  std::int64_t still = 0, vertices = 0;
  for (const BodyModel& body : model.bodies) {
    if (body.first_vertex >= 0 || body.pose >= 0 || body.skin >= 0) continue;
    ++still;
    vertices += body.mesh.vertices.cols();
  }
  if (still > 0) {
    builder.ReportLeftOut(absl::StrCat("motion of ", still, " bodies at rest"),
                          absl::StrCat(vertices, " vertices never move: they are sent once"));
  }
}

void ReportTissue(Model& model) {
  for (const int body : TissueBodies(model)) model.report.mutable_bodies(body)->set_tissue(true);
}

void ResolveParameters(Model& model) {
  model.parameters = model.scene.parameters();
  schema::FillDefaults(&model.parameters);
  if (!model.parameters.has_time_step()) model.parameters.set_time_step(kLongestStep);  // until ChooseStep
}

void ChooseStep(Model& model) {
  v1::StableStep stable = LargestStableStep(model, model.parameters);
  if (!model.scene.parameters().has_time_step()) model.parameters.set_time_step(ChosenStep(stable));
  stable.set_chosen_seconds(model.parameters.time_step());
  *model.report.mutable_stable_step() = stable;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const Model>> Compile(const v1::Scene& scene, const MeshSource& source,
                                                     const CompileOptions& options) {
  ModelBuilder builder;
  builder.stop = StopCheck(options.cancelled, options.longest, "--max-compile-seconds");
  Model& model = builder.model;
  model.scene = scene;
  if (absl::Status status = schema::Resolve(&model.scene); !status.ok()) return status;
  schema::ScaleForcesToPhysique(&model.scene);
  schema::FillDefaults(&model.scene);
  // Unset fields of these have a meaning, so that they must not be filled with defaults.
  model.scene.mutable_parameters()->CopyFrom(scene.parameters());
  model.scene.mutable_presets()->CopyFrom(scene.presets());
  schema::SetCompliancesOfAge(&model.scene);
  const auto size = EstimateSize(model.scene, options.size_of, options.limits);
  if (!size.ok()) return size.status();
  ResolveParameters(model);
  CompletePresets(model.scene);
  StageClock clock;
  if (absl::Status status = AddBodies(source, options.limits, builder); !status.ok()) return status;
  clock.End("bodies", model.report);
  if (absl::Status status = AddElements(builder); !status.ok()) return status;
  if (absl::Status status = AddInitialVelocities(builder); !status.ok()) return status;
  clock.End("elements", model.report);
  if (absl::Status status = AddProbes(builder); !status.ok()) return status;
  if (absl::Status status = AddMeasures(builder); !status.ok()) return status;
  clock.End("measures", model.report);
  ReportUnused(builder);
  ReportTissue(model);
  ReportIdleParameters(model.scene, model.report);
  model.report.set_scene(scene.name());
  if (options.hash != nullptr) model.report.set_scene_hash(options.hash(model));
  clock.End("hash", model.report);
  if (builder.stop.Stopped()) return builder.stop.status();
  ChooseStep(model);
  if (!(model.parameters.time_step() > 0)) {
    return FieldError("parameters.time_step",
                      "no stable step was found, because a stiffness over a mass is not a number: check the sizes and "
                      "masses of the bodies, or set time_step");
  }
  clock.End("largest step", model.report);
  if (builder.stop.Stopped()) return builder.stop.status();
  const auto compiled = std::make_shared<Model>(std::move(model));
  compiled->plan = MakeStepPlan(*compiled, AllIntegrators());
  ProjectInitialVelocities(*compiled);
  clock.End("step plan", compiled->report);
  return compiled;
}

}  // namespace phrenic
