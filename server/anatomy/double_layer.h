// A sheet as a closed double layer: two surfaces, each half the gap away along the normal, joined along the boundary
// and around the openings. With h openings the genus is h.
#ifndef PHRENIC_SERVER_ANATOMY_DOUBLE_LAYER_H_
#define PHRENIC_SERVER_ANATOMY_DOUBLE_LAYER_H_

#include <functional>

#include "server/anatomy/sheet_mesh.h"

namespace phrenic::anatomy {

inline constexpr double kDiaphragmGap = 3;  // between the layers [mm]
inline constexpr double kBorderGap = 2.2;   // at the boundary and the openings [mm]

// The unit normal towards the upper layer at a plane point.
using SheetNormal = std::function<Eigen::Vector3d(const Eigen::Vector2d&)>;

// The indices of vertex i of the sheet in the double layer. Opposite vertices are adjacent in memory, because links
// between the layers read both.
constexpr int UpperVertex(int i) { return 2 * i; }
constexpr int LowerVertex(int i) { return 2 * i + 1; }
constexpr bool IsUpper(int vertex) { return vertex % 2 == 0; }

// Returns the closed mesh in the sheet's unit, without regions.
Mesh DoubleLayer(const Sheet& sheet, const SheetNormal& normal);

// Returns the distance from a vertex of the sheet to the nearest vertex of the loop.
double LoopDistance(const Sheet& sheet, const std::vector<int>& loop, int vertex);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_DOUBLE_LAYER_H_
