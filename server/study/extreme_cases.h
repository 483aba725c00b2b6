// The fixed suite of extreme cases: small scenes with invalid, stiff, degenerate or strongly deformed input.
#ifndef PHRENIC_SERVER_STUDY_EXTREME_CASES_H_
#define PHRENIC_SERVER_STUDY_EXTREME_CASES_H_

#include <functional>
#include <string>
#include <vector>

#include "server/mechanics/model.h"

namespace phrenic::study {

// Criteria of a case beside the one that always applies: a finite result, or an error that names the cause.
struct Criteria {
  bool energy = true;  // kinetic energy within its sources; off if driven vertices add energy
  bool error = true;   // distance from the reference solution; off if the motion is chaotic
};

// One case: a scene, its run and its criteria.
struct ExtremeCase {
  std::string name = {};
  std::string scene = {};  // text of a scene file
  double step = 0.004;     // time step [s]
  double seconds = 0.4;    // simulated time [s]
  Criteria criteria = {};
  // Changes that a scene cannot express: another initial state, and parameters that a session would refuse.
  std::function<void(const Model&, State&)> disturb = {};
  std::function<void(v1::Parameters&)> adjust = {};
};

// Returns all cases. The first one, "baseline", has nothing extreme.
std::vector<ExtremeCase> ExtremeCases();

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_EXTREME_CASES_H_
