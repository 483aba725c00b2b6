// Near-uniform triangles over a curved sheet given as a map from the plane.
#ifndef PHRENIC_SERVER_ANATOMY_SHEET_MESH_H_
#define PHRENIC_SERVER_ANATOMY_SHEET_MESH_H_

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

struct SheetDomain {
  std::function<Eigen::Vector3d(const Eigen::Vector2d&)> map;  // smooth and one to one
  std::function<double(const Eigen::Vector3d&)> edge_length;   // aimed at that place; slowly varying
  std::vector<std::vector<Eigen::Vector2d>> loops;             // densely sampled: border first, then openings
};

struct Sheet {
  std::vector<Eigen::Vector2d> plane;
  std::vector<Eigen::Vector3d> points;  // map(plane)
  Triangles triangles;                  // anticlockwise in the plane
  std::vector<std::vector<int>> loops;  // vertex indices along each loop, evenly spaced on the surface
};

// Border vertices first, spaced by the edge length along each loop (at least eight a loop); then quasi-random points
// at least 0.8 edge lengths apart (a low-discrepancy sequence thinned by distance), triangulated in the plane, made
// Delaunay on the surface and relaxed to the area-weighted centroids of their triangles (as in centroidal Voronoi
// tessellation; Du, Faber and Gunzburger, SIAM Review 1999;41:637); at last numbered so that neighbours are near each
// other in memory. Deterministic.
Sheet MeshSheet(const SheetDomain& domain);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_SHEET_MESH_H_
