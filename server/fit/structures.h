// A person's structures as surfaces: points in the lungs for their registration, and how far the registered lungs are
// from the person's.
#ifndef PHRENIC_SERVER_FIT_STRUCTURES_H_
#define PHRENIC_SERVER_FIT_STRUCTURES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/fit/person.h"

namespace phrenic::fit {

struct PersonStructure {
  std::string name;    // "lung-right", "lung-left", "diaphragm"
  std::string source;  // the file, for messages
  Mesh surface;        // [m], LPS
};

struct StructureResidual {
  std::string name;
  bool shaped;       // true: the registration was made to it; false: it judges alone
  double mean, p95;  // distances between the surfaces, of a lung in both directions [m]
  int points;
};

// Returns points on a grid in both lungs, 2 mm or more from their surface, as many as Register uses or more.
// INVALID_ARGUMENT if a lung is missing, is not closed or does not face outwards, or the right one lies on the left
// (+x): the sides are exchanged, or the axes are not LPS.
absl::StatusOr<Points> PointsInLungs(const std::vector<PersonStructure>& structures);

// Returns the distances of the registered lungs from the person's, and of their bases from the diaphragm.
std::vector<StructureResidual> CompareStructures(const LungTemplates& templates, const RegisteredLungs& registered,
                                                 const std::vector<PersonStructure>& structures);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_STRUCTURES_H_
