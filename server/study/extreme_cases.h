// The fixed suite of extreme cases: small scenes that ask for what no step can give, or that look as if they did.
#ifndef PHRENIC_SERVER_STUDY_EXTREME_CASES_H_
#define PHRENIC_SERVER_STUDY_EXTREME_CASES_H_

#include <functional>
#include <string>
#include <vector>

#include "server/mechanics/model.h"

namespace phrenic::study {

// How a case is judged beside what all are: finite or an honest stop.
struct Judged {
  bool energy = true;  // kinetic energy within what is there: not where driven vertices bring more
  bool error = true;   // distance from the reference: not where a motion amplifies the smallest difference
};

struct ExtremeCase {
  std::string name = {};
  std::string scene = {};  // in the scene language
  double step = 0.004;     // [s]
  double seconds = 0.4;    // [s]
  Judged judged = {};
  // What the scene language cannot say: another start, parameters that no session accepts.
  std::function<void(const Model&, State&)> disturb = {};
  std::function<void(v1::Parameters&)> adjust = {};
};

// The first is the baseline: nothing in it is extreme.
std::vector<ExtremeCase> ExtremeCases();

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_EXTREME_CASES_H_
