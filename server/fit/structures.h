// A person's structures as surfaces: points in the lungs for their registration, and how far the registered lungs are
// from the person's.
#ifndef PHRENIC_SERVER_FIT_STRUCTURES_H_
#define PHRENIC_SERVER_FIT_STRUCTURES_H_

#include <array>
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

// The registered lungs, bent onto a person's surfaces by the smallest deformation of an elastic body (lung_tissue.h)
// whose surface springs pull to the nearest of the person's, at most kMostBend. In up to ten rounds the springs become
// stiffer, to kBendStiffness times the modulus per area at most, as long as nothing folds.
inline constexpr double kMostBend = 0.03;      // [m]
inline constexpr double kBendStiffness = 300;  // [1/m]
struct BentLungs {
  std::array<Mesh, 2> surfaces;       // by Side
  std::array<double, 2> most = {};    // that a vertex was bent by [m]
  std::array<double, 2> volume = {};  // least over that before, of a small part of a lung [1]
};

// The errors of LungTissue::Make. Requires: both lungs among the structures (PointsInLungs).
absl::StatusOr<BentLungs> BendLungs(const LungTemplates& templates, const RegisteredLungs& registered,
                                    const std::vector<PersonStructure>& structures);
// As CompareStructures, of bent lungs.
std::vector<StructureResidual> CompareStructures(const BentLungs& bent, const std::vector<PersonStructure>& structures);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_STRUCTURES_H_
