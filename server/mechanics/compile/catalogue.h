// The catalogues of forces, constraints, motions and measures: the class that implements each message of the scene. A
// kind without a case does not compile (-Werror=switch).
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_CATALOGUE_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_CATALOGUE_H_

#include <string_view>

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Return the element of a scene's message; null if it would have no effect, which the compile report then states.
// INVALID_ARGUMENT "path.field: ..." if the message is invalid.
absl::StatusOr<std::unique_ptr<Force>> MakeForce(const v1::Force& scene, std::string_view path, ModelBuilder& builder);
absl::StatusOr<std::unique_ptr<Constraint>> MakeConstraint(const v1::Constraint& scene, std::string_view path,
                                                           ModelBuilder& builder);
// Adds a motion, or the skins of a skin message, to the builder.
absl::Status AddMotion(const v1::Motion& scene, std::string_view path, ModelBuilder& builder);
absl::StatusOr<std::unique_ptr<Measure>> MakeMeasure(const v1::Measure& scene, std::string_view path,
                                                     ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_CATALOGUE_H_
