// The bodies of a thorax, found by their anatomy.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_PARTS_H_
#define PHRENIC_SERVER_PHYSIOLOGY_PARTS_H_

#include <limits>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/model.h"

namespace phrenic::physiology {

// What a measure returns if the scene lacks what it is measured on. Sums, ratios and extremes with it are none as well.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Indices into Model::bodies; -1 for a body that the scene lacks.
struct Parts {
  int sheet = -1;   // the diaphragm as it is seen
  int muscle = -1;  // the diaphragm as it is simulated: the same body, or its middle surface
  int sternum = -1, wall = -1;
  std::vector<int> ribs, lungs;
  const Force* pressures = nullptr;  // the force with a pleural pressure of each side; null without
};

// FAILED_PRECONDITION if no deformable body is a diaphragm.
absl::StatusOr<Parts> FindParts(const Model& model);

// Returns the vertices of a body in a state, 3 x n [m]. Thread-safe.
Points Placed(const Model& model, const State& state, int body);

// Returns an output of a force by its name; kNone without the force or the output.
double ReadOutput(const Force* force, std::string_view output, const EvalContext& at);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_PARTS_H_
