#include "server/mesh/normals.h"

#include <gtest/gtest.h>

#include "tests/mesh/solids.h"

namespace phrenic {
namespace {

TEST(Normals, AreUnitAndPointOutwards) {
  const Mesh torus = Torus(2, 0.5, 60, 30);
  const Points normals = VertexNormals(torus.vertices, torus.triangles);
  for (Eigen::Index i = 0; i < normals.cols(); ++i) {
    const Eigen::Vector3d x = torus.vertices.col(i);
    const Eigen::Vector3d ring = 2 * Eigen::Vector3d(x[0], x[1], 0).normalized();
    EXPECT_NEAR(normals.col(i).norm(), 1, 1e-12);
    EXPECT_GT(normals.col(i).dot((x - ring).normalized()), 0.99) << "vertex " << i;
  }
}

TEST(Normals, AreWeightedByTriangleArea) {
  // At vertex 0: a triangle facing +z, and one with a hundredth of its area facing +x.
  Mesh mesh;
  mesh.vertices.resize(3, 5);
  mesh.vertices << 0, 1, 0, 0, 0, 0, 0, 1, 0.1, 0, 0, 0, 0, 0, 0.1;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 0, 1, 3, 2, 4;
  const Eigen::Vector3d expected = Eigen::Vector3d(0.01, 0, 1).normalized();
  EXPECT_LT((VertexNormals(mesh.vertices, mesh.triangles).col(0) - expected).norm(), 1e-12);
}

TEST(Normals, AreZeroAtUnusedVertices) {
  Mesh mesh = Tetrahedron();
  mesh.vertices.conservativeResize(3, 5);
  mesh.vertices.col(4) << 1, 2, 3;
  EXPECT_EQ(VertexNormals(mesh.vertices, mesh.triangles).col(4), Eigen::Vector3d::Zero());
}

TEST(Areas, SumToTheSurfaceArea) {
  const Mesh tetrahedron = Tetrahedron();
  EXPECT_NEAR(VertexAreas(tetrahedron.vertices, tetrahedron.triangles).sum(), 1.5 + std::sqrt(3.0) / 2, 1e-12);
}

TEST(Areas, AreAThirdOfTheIncidentTriangles) {
  const Mesh tetrahedron = Tetrahedron();
  const Eigen::VectorXd areas = VertexAreas(tetrahedron.vertices, tetrahedron.triangles);
  EXPECT_NEAR(areas[0], 0.5, 1e-12);  // three right triangles of 0.5 m^2
  EXPECT_NEAR(areas[1], (1 + std::sqrt(3.0) / 2) / 3, 1e-12);
}

}  // namespace
}  // namespace phrenic
