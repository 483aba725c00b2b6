// Triangles of muscle in the layout of the SIMD kernel.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_MUSCLE_LAYOUT_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_MUSCLE_LAYOUT_H_

#include <vector>

#include "server/mechanics/breathing/muscle_triangle.h"
#include "server/mechanics/forces/muscle_kernel.h"

namespace phrenic {

// Returns the layout of the triangles of one body, whose simulated vertices are `vertices`. Requires: there are less
// than `bundles` bundles.
template <typename Number>
MuscleLayout<Number> MakeMuscleLayout(const std::vector<MuscleTriangle>& triangles, int bundles,
                                      const VertexRange& vertices);
extern template MuscleLayout<float> MakeMuscleLayout(const std::vector<MuscleTriangle>&, int, const VertexRange&);
extern template MuscleLayout<double> MakeMuscleLayout(const std::vector<MuscleTriangle>&, int, const VertexRange&);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_MUSCLE_LAYOUT_H_
