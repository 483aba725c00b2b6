// The largest coordinate of a body's vertices along a direction, max over i of (x_i - point).direction [m], or its
// change since rest. The vertex at the maximum may change over time; use a probe to follow a fixed vertex.
#ifndef PHRENIC_SERVER_MECHANICS_MEASURES_HIGHEST_H_
#define PHRENIC_SERVER_MECHANICS_MEASURES_HIGHEST_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// INVALID_ARGUMENT if the body or region does not exist, the region has no vertex, or the direction is zero.
absl::StatusOr<std::unique_ptr<Measure>> MakeHighest(const v1::Highest& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURES_HIGHEST_H_
