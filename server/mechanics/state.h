// All that changes while a session runs. A copy is a snapshot; equal states give equal futures, bit for bit.
#ifndef PHRENIC_SERVER_MECHANICS_STATE_H_
#define PHRENIC_SERVER_MECHANICS_STATE_H_

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Where a rigid part is and how it moves: x = rotation x_rest + translation.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();       // [m]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // [rad/s]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          // of the point that rests at the origin [m/s]

  Eigen::Vector3d At(const Eigen::Vector3d& rest) const { return rotation * rest + translation; }
  Eigen::Vector3d VelocityAt(const Eigen::Vector3d& rest) const {
    return velocity + angular_velocity.cross(rotation * rest);
  }
};

// What an integrator remembers of the step before, for one that does; only its own, and only if no other step came
// between.
struct History {
  int integrator = 0;      // the integrator that it belongs to (v1::Integrator); 0: to no integrator
  std::int64_t tick = -1;  // the state it belongs to
  double dt = 0;           // length of that step, or of its last part [s]
  Points x, v;             // at the start of it [m], [m/s]
  Points force;            // at the end of it [N]
};

// A force by which a client pulls a vertex while the session runs (pulls.h).
struct VertexPull {
  int vertex = 0;                                   // simulated
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // [N]
};

// Generalised coordinates that are not vertices: joint angles, volumes, activations. Model::scalars has their names.
struct ScalarState {
  Eigen::VectorXd q;  // values, each in its own unit
  Eigen::VectorXd v;  // rates [that unit/s]
};

struct State {
  double time = 0;          // [s]
  std::int64_t tick = 0;    // steps taken
  double phase = 0;         // breaths since the start; its rate is 1/breath_length, so that the signal never jumps
  Points x;                 // positions of the simulated vertices [m]
  Points v;                 // their velocities [m/s]
  std::vector<Pose> poses;  // of the driven bodies
  ScalarState scalars;
  std::vector<VertexPull> pulls;  // one a vertex
  History history;
  int halvings = 0;  // of an adaptive step, the last time
};

// Returns a word-wise FNV-1a hash, in four lanes, of the bits of time, phase, positions, velocities and scalars. Equal
// states have equal hashes.
std::uint64_t StateHash(const State& state);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STATE_H_
