// Names of bodies and of sets of bodies, as scenes write them (proto/phrenic/v1/scene.proto).
#ifndef PHRENIC_SERVER_MECHANICS_BODY_NAMES_H_
#define PHRENIC_SERVER_MECHANICS_BODY_NAMES_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/model.h"

namespace phrenic {

// Returns the bodies that a name means, ascending: the body or all bodies of the layer of that name, or "body:NAME",
// "layer:NAME", "structure:STRUCTURE" (all bodies of that anatomy, "structure:rib"). INVALID_ARGUMENT "path: ..." for
// an unknown name, a layer or structure without a body, and a name of both a body and a layer that does not hold it.
absl::StatusOr<std::vector<int>> BodiesNamed(const Model& model, const std::string& name, std::string_view path);

// Returns the layers, and the bodies without a layer, for error messages: "ribs, sternum, spine".
std::string KnownBodyNames(const Model& model);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BODY_NAMES_H_
