// What is swept where the mediastinum is: a flat sheet between walls, with two lungs beside the middle.
#include "server/physiology/mediastinum.h"

#include <gtest/gtest.h>

namespace phrenic {
namespace {

using physiology::Mediastinum;

constexpr int kSquares = 20;
constexpr double kEdge = 0.01;

// Squares of two triangles in the plane z = 0 about the origin, that face upwards.
Mesh FlatSheet() {
  Mesh mesh;
  mesh.vertices.resize(3, (kSquares + 1) * (kSquares + 1));
  mesh.triangles.resize(3, 2 * kSquares * kSquares);
  const auto vertex = [](int i, int j) { return i + (kSquares + 1) * j; };
  for (int i = 0; i <= kSquares; ++i) {
    for (int j = 0; j <= kSquares; ++j) {
      mesh.vertices.col(vertex(i, j)) << kEdge * (i - kSquares / 2), kEdge * (j - kSquares / 2), 0;
    }
  }
  Eigen::Index t = 0;
  for (int i = 0; i < kSquares; ++i) {
    for (int j = 0; j < kSquares; ++j) {
      mesh.triangles.col(t++) << vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1);
      mesh.triangles.col(t++) << vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1);
    }
  }
  return mesh;
}

// A wall below the sheet's border, which takes no part.
Mesh LowWall() {
  Mesh mesh = FlatSheet();
  mesh.vertices.row(2).array() -= 0.1;
  return mesh;
}

// Rows of points over the sheet: on the mediastinum at x = +-0.03, on the rest of the lungs at x = +-0.07.
Mediastinum Middle() {
  Points boundary(3, 4 * kSquares);
  std::vector<bool> touches;
  for (int i = 0; i < 4 * kSquares; ++i) {
    const double x[] = {-0.07, -0.03, 0.03, 0.07};
    boundary.col(i) << x[i % 4], kEdge * (i / 4 - kSquares / 2 + 0.5), 0.01;
    touches.push_back(i % 4 == 1 || i % 4 == 2);
  }
  return {FlatSheet(), LowWall(), boundary, touches};
}

TEST(Mediastinum, IsSweptWhereItIsNearest) {
  const Mesh sheet = FlatSheet(), wall = LowWall();
  Points lowered = sheet.vertices;
  lowered.row(2).array() -= 0.02;
  const auto [right, left] = Middle().Swept(lowered, wall.vertices);
  const double expected = 0.05 * kSquares * kEdge * 0.02;  // to x = 0.05, half way between the rows
  EXPECT_NEAR(right, expected, 1e-12);
  EXPECT_NEAR(left, expected, 1e-12);
}

TEST(Mediastinum, GainsNothingAtRestOrSideways) {
  const Mesh sheet = FlatSheet(), wall = LowWall();
  Points aside = sheet.vertices, outwards = wall.vertices;
  aside.row(1).array() += 0.02;
  outwards.row(2).array() += 0.02;
  for (const double swept : Middle().Swept(sheet.vertices, wall.vertices)) EXPECT_EQ(swept, 0);
  for (const double swept : Middle().Swept(aside, wall.vertices)) EXPECT_NEAR(swept, 0, 1e-15);
  for (const double swept : Middle().Swept(sheet.vertices, outwards)) EXPECT_EQ(swept, 0);
}

// Its lower end follows the sheet below it alone.
TEST(Mediastinum, IsStretchedByTheSheetBelowIt) {
  const Mesh sheet = FlatSheet();
  Points lowered = sheet.vertices;
  for (auto vertex : lowered.colwise()) vertex.z() -= std::abs(vertex.x()) < 0.055 ? 0.02 : 0.1;
  const MediastinalMotion motion = Middle().Stretched(lowered, 0.25), rest = Middle().Stretched(sheet.vertices, 0);
  EXPECT_NEAR(motion.descent, 0.02, 1e-12);
  EXPECT_EQ(motion.narrowing, 0.25);
  EXPECT_NEAR(motion.bottom, 0, 1e-12);
  EXPECT_NEAR(motion.top, -0.1, 1e-12);
  EXPECT_EQ(rest.descent, 0);
}

}  // namespace
}  // namespace phrenic
