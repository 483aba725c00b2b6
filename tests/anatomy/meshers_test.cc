// Mesh generators on shapes with known properties.
#include <gtest/gtest.h>

#include <map>

#include "server/anatomy/meshing/implicit_surface.h"
#include "server/anatomy/meshing/plane_delaunay.h"
#include "server/anatomy/meshing/plane_region.h"
#include "server/anatomy/meshing/spaced_points.h"
#include "server/anatomy/meshing/tube.h"
#include "server/anatomy/sheet_mesh.h"
#include "server/mesh/topology.h"
#include "tests/anatomy/parts.h"

namespace phrenic::anatomy {
namespace {

TEST(PlaneDelaunay, CircumcirclesAreEmpty) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 1; i <= 200; ++i) points.push_back(QuasiRandom(i));
  const Triangles triangles = PlaneDelaunay(points);
  EXPECT_GT(triangles.cols(), 350);
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector2d a = points[triangles(0, t)], b = points[triangles(1, t)], c = points[triangles(2, t)];
    Eigen::Matrix2d sides;
    sides << (b - a).transpose(), (c - a).transpose();
    EXPECT_GT(sides.determinant(), 0) << "anticlockwise";
    const Eigen::Vector2d centre =
        a + sides.inverse() * Eigen::Vector2d((b - a).squaredNorm() / 2, (c - a).squaredNorm() / 2);
    for (const Eigen::Vector2d& p : points) EXPECT_GE((p - centre).norm(), (a - centre).norm() * (1 - 1e-6));
  }
}

TEST(PlaneDelaunay, CocircularPointsBecomeAFan) {
  const Triangles triangles = PlaneDelaunay({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  EXPECT_EQ(triangles.cols(), 2);
}

TEST(PlaneRegion, HolesAreOutside) {
  const PlaneRegion region({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{1, 1}, {1, 2}, {2, 2}, {2, 1}}});
  EXPECT_TRUE(region.Contains({3, 3}));
  EXPECT_FALSE(region.Contains({1.5, 1.5}));
  EXPECT_FALSE(region.Contains({5, 1}));
  EXPECT_FALSE(region.Contains({3, -1}));
}

TEST(SpacedPoints, KeepTheMinimumDistance) {
  SpacedPoints points(0.1, 1, 0.1);
  std::vector<Eigen::Vector3d> kept;
  for (int i = 1; i < 2000; ++i) {
    const Eigen::Vector2d p = QuasiRandom(i);
    const Eigen::Vector3d x(p.x(), p.y(), 0);
    if (points.TryAdd(x, 0.1)) kept.push_back(x);
  }
  EXPECT_GT(kept.size(), 60u);
  for (size_t i = 0; i < kept.size(); ++i) {
    for (size_t j = 0; j < i; ++j) EXPECT_GE((kept[i] - kept[j]).norm(), 0.1);
  }
}

// A half cylinder of radius 1 with a round hole; the map is an isometry.
TEST(SheetMesh, MeshesACurvedSheetUniformly) {
  SheetDomain domain;
  domain.map = [](const Eigen::Vector2d& p) { return Eigen::Vector3d(std::sin(p.x()), std::cos(p.x()), p.y()); };
  domain.edge_length = [](const Eigen::Vector3d&) { return 0.1; };
  std::vector<Eigen::Vector2d> hole;
  for (int i = 0; i < 90; ++i) hole.emplace_back(0.4 * std::cos(i * M_PI / 45), 0.4 * std::sin(i * M_PI / 45));
  domain.loops = {{{-1.5, -1}, {1.5, -1}, {1.5, 1}, {-1.5, 1}}, hole};
  const Sheet sheet = MeshSheet(domain);
  Mesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(sheet.points.size()));
  for (size_t i = 0; i < sheet.points.size(); ++i) mesh.vertices.col(static_cast<Eigen::Index>(i)) = sheet.points[i];
  mesh.triangles = sheet.triangles;
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_EQ(topology.boundary_edges, static_cast<int>(sheet.loops[0].size() + sheet.loops[1].size()));
  EXPECT_EQ(topology.non_manifold_edges, 0);
  EXPECT_EQ(topology.vertices - topology.edges + topology.triangles, 0) << "an annulus";
  EXPECT_GT(SmallestAngle(mesh), 25);
  double area = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) area += Area(mesh, t);
  EXPECT_NEAR(area, 6 - 0.16 * M_PI, 0.03);
}

TEST(ImplicitSurface, SphereIsRoundClosedAndUniform) {
  const Field sphere = [](const Eigen::Vector3d& x) { return x.norm() - 20; };
  const Mesh mesh = ImplicitSurface(sphere, {Eigen::Vector3d::Constant(-25), Eigen::Vector3d::Constant(25)}, 3, 3);
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_TRUE(topology.watertight());
  EXPECT_EQ(topology.genus(), 0);
  EXPECT_GT(SmallestAngle(mesh), 28);
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) EXPECT_NEAR(mesh.vertices.col(i).norm(), 20, 0.02);
  EXPECT_NEAR(SignedVolume(mesh.vertices, mesh.triangles), 4 / 3.0 * M_PI * 8000, 600);
}

