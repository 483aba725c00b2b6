// The forces on vertices by kind, for display. Steps do not compute them.
//
// They are those of semi-implicit Euler's next step: "net" is m (v' - v)/dt of that step and the sum of all other
// kinds, except for rounding of springs in single precision, which are read in double. "constraints" is the change of
// the velocities by links and limits, times m/dt. dt is the session's step, at most kLongestReading.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_FORCE_READING_H_
#define PHRENIC_SERVER_MECHANICS_STEP_FORCE_READING_H_

#include <string>
#include <vector>

#include "server/mechanics/model.h"

namespace phrenic {

inline constexpr double kLongestReading = 1e-3;  // [s]

// Reads copies of one state and its parameters; the model must outlive it. Not thread-safe.
class ForceReading {
 public:
  ForceReading(const Model& model, const v1::Parameters& parameters, const State& state);

  // The kinds of forces by their names in scene text ("action_line"), each once, in the scene's order; then
  // "constraints" and "pull" if there are any, and "net".
  const std::vector<std::string>& kinds() const { return kinds_; }
  // Returns the forces of one kind [N], 3 x simulated vertices; zero for a name that is not in `kinds`. Fixed and
  // driven vertices have a net force that they do not follow; constraints do not act on them.
  Points Of(const std::string& kind) const;

 private:
  Points Elements(const std::string& kind) const;
  Points Pulls() const;
  Points Constraints() const;
  Points Sum() const;  // of all but constraints

  const Model& model_;
  const v1::Parameters parameters_;
  const double dt_;  // [s]
  State state_;      // with driven vertices and poses at the end of the next step
  Scratch scratch_;
  std::vector<std::string> kinds_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_FORCE_READING_H_
