// The curvature of a thin sheet of triangles as a linear function of its dihedral angles: a Morley plate element
// without unknown rotations.
//
// Morley's element (1968) is linear along edges and quadratic in a triangle; its unknowns are the deflections of the
// vertices and the slope s_e across each edge e at its middle. With the slope g_T of the flat triangle T, its curvature
//   k_T = 1/A sum_e |e| (s_e - g_T) n n^T  [1/m],  n the normal of e in the plane of T, away from T,
// is constant. Here s_e is no unknown but a linear function of the dihedral angles around it, exact for every quadratic
// deflection: the two triangles of an edge share one slope, and s_e - g_T is a sum over the angles of the edge and of
// the four edges around its triangles, with the coefficients of least norm, measured in the unfolded plane. The
// deflections are thus a subspace of Morley's that contains quadratics to the order of the mesh size, on any mesh:
// curvatures converge at first order and deflections at second, as Morley's do. Slopes of quadratics alone (a patch of
// four triangles) or hinges alone do not converge on irregular meshes.
//
// The moment across a border edge is zero: its slope is the one of least energy. A held triangle does not turn: the
// slope of its edges is its own, so that a sheet is clamped where it continues in held triangles.
#ifndef PHRENIC_SERVER_MESH_PLATE_CURVATURE_H_
#define PHRENIC_SERVER_MESH_PLATE_CURVATURE_H_

#include <array>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

inline constexpr int kPlateHinges = 9;     // most edges on whose angle the curvature of a triangle depends
inline constexpr int kPlateVertices = 12;  // most vertices of their triangles

// The energy of a triangle of a plate of flexural rigidity D [N m] is D/2 |sum_i bend_i t_i|^2 [J], which equals
// D A/2 ((1 - nu) k:k + nu tr(k)^2); t_i is the dihedral angle of hinges[i] relative to rest [rad].
struct PlateTriangle {
  int triangle;                                    // of the mesh
  int count = 0;                                   // of hinges
  std::array<int, kPlateHinges> hinges{};          // indices in Plate::hinges
  Eigen::Matrix<double, 3, kPlateHinges> bend;     // one column per hinge; zero beyond `count`
  int vertex_count = 0;                            // of `vertices`
  std::array<int, kPlateVertices> vertices{};      // of all its hinges, each once
  std::array<Eigen::Vector4i, kPlateHinges> ends;  // vertices of each hinge, as indices in `vertices`
};

struct Plate {
  // Two triangles with area that share an edge: the two vertices of the edge in the winding of the first triangle, the
  // one opposite it in the first, the one in the second.
  std::vector<Eigen::Vector4i> hinges;
  std::vector<PlateTriangle> triangles;
};

// Returns the plate of the triangles that are `taken` (one per triangle) and turn. The angles of their neighbours enter
// whether taken or not. Left out are held triangles (all vertices `held`, one per vertex), those without area, and
// those without a neighbour. Triangles are neighbours across an edge of exactly two triangles of the same orientation.
// Requires: -1 < poissons_ratio < 1.
Plate MakePlate(const ConstPoints& vertices, const Triangles& triangles, const std::vector<bool>& held,
                const std::vector<bool>& taken, double poissons_ratio);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_PLATE_CURVATURE_H_
