// Elements of a scene that stand for several: `for_each` (message ForEach of phrenic/v1/geometry.proto).
#ifndef PHRENIC_SERVER_SCHEMA_REPETITION_H_
#define PHRENIC_SERVER_SCHEMA_REPETITION_H_

#include <optional>

#include "phrenic/v1/scene.pb.h"
#include "server/schema/problem.h"

namespace phrenic::schema {

// Gives the scene's physique to the generated bodies without one, and replaces every element that has a `for_each` by
// its repetitions, in place: the scene is then the one that a person would have written out. Returns a problem, with a
// path into the scene as it was, for an empty or too large set, for an unknown placeholder, and for two bodies of one
// name. Requires: FindProblem finds nothing.
std::optional<Problem> Repeat(v1::Scene* scene);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_REPETITION_H_
