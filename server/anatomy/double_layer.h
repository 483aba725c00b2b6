// A sheet as a closed double layer: a surface half the gap to either side of it, joined along its border and round its
// openings. With h openings it is a sphere with h handles.
#ifndef PHRENIC_SERVER_ANATOMY_DOUBLE_LAYER_H_
#define PHRENIC_SERVER_ANATOMY_DOUBLE_LAYER_H_

#include <functional>

#include "server/anatomy/sheet_mesh.h"

namespace phrenic::anatomy {

inline constexpr double kDiaphragmGap = 3;  // between the layers [mm]
inline constexpr double kBorderGap = 2.2;   // along the border and the openings, so that the edge is thin

// Of the upper layer, at a point of the plane; unit.
using SheetNormal = std::function<Eigen::Vector3d(const Eigen::Vector2d&)>;

// Where vertex i of the sheet lies in the double layer's mesh. Those that face each other come one after the other: a
// rigid link's ends, and what joins the layers, are then fetched together.
constexpr int UpperVertex(int i) { return 2 * i; }
constexpr int LowerVertex(int i) { return 2 * i + 1; }
constexpr bool IsUpper(int vertex) { return vertex % 2 == 0; }

// Without regions.
Mesh DoubleLayer(const Sheet& sheet, const SheetNormal& normal);

// From a vertex of the sheet to the nearest one of the loop.
double LoopDistance(const Sheet& sheet, const std::vector<int>& loop, int vertex);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_DOUBLE_LAYER_H_
