// The size of a body's mesh, from the numbers that describe its shape.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_SHAPE_SIZE_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_SHAPE_SIZE_H_

#include <cstdint>

#include "server/mechanics/compile/scene_size.h"

namespace phrenic {

// Return the sum and the product of numbers that are not negative, or the largest number if they exceed it.
std::int64_t SaturatingSum(std::int64_t a, std::int64_t b);
std::int64_t SaturatingProduct(std::int64_t a, std::int64_t b);

// Returns an upper bound. Requires: schema::FillDefaults. A null `source` gives zeros.
MeshSize SizeOfShape(const v1::Body& body, const SizeSource& source);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_SHAPE_SIZE_H_
