// The catalogues of the families: which message makes which element. A kind without its case does not compile.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_CATALOGUE_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_CATALOGUE_H_

#include <string_view>

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Null where the element has nothing to do; it has said so in the report then.
absl::StatusOr<std::unique_ptr<Force>> MakeForce(const v1::Force& scene, std::string_view path, ModelBuilder& builder);
absl::StatusOr<std::unique_ptr<Constraint>> MakeConstraint(const v1::Constraint& scene, std::string_view path,
                                                           ModelBuilder& builder);
// Adds a motion to the builder, or a ride.
absl::Status AddMotion(const v1::Motion& scene, std::string_view path, ModelBuilder& builder);
absl::StatusOr<std::unique_ptr<Measure>> MakeMeasure(const v1::Measure& scene, std::string_view path,
                                                     ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_CATALOGUE_H_
