#include "server/anatomy/meshing/plane_delaunay.h"

#include <boost/polygon/voronoi.hpp>
#include <cmath>

namespace phrenic::anatomy {
namespace {

using Diagram = boost::polygon::voronoi_diagram<double>;
using GridPoint = boost::polygon::point_data<int>;

// Scales the points to integers, which Boost's exact predicates require.
std::vector<GridPoint> OnGrid(const std::vector<Eigen::Vector2d>& points) {
  constexpr double kGrid = 5e8;
  double extent = 1e-300;
  for (const Eigen::Vector2d& p : points) extent = std::max(extent, p.cwiseAbs().maxCoeff());
  std::vector<GridPoint> grid;
  grid.reserve(points.size());
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d scaled = p * (kGrid / extent);
    grid.emplace_back(static_cast<int>(std::lround(scaled.x())), static_cast<int>(std::lround(scaled.y())));
  }
  return grid;
}

// Returns the sites around a Voronoi vertex, in cyclic order: the corners of a Delaunay polygon.
std::vector<int> SitesAround(const Diagram::vertex_type& vertex) {
  std::vector<int> sites;
  const Diagram::edge_type* edge = vertex.incident_edge();
  do {
    sites.push_back(static_cast<int>(edge->cell()->source_index()));
    edge = edge->rot_next();
  } while (edge != vertex.incident_edge());
  return sites;
}

}  // namespace

Triangles PlaneDelaunay(const std::vector<Eigen::Vector2d>& points) {
  const std::vector<GridPoint> grid = OnGrid(points);
  Diagram diagram;
  boost::polygon::construct_voronoi(grid.begin(), grid.end(), &diagram);
  std::vector<Eigen::Vector3i> triangles;
  for (const Diagram::vertex_type& vertex : diagram.vertices()) {
    const std::vector<int> sites = SitesAround(vertex);
    for (size_t i = 2; i < sites.size(); ++i) {
      Eigen::Vector3i triangle(sites[0], sites[i - 1], sites[i]);
      const Eigen::Vector2d u = points[triangle[1]] - points[triangle[0]],
                            v = points[triangle[2]] - points[triangle[0]];
      if (u.x() * v.y() < u.y() * v.x()) std::swap(triangle[1], triangle[2]);
      triangles.push_back(triangle);
    }
  }
  Triangles result(3, static_cast<Eigen::Index>(triangles.size()));
  for (Eigen::Index t = 0; t < result.cols(); ++t) result.col(t) = triangles[static_cast<size_t>(t)];
  return result;
}

}  // namespace phrenic::anatomy
