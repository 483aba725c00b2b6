#include "server/mechanics/compile/compile.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/compile/bodies.h"
#include "server/mechanics/compile/catalogue.h"
#include "server/mechanics/compile/masses.h"
#include "server/mechanics/compile/presets.h"
#include "server/mechanics/compile/scene_hash.h"
#include "server/mechanics/stability/spectrum.h"
#include "server/mechanics/step/step_forces.h"
#include "server/schema/schema.h"

namespace phrenic {
namespace {

constexpr double kSafety = 0.95;           // of the Lanczos estimate
constexpr double kChosen = 0.9;            // of the largest stable step
constexpr double kLongestStep = 1.0 / 60;  // [s]; one step a frame at most

// Tells the report how long each stage takes, and all of them.
class StageClock {
 public:
  explicit StageClock(v1::CompileReport& report) : report_(report) {}

  void End(const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    v1::StageTime& row = *report_.add_stages();
    row.set_name(stage);
    row.set_seconds(seconds);
    report_.set_compile_seconds(report_.compile_seconds() + seconds);
    start_ = now;
  }

 private:
  v1::CompileReport& report_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// "action_line": the name of the field that is set of the kinds there are.
std::string KindOf(const v1::Force& force) {
  return v1::Force::descriptor()->FindFieldByNumber(force.kind_case())->name();
}

absl::Status AddElements(ModelBuilder& builder) {
  const v1::Scene& scene = builder.model.scene;
  for (int i = 0; i < scene.motions_size(); ++i) {
    if (absl::Status s = AddMotion(scene.motions(i), absl::StrCat("motions[", i, "]"), builder); !s.ok()) return s;
  }
  for (int i = 0; i < scene.forces_size(); ++i) {
    auto force = MakeForce(scene.forces(i), absl::StrCat("forces[", i, "]"), builder);
    if (!force.ok()) return force.status();
    if (*force == nullptr) continue;
    builder.model.forces.push_back(*std::move(force));
    builder.model.force_kinds.push_back(KindOf(scene.forces(i)));
  }
  ChooseStepForces(builder.model);
  if (absl::Status s = SpreadMassByStiffness(builder.model); !s.ok()) return s;
  for (int i = 0; i < scene.constraints_size(); ++i) {
    auto constraint = MakeConstraint(scene.constraints(i), absl::StrCat("constraints[", i, "]"), builder);
    if (!constraint.ok()) return constraint.status();
    if (*constraint != nullptr) builder.model.constraints.push_back(*std::move(constraint));
  }
  const Integrator& integrator = FindIntegrator(builder.model.parameters.integrator());
  builder.ReportElement("integrator", integrator.name(), builder.model.rest.cols(), "vertices",
                        absl::StrFormat("order %d", integrator.order()));
  return absl::OkStatus();
}

// What the scene has no need of, beside what the elements themselves said.
void ReportUnused(ModelBuilder& builder) {
  const Model& model = builder.model;
  if (model.rest.cols() == 0) builder.ReportLeftOut("integration", "no body is deformable");
  if (model.constraints.empty()) builder.ReportLeftOut("constraints", "the scene has no rigid links");
  if (model.motions.empty()) builder.ReportLeftOut("motions", "nothing in the scene moves by a law of its own");
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

// Live parameters that have nothing to act on; viewers hide them.
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

// The stiffness that forces put on one vertex.
class VertexStiffness final : public StiffnessSink {
 public:
  explicit VertexStiffness(int vertex) : vertex_(vertex) {}
  void Add(int i, int j, const Eigen::Matrix3d& block) override {
    if (i == vertex_ && j == vertex_) sum_ += block;
  }
  void AddSprings(std::span<const SpringStiffness> springs) override {
    for (const SpringStiffness& spring : springs) {
      if (spring.a == vertex_ || spring.b == vertex_) sum_ += spring.Block();
    }
  }
  void AddOuter(double scale, const Points& g) override { sum_ += scale * g.col(vertex_) * g.col(vertex_).transpose(); }
  double Size() const { return sum_.norm(); }

 private:
  const int vertex_;
  Eigen::Matrix3d sum_ = Eigen::Matrix3d::Zero();
};

std::string StiffestElementAt(const Model& model, const EvalContext& at, int vertex) {
  std::string name = "nothing";
  double largest = 0;
  for (const auto& force : model.forces) {
    VertexStiffness stiffness(vertex);
    force->AddStiffness(at, stiffness);
    force->AddLatentStiffness(at, stiffness);
    if (stiffness.Size() <= largest) continue;
    largest = stiffness.Size();
    name = force->name();
  }
  return name;
}

std::string Verdict(const Integrator& integrator, const Spectrum& spectrum, double limit) {
  if (limit == 0) {
    return absl::StrFormat("; %s is stable at no step here: least damping %.3g 1/s, lightest vertex %.3g kg",
                           std::string(integrator.name()), spectrum.least_damping_rate, spectrum.least_mass);
  }
  if (std::isinf(limit)) return absl::StrCat("; ", std::string(integrator.name()), " is stable at any step");
  return "";
}

void ResolveParameters(Model& model) {
  model.parameters = model.scene.parameters();
  schema::FillDefaults(&model.parameters);
  if (!model.parameters.has_time_step()) model.parameters.set_time_step(kLongestStep);  // until the limit is known
}

// Three significant digits, downwards, and just what those digits read as: people see and type it.
double RoundDown(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::stod(absl::StrFormat("%.2e", std::floor(value / unit * (1 + 1e-12)) * unit));
}

void ChooseStep(Model& model) {
  v1::StableStep stable = LargestStableStep(model, model.parameters);
  if (!model.scene.parameters().has_time_step()) model.parameters.set_time_step(ChosenStep(stable));
  stable.set_chosen_seconds(model.parameters.time_step());
  *model.report.mutable_stable_step() = stable;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const Model>> Compile(const v1::Scene& scene, const MeshSource& source) {
  ModelBuilder builder;
  Model& model = builder.model;
  model.scene = scene;
  if (absl::Status status = schema::Resolve(&model.scene); !status.ok()) return status;
  schema::FillDefaults(&model.scene);
  // What these leave open has a meaning of its own.
  model.scene.mutable_parameters()->CopyFrom(scene.parameters());
  model.scene.mutable_presets()->CopyFrom(scene.presets());
  ResolveParameters(model);
  CompletePresets(model.scene);
  StageClock clock(model.report);
  if (absl::Status status = AddBodies(source, builder); !status.ok()) return status;
  clock.End("bodies");
  if (absl::Status status = AddElements(builder); !status.ok()) return status;
  clock.End("elements");
  if (absl::Status status = AddProbes(builder); !status.ok()) return status;
  if (absl::Status status = AddMeasures(builder); !status.ok()) return status;
  clock.End("measures");
  ReportUnused(builder);
  ReportIdleParameters(model.scene, model.report);
  model.report.set_scene(scene.name());
  model.report.set_scene_hash(SceneHash(model));
  clock.End("hash");
  ChooseStep(model);
  clock.End("largest step");
  return std::make_shared<const Model>(std::move(model));
}

double ChosenStep(const v1::StableStep& stable) {
  // Where no step is stable: a small one, so that it can be watched going wrong.
  const double limit = stable.seconds() > 0 ? stable.seconds() : 0.1 / stable.omega_max();
  return std::isinf(limit) ? kLongestStep : std::min(RoundDown(kChosen * limit), kLongestStep);
}

v1::StableStep LargestStableStep(const Model& model, const v1::Parameters& parameters) {
  v1::StableStep report;
  const State state = model.InitialState();
  const FastestMode fastest = FindFastestMode(model, parameters, state);
  const Integrator& integrator = FindIntegrator(parameters.integrator());
  const double limit = kSafety * integrator.MaxStep(fastest.spectrum);
  report.set_omega_max(fastest.spectrum.omega_max);
  const double largest_step =
      v1::Parameters::descriptor()->FindFieldByName("time_step")->options().GetExtension(v1::quantity).maximum();
  report.set_seconds(std::min(limit, largest_step));
  if (fastest.vertex < 0) {
    report.set_reason(limit > 0 ? "nothing in the scene vibrates: any step is stable"
                                : "nothing in the scene vibrates" + Verdict(integrator, fastest.spectrum, limit));
    return report;
  }
  const BodyModel& body = model.BodyOf(fastest.vertex);
  const std::string stiffest = StiffestElementAt(model, MakeEvalContext(model, parameters, state), fastest.vertex);
  report.set_reason(absl::StrFormat("fastest vibration %.3g rad/s at vertex %d of %s, by %s; damping %.3g 1/s%s",
                                    fastest.spectrum.omega_max, fastest.vertex - body.first_vertex, body.name, stiffest,
                                    fastest.spectrum.damping_rate, Verdict(integrator, fastest.spectrum, limit)));
  return report;
}

}  // namespace phrenic
