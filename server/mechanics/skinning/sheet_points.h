// Where the vertices of a sheet's layers are that follow its middle surface (sheet_skin.h).
//
//   x = sum_i b_i x_i + (H / J) n,   n = sum_i b_i n_i / |sum_i b_i n_i|,   J = sum_i b_i J_i
//
// over the corners of the vertex' triangle: b its weights, H its height at rest [m], n_i the unit vertex normals and
// J_i the area stretches of the deformed middle surface, the area of all triangles at the vertex over that at rest. So
// the sheet has the thickness h = h0 / J: thickness times area is conserved (tissue is incompressible), and a vertex
// keeps its share s = 2 H / h0 of the thickness. n and J are continuous, also across edges, and so is x. Rigid motions
// are followed exactly, and so are uniform stretches in the plane of a flat sheet. A sheet thickens at most eightfold
// (J counts as 1/8 below that), so that triangles that collapse stay finite. The layers do not cross as long as the
// middle surface has a radius of curvature above h / 2.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_POINTS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_POINTS_H_

#include <span>

#include "server/mechanics/eval_context.h"
#include "server/mechanics/skin.h"

namespace phrenic {

// Sets x to the positions of the vertices that are bound to the sheet [m], 3 x bindings. Uses the context's scratch
// memory. Thread-safe, for threads with scratch memory of their own.
void PlaceOnSheet(const DriverSheet& sheet, std::span<const TriangleBinding> bindings, const EvalContext& at,
                  MutablePoints x);

// Also sets v to their velocities [m/s], the exact time derivative of x.
void MoveOnSheet(const DriverSheet& sheet, std::span<const TriangleBinding> bindings, const EvalContext& at,
                 MutablePoints x, MutablePoints v);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_POINTS_H_
