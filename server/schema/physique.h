// What sex, age and barrel chest choose in a body, where the scene's author chooses nothing. They add up; a number that
// is set counts. Units as in Physique. Stateless; thread-safe.
//
//   number          adult   woman     a year after 30          barrel chest of 1
//   height          1.75    1.62
//   chest width     1       * 0.95
//   chest depth     1       * 0.95                             * 1.22
//   rib slope       0       + 3       - 0.1                    - 6
//   dome heights    0                                          - 0.02
//   kyphosis        0                 + 0.3
//   compliance of the rib cage    1   - 0.30 / 34 from 31 to 65 years, the same line from 24 to 75
//   of the abdominal wall         1   - 0.37 / 34
//
// Sources (server/physiology/bodies.md says which numbers are chosen): Bellemare et al., Am J Respir Crit Care Med
// 2003;168:305; Bellemare et al., Respir Physiol Neurobiol 2006;150:233; Weaver et al., J Biomech Eng 2014
// (PMC4111931); Estenne et al., J Appl Physiol 1985;59:1842; Singh et al., J Appl Physiol 2001;91:1913.
#ifndef PHRENIC_SERVER_SCHEMA_PHYSIQUE_H_
#define PHRENIC_SERVER_SCHEMA_PHYSIQUE_H_

#include "absl/status/status.h"
#include "phrenic/v1/scene.pb.h"

namespace phrenic::schema {

// Returns the physique with every number set, within its range.
v1::Physique CompletePhysique(const v1::Physique& physique);

// Sets the initial compliance of the rib cage and of the abdominal wall to those of the scene's age, unless the scene
// sets them or has no age.
void SetCompliancesOfAge(v1::Scene* scene);

// Replaces the numbers that `physique` sets, in the scene and in every generated body. INVALID_ARGUMENT if a number is
// out of range or the scene generates no body.
absl::Status ReplacePhysique(const v1::Physique& physique, v1::Scene* scene);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_PHYSIQUE_H_
