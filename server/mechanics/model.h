// A compiled scene: immutable, shared by any number of sessions and threads.
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

namespace phrenic {

class LoadBatch;

struct BodyModel {
  std::string name;
  std::string layer;
  v1::Role role = v1::ROLE_UNSPECIFIED;
  v1::Anatomy anatomy;
  Mesh mesh;              // at rest
  int first_vertex = -1;  // of its vertices in State::x; -1 when it has none there
  int pose = -1;          // its place in State::poses; -1 when it has none
  int skin = -1;          // index into Model::skins; -1 if it is not skinned
};

struct Probe {
  std::string name;
  int body = 0;
  int vertex = 0;  // of the body
};

// An action line as it acts: what viewers draw of it.
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
};

struct Model {
  v1::Scene scene;
  v1::CompileReport report;
  v1::Parameters parameters;  // what a session starts with; every field set
  std::vector<BodyModel> bodies;
  Points rest;                   // of the simulated vertices [m]
  Eigen::VectorXd mass;          // [kg]
  Eigen::VectorXd inverse_mass;  // [1/kg]; 0 for fixed and driven vertices
  std::vector<std::unique_ptr<Force>> forces;
  std::vector<std::string> force_kinds;  // of each of `forces`, as scene text names it: "action_line"
  // The same sum as a step takes it: those of `forces` that are best worked out together are in `batches`, and those
  // that can be worked out range by range are, after the others.
  std::vector<std::unique_ptr<Force>> batches;
  std::vector<const Force*> whole_forces, range_forces;
  const LoadBatch* loads = nullptr;  // the last of range_forces, where a step may leave it to its kick
  int packed_from = -1;  // a step packs positions, from this vertex, for forces in single precision; -1 where none are
  std::vector<ScalarCoordinate> scalars;  // in the order of State::scalars
  std::vector<std::unique_ptr<Motion>> motions;
  std::vector<std::unique_ptr<Constraint>> constraints;
  std::vector<Skin> skins;  // seen bodies; worked out with frames, not with steps
  std::vector<Probe> probes;
  std::vector<std::unique_ptr<Measure>> measures;  // worked out with frames, not with steps
  double size = 0;                                 // diagonal of the bounding box at rest [m]
  double bound = 0;  // a coordinate beyond it means that the run has diverged: ten sizes outside the box at rest [m]

  // For viewers: pairs of simulated vertices, simulated vertices, lines.
  Edges rigid_links;
  std::vector<int> attached_vertices;
  std::vector<int> fixed_vertices;
  std::vector<int> driven_vertices;  // those that motions move
  std::vector<ActionLineView> action_lines;

  State InitialState() const;
  Workspace MakeWorkspace() const;
  // The body that a simulated vertex belongs to.
  const BodyModel& BodyOf(int simulated_vertex) const;
};

// The breath's signal at a phase [breaths] and its derivative by the phase.
double BreathSignal(v1::Waveform waveform, double phase);
double BreathSlope(v1::Waveform waveform, double phase);
EvalContext MakeEvalContext(const Model& model, const v1::Parameters& parameters, const State& state);
// The same positions at another time [s] and breath's phase [breaths].
EvalContext MakeEvalContext(const Model& model, const v1::Parameters& parameters, const State& state, double time,
                            double phase);

// Positions of all vertices of a body in a state [m]: simulated, carried by a pose, riding or still. `out` is 3 x
// vertices of the body.
void PlaceBody(const Model& model, const State& state, int body, MutablePoints out);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MODEL_H_