TEST(ImplicitSurface, TorusKeepsItsHandle) {
  const Field torus = [](const Eigen::Vector3d& x) { return std::hypot(std::hypot(x.x(), x.y()) - 20, x.z()) - 6; };
  const Mesh mesh = ImplicitSurface(torus, {{-30, -30, -10}, {30, 30, 10}}, 4, 2);
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_TRUE(topology.watertight());
  EXPECT_EQ(topology.genus(), 1);
}

TEST(Tube, StraightTubeHasTheCylindersVolume) {
  const auto section = [](double, const Eigen::Vector3d&) { return TubeSection{5, 5, Eigen::Vector3d::UnitY()}; };
  const Mesh mesh = Tube({.through = {{0, 0, 0}, {50, 0, 0}, {100, 0, 0}}, .section = section}, 1);
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_TRUE(topology.watertight());
  EXPECT_EQ(topology.genus(), 0);
  const double volume = SignedVolume(mesh.vertices, mesh.triangles);
  EXPECT_GT(volume, 0.97 * M_PI * 25 * 100);
  EXPECT_LT(volume, M_PI * 25 * (100 + 4 / 3.0 * 5)) << "no more than with half spheres at its ends";
}

// Rings turned against each other make an outline scalloped like a rope.
TEST(Tube, StraightTubeHasStraightOutlines) {
  const auto section = [](double, const Eigen::Vector3d&) { return TubeSection{6, 3, Eigen::Vector3d::UnitY(), 0.2}; };
  const Mesh mesh = Tube({.through = {{0, 0, 0}, {50, 0, 0}, {100, 0, 0}},
                          .section = section,
                          .first = TubeEnd::kStraight,
                          .last = TubeEnd::kStraight},
                         4);
  std::map<std::pair<long, long>, int> lines;  // by the position across
  for (const auto& x : mesh.vertices.colwise()) ++lines[{std::lround(1e6 * x.y()), std::lround(1e6 * x.z())}];
  std::vector<int> counts;
  for (const auto& [across, count] : lines) counts.push_back(count);
  std::sort(counts.rbegin(), counts.rend());
  ASSERT_GE(counts.size(), 10u);
  EXPECT_GT(counts[9], 19) << "at least ten lines of vertices from end to end";
}

TEST(Tube, StraightEndsOfTwoTubesMeet) {
  const auto section = [](double, const Eigen::Vector3d&) { return TubeSection{6, 3, Eigen::Vector3d::UnitY(), 0.2}; };
  const Mesh first = Tube({.through = {{0, 0, 0}, {30, 0, 0}}, .section = section, .last = TubeEnd::kStraight}, 4);
  const Mesh next = Tube({.through = {{30, 0, 0}, {70, 20, 0}},
                          .section = section,
                          .first = TubeEnd::kStraight,
                          .start = Eigen::Vector3d::UnitX()},
                         4);
  int met = 0;
  for (const auto& x : first.vertices.colwise()) {
    if ((next.vertices.colwise() - x).colwise().norm().minCoeff() < 1e-9) ++met;
  }
  EXPECT_GE(met, 10);
}

TEST(Field, EllipsoidIsNearlyADistance) {
  const Eigen::Vector3d centre(3, -2, 5), radii(30, 20, 10);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
    EXPECT_NEAR(Ellipsoid(centre + radii[k] * axis, centre, radii), 0, 1e-12);
    EXPECT_NEAR(Ellipsoid(centre + (radii[k] + 1) * axis, centre, radii), 1, 0.01);
    EXPECT_NEAR(Ellipsoid(centre + (radii[k] - 1) * axis, centre, radii), -1, 0.01);
  }
  EXPECT_LT(Ellipsoid(centre, centre, radii), -5) << "and finite in the middle";
}

TEST(Tube, MirrorImageFacesOutwards) {
  const auto section = [](double, const Eigen::Vector3d&) { return TubeSection{5, 3, Eigen::Vector3d::UnitY()}; };
  const Mesh mesh = Mirrored(Tube({.through = {{10, 0, 0}, {50, 8, 0}, {80, 30, 5}}, .section = section}, 2));
  EXPECT_GT(SignedVolume(mesh.vertices, mesh.triangles), 0);
  EXPECT_TRUE(AnalyseTopology(mesh).watertight());
  EXPECT_LT(mesh.vertices.row(0).maxCoeff(), 0);
}

TEST(SmoothCurve, HasItsEndPointsAndEqualSteps) {
  const Curve curve = SmoothCurve({{0, 0, 0}, {10, 5, 0}, {30, 0, 0}, {31, -8, 4}}, 40);
  ASSERT_EQ(curve.size(), 40u);
  EXPECT_LT((curve.front() - Eigen::Vector3d(0, 0, 0)).norm(), 1e-12);
  EXPECT_LT((curve.back() - Eigen::Vector3d(31, -8, 4)).norm(), 1e-12);
  const double step = Length(curve) / 39;
  for (size_t i = 1; i < curve.size(); ++i) EXPECT_NEAR((curve[i] - curve[i - 1]).norm(), step, 0.05 * step);
}

}  // namespace
}  // namespace phrenic::anatomy
