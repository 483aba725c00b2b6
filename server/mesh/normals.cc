#include "server/mesh/normals.h"

#include <Eigen/Geometry>

namespace phrenic {
namespace {

// Returns the triangle's normal times twice its area [m^2].
Eigen::Vector3d AreaNormal(const ConstPoints& vertices, const Eigen::Vector3i& corner) {
  const Eigen::Vector3d a = vertices.col(corner[0]);
  const Eigen::Vector3d b = vertices.col(corner[1]), c = vertices.col(corner[2]);
  return (b - a).cross(c - a);
}

}  // namespace

Points VertexNormals(const ConstPoints& vertices, const Triangles& triangles) {
  Points normals = Points::Zero(3, vertices.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3d normal = AreaNormal(vertices, triangles.col(t));
    for (int k = 0; k < 3; ++k) normals.col(triangles(k, t)) += normal;
  }
  for (Eigen::Index i = 0; i < normals.cols(); ++i) {
    const double length = normals.col(i).norm();
    if (length > 0) normals.col(i) /= length;
  }
  return normals;
}

Eigen::VectorXd VertexAreas(const ConstPoints& vertices, const Triangles& triangles) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(vertices.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const double third = AreaNormal(vertices, triangles.col(t)).norm() / 6;
    for (int k = 0; k < 3; ++k) areas[triangles(k, t)] += third;
  }
  return areas;
}

}  // namespace phrenic
