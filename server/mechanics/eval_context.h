// One moment of a run, as elements see it.
#ifndef PHRENIC_SERVER_MECHANICS_EVAL_CONTEXT_H_
#define PHRENIC_SERVER_MECHANICS_EVAL_CONTEXT_H_

#include <vector>

#include "phrenic/v1/parameters.pb.h"
#include "server/mechanics/scratch.h"
#include "server/mechanics/state.h"

namespace phrenic {

class ChamberReadings;
struct Displacement;
struct PoseMatrices;

// The input of every force, motion and measure. Refers to the caller's state: valid during the call only. n is the
// number of simulated vertices.
struct EvalContext {
  double time;                       // [s]
  double breath;                     // the waveform's signal, -1 to 1; 0 at rest
  double breath_rate;                // its time derivative [1/s]
  double expiration;                 // the signal of the expiratory muscles, 0 to 1
  bool airway_closed;                // by the live parameter of that name or by the glottis
  const v1::Parameters& parameters;  // every field set
  const ConstPoints x;               // positions, 3 x n [m]
  const ConstPoints v;               // velocities, 3 x n [m/s]
  const std::vector<Pose>& poses;
  const std::vector<VertexPull>& pulls;
  const ScalarState& scalars;  // generalised coordinates
  Scratch scratch = {};        // memory for intermediate results
  bool releases_all = false;   // forces move even what a live parameter holds: where forces are balanced at rest
  // Results that several elements share at this moment; null if not available.
  ChamberReadings* readings = nullptr;          // of chambers read so far (breathing/chamber.h)
  const PoseMatrices* pose_matrices = nullptr;  // one per pose (skinning/pose_matrices.h)
  const Displacement* displacements = nullptr;  // one per simulated vertex (skinning/displacements.h)
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_EVAL_CONTEXT_H_
