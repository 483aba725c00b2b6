// The size of a body's mesh, from the numbers that describe its shape.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_SHAPE_SIZE_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_SHAPE_SIZE_H_

#include <cstdint>
#include <functional>

#include "phrenic/v1/scene.pb.h"

namespace phrenic {

// All counts saturate at the largest number.
struct MeshSize {
  std::int64_t vertices = 0, edges = 0, triangles = 0, tetrahedra = 0;
};

// Returns the size of a body's file or generated part, as far as it is known without reading it; zeros otherwise.
using SizeSource = std::function<MeshSize(const v1::Body& body)>;

// Return the sum and the product of numbers that are not negative, or the largest number if they exceed it.
std::int64_t SaturatingSum(std::int64_t a, std::int64_t b);
std::int64_t SaturatingProduct(std::int64_t a, std::int64_t b);

// Returns an upper bound. Requires: schema::FillDefaults. A null `source` gives zeros.
MeshSize SizeOfShape(const v1::Body& body, const SizeSource& source);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_SHAPE_SIZE_H_
