// A model that keeps time of its elements.
#ifndef PHRENIC_SERVER_STUDY_TIMED_MODEL_H_
#define PHRENIC_SERVER_STUDY_TIMED_MODEL_H_

#include <deque>
#include <memory>
#include <string>

#include "server/mechanics/model.h"

namespace phrenic::study {

// What one element does in one way, since it was last set to nothing.
struct Stage {
  std::string stage;    // "force"
  std::string element;  // "springs:muscle"
  double seconds = 0;   // wall time
  int calls = 0;
  int parts = 0;  // in which the calls came: the clock was read before and after each
};

using Stages = std::deque<Stage>;  // places stay where they are

// The same model for steps (bodies, probes and what viewers see are not copied); its elements are those of `model`,
// which must outlive it, and add their time to `stages`. For one thread.
std::shared_ptr<const Model> Timed(const Model& model, Stages& stages);

// Wall time that a stage shows for a call that does nothing [s].
double ClockCost();

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_TIMED_MODEL_H_
