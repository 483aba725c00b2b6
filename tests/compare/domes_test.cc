#include "server/compare/domes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/compare/surfaces.h"

namespace phrenic::compare {
namespace {

// A sheet 200 mm wide with two summits: 40 mm high at x = -60 mm, and `left` [m] high at x = 60 mm.
Mesh Domes(double left) {
  Mesh mesh = Moved(Square(0.2, 80), {-0.1, 0, 0});
  for (auto x : mesh.vertices.colwise()) {
    const auto bump = [&](double centre, double height) {
      return height * std::exp(-std::pow((x.x() - centre) / 0.03, 2) - std::pow((x.y() - 0.1) / 0.05, 2));
    };
    x.z() = bump(-0.06, 0.04) + bump(0.06, left);
  }
  std::vector<int>& whole = mesh.regions["diaphragm"];
  whole.resize(static_cast<std::size_t>(mesh.vertices.cols()));
  std::iota(whole.begin(), whole.end(), 0);
  return mesh;
}

std::optional<double> SaddleOf(const Mesh& mesh) { return FindSaddle(mesh, mesh.regions.at("diaphragm")); }

TEST(Domes, OfEqualHeightHaveTheirSaddleInTheMiddle) {
  const auto saddle = SaddleOf(Domes(0.04));
  ASSERT_TRUE(saddle.has_value());
  EXPECT_NEAR(*saddle, 0, 4e-3);
}

TEST(Domes, TheSaddleMovesTowardsTheLowerDome) {
  const auto saddle = SaddleOf(Domes(0.01));
  ASSERT_TRUE(saddle.has_value());
  EXPECT_GT(*saddle, 4e-3);
  EXPECT_LT(*saddle, 0.05);
}

// A ridge in front hides the saddle in the silhouette, not in the section through the summits.
TEST(Domes, ARidgeInFrontHidesNoSaddle) {
  Mesh mesh = Domes(0.04);
  for (auto x : mesh.vertices.colwise()) x.z() += 0.039 * std::exp(-std::pow(x.y() / 0.02, 2));
  const auto saddle = SaddleOf(mesh);
  ASSERT_TRUE(saddle.has_value());
  EXPECT_NEAR(*saddle, 0, 4e-3);
}

TEST(Domes, OneSummitHasNoSaddle) {
  EXPECT_EQ(SaddleOf(Domes(0)), std::nullopt);
  Mesh empty = Domes(0);
  EXPECT_EQ(FindSaddle(empty, {}), std::nullopt);
}

TEST(Domes, AreTheVerticesOnEitherSideAndTheLeftIsPlusX) {
  Mesh a = Domes(0.04), b = Moved(Domes(0.04), {0.01, 0, 0});
  AddDomes(a, b);
  const double saddle = *SaddleOf(a);
  for (const Mesh* mesh : {&a, &b}) {
    const auto &left = mesh->regions.at("left dome"), &right = mesh->regions.at("right dome");
    EXPECT_EQ(left.size() + right.size(), mesh->regions.at("diaphragm").size());
    for (const int i : left) EXPECT_GT(mesh->vertices(0, i), saddle) << "one saddle for both";
    for (const int i : right) EXPECT_LE(mesh->vertices(0, i), saddle);
  }
}

TEST(Domes, AreOnlyForDiaphragmsAndKeepExistingRegions) {
  Mesh a = Domes(0.04), other = Domes(0.04);
  other.regions.clear();
  AddDomes(a, other);
  EXPECT_EQ(a.regions.size(), 1U);
  EXPECT_TRUE(other.regions.empty());
  Mesh own = Domes(0.04);
  own.regions["left dome"] = {7};
  AddDomes(a, own);
  EXPECT_THAT(own.regions.at("left dome"), testing::ElementsAre(7));
}

}  // namespace
}  // namespace phrenic::compare
