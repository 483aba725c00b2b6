#include "server/mesh/plate_curvature.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <random>

#include "server/mesh/ellipsoid.h"

namespace phrenic {
namespace {

// A square of 1 m with 6 x 6 irregular cells.
Mesh IrregularSquare() {
  constexpr int kCells = 6;
  Mesh mesh;
  mesh.vertices.resize(3, (kCells + 1) * (kCells + 1));
  mesh.triangles.resize(3, 2 * kCells * kCells);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  for (int i = 0; i < mesh.vertices.cols(); ++i) {
    mesh.vertices.col(i) << (i % 7 + shift(random)) / kCells, (i / 7 + shift(random)) / kCells, 0;
  }
  for (int cell = 0; cell < kCells * kCells; ++cell) {
    const int a = cell / kCells * (kCells + 1) + cell % kCells, d = a + kCells + 1;
    mesh.triangles.col(2 * cell) << a, a + 1, d + 1;
    mesh.triangles.col(2 * cell + 1) << a, d + 1, d;
  }
  return mesh;
}

// The slope between the triangles of a hinge in a plane with the deflection w: their dihedral angle, to first order.
double AngleOf(const Points& x, const Eigen::Vector4i& hinge, const std::function<double(double, double)>& w) {
  const auto at = [&](int k) { return Eigen::Vector2d(x.col(hinge[k]).head<2>()); };
  const Eigen::Vector2d edge = at(1) - at(0);
  double angle = 0;
  for (int k = 2; k < 4; ++k) {
    const Eigen::Vector2d arm = at(k) - at(0);
    const double foot = edge.dot(arm) / edge.squaredNorm();
    const auto deflection = [&](int vertex) { return w(at(vertex).x(), at(vertex).y()); };
    angle += (deflection(k) - (1 - foot) * deflection(0) - foot * deflection(1)) / (arm - foot * edge).norm();
  }
  return angle;
}

std::vector<bool> All(Eigen::Index count, bool value) { return std::vector<bool>(static_cast<size_t>(count), value); }

TEST(PlateCurvature, OfAQuadraticDeflectionIsExactInsideAnIrregularSheet) {
  constexpr double kNu = 0.3, kXx = 0.7, kYy = -1.1, kXy = 0.4;
  const Mesh mesh = IrregularSquare();
  const Plate plate =
      MakePlate(mesh.vertices, mesh.triangles, All(mesh.vertices.cols(), false), All(mesh.triangles.cols(), true), kNu);
  const auto w = [](double x, double y) { return kXx * x * x / 2 + kYy * y * y / 2 + kXy * x * y + 3 * x - y + 5; };
  const double form = (1 - kNu) * (kXx * kXx + kYy * kYy + 2 * kXy * kXy) + kNu * std::pow(kXx + kYy, 2);
  int inside = 0;
  for (const PlateTriangle& triangle : plate.triangles) {
    if (triangle.count < kPlateHinges) continue;  // near the border, some of whose slopes are free
    ++inside;
    Eigen::Vector3d root = Eigen::Vector3d::Zero();
    for (int i = 0; i < triangle.count; ++i) {
      root += triangle.bend.col(i) * AngleOf(mesh.vertices, plate.hinges[triangle.hinges[i]], w);
    }
    Eigen::Matrix<double, 2, 3> x;
    for (int k = 0; k < 3; ++k) x.col(k) = mesh.vertices.col(mesh.triangles(k, triangle.triangle)).head<2>();
    Eigen::Matrix2d edges;
    edges << x.col(1) - x.col(0), x.col(2) - x.col(0);
    EXPECT_NEAR(root.squaredNorm(), std::abs(edges.determinant()) / 2 * form, 1e-12);
  }
  EXPECT_GT(inside, 20);
}

TEST(PlateCurvature, HasOneTriangleEachThatTurnsAndIsTaken) {
  const Mesh ball = EllipsoidSurface(Eigen::Vector3d::Zero(), {1, 2, 3}, 3, false);
  std::vector<bool> held = All(ball.vertices.cols(), false), taken = All(ball.triangles.cols(), true);
  const auto count = [&] { return MakePlate(ball.vertices, ball.triangles, held, taken, 0.3).triangles.size(); };
  EXPECT_EQ(count(), static_cast<size_t>(ball.triangles.cols()));
  for (const int vertex : ball.triangles.col(4)) held[vertex] = true;
  taken[9] = false;
  EXPECT_EQ(count(), static_cast<size_t>(ball.triangles.cols()) - 2);
}

// A moment that vanishes across two edges along t1 and t2 is a multiple of sym(t1 t2): the energy is that of its part
// in the curvature n n |e|/A t/2 of either triangle, whose area is 1/2.
TEST(PlateCurvature, OfTwoTrianglesDependsOnTheirOneAngle) {
  Points x(3, 4);
  x << 0, 1, 0.4, 0.6, 0, 0, 1, -1, 0, 0, 0, 0;
  Triangles triangles(3, 2);
  triangles << 0, 1, 1, 0, 2, 3;
  const Plate plate = MakePlate(x, triangles, All(4, false), All(2, true), 0);
  ASSERT_EQ(plate.hinges.size(), 1u);
  ASSERT_EQ(plate.triangles.size(), 2u);
  const Eigen::Vector2d first = Eigen::Vector2d(0.4, 1).normalized(), second = Eigen::Vector2d(0.6, -1).normalized();
  const double part = std::pow(first.y() * second.y(), 2) / ((1 + std::pow(first.dot(second), 2)) / 2);
  double form = 0;
  for (const PlateTriangle& triangle : plate.triangles) form += triangle.bend.col(0).squaredNorm();
  EXPECT_NEAR(form, part, 1e-12);
}

}  // namespace
}  // namespace phrenic
