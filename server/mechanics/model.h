// A compiled scene.
#ifndef PHRENIC_SERVER_MECHANICS_MODEL_H_
#define PHRENIC_SERVER_MECHANICS_MODEL_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/report.pb.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mechanics/constraint.h"
#include "server/mechanics/force.h"
#include "server/mechanics/integrator.h"
#include "server/mechanics/measure.h"
#include "server/mechanics/motion.h"
#include "server/mechanics/skin.h"
#include "server/mechanics/workspace.h"

namespace phrenic {

class StepPlan;

// One body of the scene.
struct BodyModel {
  std::string name;
  std::string layer;
  v1::Role role = v1::ROLE_UNSPECIFIED;
  v1::Anatomy anatomy;
  Mesh mesh;              // at rest
  int first_vertex = -1;  // index of its first vertex in State::x; -1 if it is not simulated
  int pose = -1;          // index into State::poses; -1 if it is not driven
  int skin = -1;          // index into Model::skins; -1 if it is not skinned
};

// A vertex of which viewers and exports show the path.
struct Probe {
  std::string name;
  int body = 0;
  int vertex = 0;  // of the body
};

// An action line as viewers draw it.
struct ActionLineView {
  std::string name;
  int body = 0;
  Eigen::Vector3d origin, direction;  // [m], unit
  double radius = 0;                  // [m]
};

// A generalised coordinate of State::scalars: its name and unit, and where it starts.
struct ScalarCoordinate {
  std::string name;
  std::string unit;         // SI, as in tables: "rad"
  double initial = 0;       // [unit]
  double initial_rate = 0;  // [unit/s]
  bool internal = false;    // an element's memory: frames leave it out
};

// A generalised coordinate q with inertia, such as the angle by which a rib cage is raised: a component of a simulated
// vertex that belongs to no body, x = scale q, so that integrators, solvers and stored states treat it as they treat
// vertices. The kinetic energy is inertia/2 q'^2, with inertia = mass scale^2. A generalised force Q [J/unit] is the
// component Q/scale of the force on that vertex [N].
struct Coordinate {
  std::string name;
  std::string unit;  // SI, as in tables
  int vertex = 0;    // simulated
  int axis = 0;      // 0 to 2
  double scale = 1;  // [m/unit]

  double Value(const ConstPoints& x) const { return x(axis, vertex) / scale; }  // [unit]
  double Rate(const ConstPoints& v) const { return v(axis, vertex) / scale; }   // [unit/s]
  // Adds a generalised force [J/unit] to the forces on vertices [N].
  void AddForce(double force, MutablePoints f) const { f(axis, vertex) += force / scale; }
};

// Immutable once compiled; shared by any number of sessions and threads. n is the number of simulated vertices.
struct Model {
  v1::Scene scene;
  v1::CompileReport report;
  v1::Parameters parameters;  // of a new session; every field set
  std::vector<BodyModel> bodies;
  Points rest;                   // positions of the simulated vertices at rest, 3 x n [m]
  Points initial_velocity;       // 3 x n [m/s]; empty if the scene starts at rest
  Eigen::VectorXd mass;          // [kg]
  Eigen::VectorXd inverse_mass;  // [1/kg]; 0 for fixed and driven vertices
  std::vector<std::unique_ptr<Force>> forces;
  std::vector<std::string> force_kinds;   // of each of `forces`, as scene text names it: "action_line"
  std::vector<ScalarCoordinate> scalars;  // in the order of State::scalars
  std::vector<Coordinate> coordinates;    // with inertia; their vertices follow those of the bodies
  std::vector<std::unique_ptr<Motion>> motions;
  std::vector<std::unique_ptr<Constraint>> constraints;
  std::vector<Skin> skins;  // of seen bodies; placed with frames, not with steps
  std::vector<Probe> probes;
  std::vector<std::unique_ptr<Measure>> measures;  // read with frames, not with steps
  double size = 0;                                 // diagonal of the bounding box at rest [m]
  double bound = 0;  // of any coordinate; a run beyond it has diverged: ten sizes outside the box at rest [m]
  std::shared_ptr<const StepPlan> plan;  // how steps evaluate this model (step/step_plan.h); it refers to the model

  // For viewers: pairs of simulated vertices, simulated vertices, lines.
  Edges rigid_links;
  std::vector<int> attached_vertices;
  std::vector<int> fixed_vertices;
  std::vector<int> driven_vertices;  // moved by motions
  std::vector<ActionLineView> action_lines;

  // Returns the state at t = 0: undeformed, with the initial velocities, driven bodies where the motions have them.
  State InitialState() const;
  // Returns memory for steps of this model.
  Workspace MakeWorkspace() const;
  // Returns the body that a simulated vertex belongs to. Requires: it is not that of a coordinate.
  const BodyModel& BodyOf(int simulated_vertex) const;
};

// Returns the moment of a state, which must outlive it. `scratch` is used by one thread at a time.
EvalContext MakeEvalContext(const Model& model, const v1::Parameters& parameters, const State& state,
                            const Scratch& scratch = {});
// The same positions at another time [s] and breath's phase [breaths].
EvalContext MakeEvalContext(const Model& model, const v1::Parameters& parameters, const State& state, double time,
                            double phase, const Scratch& scratch = {});

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MODEL_H_
