// Bodies of a scene with the shape `derived`: what mechanics needs of a person's thorax and no file shows.
#ifndef PHRENIC_SERVER_IMAGING_SURFACES_DERIVED_BODIES_H_
#define PHRENIC_SERVER_IMAGING_SURFACES_DERIVED_BODIES_H_

#include "server/imaging/surfaces/derived_thorax.h"

namespace phrenic::imaging {

// Returns a source that makes derived bodies of `scene` from the others, which it takes from `source`, and passes on
// all other bodies. The first derived body takes a second or two and keeps what is made for the others: the inner cage
// and the diaphragm. INVALID_ARGUMENT if a body's anatomy cannot be derived; the errors of ReadSurfaces and
// DeriveThorax, and of `go_on`. Thread-safe if `source` and
// `go_on` are.
BodySource WithDerived(BodySource source, v1::Scene scene, GoOn go_on = AlwaysGoOn);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SURFACES_DERIVED_BODIES_H_
