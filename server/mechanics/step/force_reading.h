// The forces on vertices, by kind, for people who ask; no step pays for it.
//
// They are those that semi-implicit Euler's next step takes: "net" is m (v' - v)/dt of that step, and the sum of all
// other kinds. "constraints" is what links and limits add to it: m times what they change of the velocities, over dt.
// dt is the session's step, at most kLongestReading.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_FORCE_READING_H_
#define PHRENIC_SERVER_MECHANICS_STEP_FORCE_READING_H_

#include <string>
#include <vector>

#include "server/mechanics/model.h"

namespace phrenic {

inline constexpr double kLongestReading = 1e-3;  // [s]

// Reads one state under its parameters, of which it takes copies; the model outlives it. One thread at a time.
class ForceReading {
 public:
  ForceReading(const Model& model, const v1::Parameters& parameters, const State& state);

  // As scene text names them ("action_line"), each once, in the scene's order; then "constraints" and "pull" where
  // there are some, and "net".
  const std::vector<std::string>& kinds() const { return kinds_; }
  // [N], 3 x simulated vertices; zero where it is none of `kinds`. Fixed and driven vertices have a net force and do
  // not follow it; no constraint acts on them.
  Points Of(const std::string& kind) const;

 private:
  Points Elements(const std::string& kind) const;
  Points Pulls() const;
  Points Constraints() const;
  Points Loads() const;  // all but constraints

  const Model& model_;
  const v1::Parameters parameters_;
  const double dt_;  // [s]
  State state_;      // driven vertices and poses are where the next step has them
  std::vector<std::string> kinds_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_FORCE_READING_H_
