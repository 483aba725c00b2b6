// A copy of a model whose elements measure their own time.
#ifndef PHRENIC_SERVER_STUDY_TIMED_MODEL_H_
#define PHRENIC_SERVER_STUDY_TIMED_MODEL_H_

#include <deque>
#include <memory>
#include <string>

#include "server/mechanics/model.h"

namespace phrenic::study {

// The time that one element spent in one kind of call since the last reset.
struct Stage {
  std::string stage;    // "force"
  std::string element;  // "springs:muscle"
  double seconds = 0;   // wall time [s]
  int calls = 0;
  int parts = 0;  // timed intervals; a call may be split into several
};

using Stages = std::deque<Stage>;  // a deque, so that references stay valid

// Returns a model that steps to the same bits as `model` and adds the time of its elements to `stages`. It has no
// bodies, probes and display data. Requires: `model` and `stages` outlive it. Not thread-safe.
std::shared_ptr<const Model> Timed(const Model& model, Stages& stages);

// Returns the wall time that a stage measures for an empty call [s].
double ClockCost();

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_TIMED_MODEL_H_
