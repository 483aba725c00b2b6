// What an element may read while it acts: one moment of a run.
#ifndef PHRENIC_SERVER_MECHANICS_EVAL_CONTEXT_H_
#define PHRENIC_SERVER_MECHANICS_EVAL_CONTEXT_H_

#include <vector>

#include "phrenic/v1/parameters.pb.h"
#include "server/mechanics/state.h"

namespace phrenic {

class ChamberReadings;
struct PoseMatrices;

// References into the state of the caller: valid during the call only.
struct EvalContext {
  double time;                       // [s]
  double breath;                     // the waveform's signal, -1 to 1; 0 at rest
  double breath_rate;                // its time derivative [1/s]
  const v1::Parameters& parameters;  // every field set
  const ConstPoints x;               // [m]
  const ConstPoints v;               // [m/s]
  const std::vector<Pose>& poses;
  const std::vector<VertexPull>& pulls;
  const ScalarState& scalars;
  ChamberReadings* readings = nullptr;    // what measures of one moment share (chamber.h); null in a step
  const float* packed = nullptr;          // x in single precision (PackPoints), where a step has packed it
  const PoseMatrices* columns = nullptr;  // one of each pose, where a step has made them
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_EVAL_CONTEXT_H_
