// How far the furthest vertex of a body lies along a direction, max of (x_i - point).direction [m]: another vertex may
// be it a moment later, where a probe stays with its own.
#ifndef PHRENIC_SERVER_MECHANICS_MEASURES_HIGHEST_H_
#define PHRENIC_SERVER_MECHANICS_MEASURES_HIGHEST_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Measure>> MakeHighest(const v1::Highest& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURES_HIGHEST_H_
