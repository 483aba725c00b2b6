// Near-uniform triangulation of a curved sheet that is given as a map from a plane region.
#ifndef PHRENIC_SERVER_ANATOMY_SHEET_MESH_H_
#define PHRENIC_SERVER_ANATOMY_SHEET_MESH_H_

#include <Eigen/Core>
#include <functional>
#include <utility>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

struct SheetDomain {
  std::function<Eigen::Vector3d(const Eigen::Vector2d&)> map;  // smooth and injective
  std::function<double(const Eigen::Vector3d&)> edge_length;   // target at a surface point; slowly varying
  std::vector<std::vector<Eigen::Vector2d>> loops;             // densely sampled: outer boundary, then openings
};

struct Sheet {
  std::vector<Eigen::Vector2d> plane;
  std::vector<Eigen::Vector3d> points;  // map(plane)
  Triangles triangles;                  // counter-clockwise in the plane
  std::vector<std::vector<int>> loops;  // vertex indices along each boundary loop, evenly spaced on the surface
};

// Meshes a sheet:
//   1. boundary vertices, one edge length apart along each loop (at least eight per loop);
//   2. interior points from a low-discrepancy sequence, at least 0.8 edge lengths apart;
//   3. a Delaunay triangulation in the plane, restricted to the region;
//   4. 30 rounds of Delaunay flips on the surface and relaxation to the area-weighted centroid (as in centroidal
//   Voronoi
//      tessellation; Du, Faber and Gunzburger, SIAM Review 1999;41:637);
//   5. renumbering so that neighbours are close in memory.
// Deterministic.
Sheet MeshSheet(const SheetDomain& domain);

// Returns the directed edges of all boundary loops, in the winding of their triangles.
std::vector<std::pair<int, int>> BoundaryEdges(const Sheet& sheet);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_SHEET_MESH_H_
