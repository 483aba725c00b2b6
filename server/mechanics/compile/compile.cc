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
#include "server/mechanics/compile/initial_velocities.h"
#include "server/mechanics/compile/masses.h"
#include "server/mechanics/compile/presets.h"
#include "server/mechanics/compile/scene_hash.h"
#include "server/mechanics/integrators/catalogue.h"
#include "server/mechanics/stability/largest_step.h"
#include "server/mechanics/step/step_plan.h"
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

absl::Status AddElements(ModelBuilder& builder) {
  const v1::Scene& scene = builder.model.scene;
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
  if (absl::Status s = SpreadMassByStiffness(builder.model); !s.ok()) return s;
  for (int i = 0; i < scene.constraints_size(); ++i) {
    auto constraint = MakeConstraint(scene.constraints(i), absl::StrCat("constraints[", i, "]"), builder);
    if (!constraint.ok()) return constraint.status();
    if (builder.stop.Stopped()) return builder.stop.status();
    if (*constraint != nullptr) builder.model.constraints.push_back(*std::move(constraint));
  }
  const Integrator& integrator = FindIntegrator(builder.model.parameters.integrator());
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

// Reports the live parameters without effect in this scene, which viewers hide.
void ReportIdleParameters(const v1::Scene& scene, v1::CompileReport& report) {
  const bool ribs = std::any_of(scene.motions().begin(), scene.motions().end(),
                                [](const v1::Motion& motion) { return motion.has_ribs(); });
  const bool muscles = std::any_of(scene.forces().begin(), scene.forces().end(), [](const v1::Force& force) {
    return force.has_action_line() || force.has_fibres();
  });
  if (!ribs) {
    for (const char* name : {"rib_motion", "pump_handle", "bucket_handle"}) report.add_idle_parameters(name);
  }
  if (!muscles) report.add_idle_parameters("apply_muscles");
  const auto has_line = [&scene](v1::Side side) {
    return std::any_of(scene.forces().begin(), scene.forces().end(),
                       [side](const v1::Force& force) { return force.action_line().side() == side; });
  };
  const bool air = std::any_of(scene.forces().begin(), scene.forces().end(),
                               [](const v1::Force& force) { return force.action_line().air_load() > 0; });
  if (!ribs && !air) report.add_idle_parameters("hyperinflation");
  if (!has_line(v1::SIDE_RIGHT)) report.add_idle_parameters("right_activation");
  if (!has_line(v1::SIDE_LEFT)) report.add_idle_parameters("left_activation");
  if (scene.constraints().empty()) report.add_idle_parameters("apply_links");
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
  schema::FillDefaults(&model.scene);
  // Unset fields of these have a meaning, so that they must not be filled with defaults.
  model.scene.mutable_parameters()->CopyFrom(scene.parameters());
  model.scene.mutable_presets()->CopyFrom(scene.presets());
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
  ReportIdleParameters(model.scene, model.report);
  model.report.set_scene(scene.name());
  model.report.set_scene_hash(SceneHash(model));
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
