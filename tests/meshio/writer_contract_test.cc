// The contract of every writer: round trips, and conversion between any two formats. Formats come from the catalogue;
// one that loses part of a mesh also needs a line in KeepsAll.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "server/mesh/ellipsoid.h"
#include "server/meshio/formats.h"

namespace phrenic::meshio {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> Written() {
  std::vector<std::string> endings;
  for (const Format& format : Formats()) {
    if (format.write != nullptr) endings.emplace_back(format.ending);
  }
  return endings;
}

// True for formats that keep float64 precision, the order of vertices, unused vertices and networks of edges.
bool KeepsAll(const std::string& ending) { return ending != ".stl"; }

// Returns a closed surface whose coordinates use all digits and whose vertices are ordered by first use.
Mesh ManyDigits() {
  const Mesh plain = EllipsoidSurface({0.1, 0.2, 0.3}, {1.0 / 3, 2.0 / 7, 0.1}, 5, false);
  Mesh mesh = plain;
  std::vector<int> renumbered(static_cast<std::size_t>(plain.vertices.cols()), -1);
  int next = 0;
  for (int& corner : mesh.triangles.reshaped()) {
    int& number = renumbered[static_cast<std::size_t>(corner)];
    if (number < 0) {
      mesh.vertices.col(next) = plain.vertices.col(corner);
      number = next++;
    }
    corner = number;
  }
  return mesh;
}

Mesh RoundTrip(const Mesh& mesh, const std::string& ending, double unit = 1) {
  const auto bytes = Write("a" + ending, mesh, unit);
  EXPECT_TRUE(bytes.ok()) << bytes.status();
  const auto parsed = bytes.ok() ? Parse("a" + ending, *bytes, unit) : bytes.status();
  EXPECT_TRUE(parsed.ok()) << ending << parsed.status();
  return parsed.ok() ? *parsed : Mesh{};
}

class Pair : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(Pair, ConversionLosesOnlyTheFormatsPrecision) {
  const auto& [first, second] = GetParam();
  const Mesh mesh = ManyDigits();
  const Mesh result = RoundTrip(RoundTrip(mesh, first), second);
  ASSERT_EQ(result.vertices.cols(), mesh.vertices.cols());
  EXPECT_EQ(result.triangles, mesh.triangles);
  if (KeepsAll(first) && KeepsAll(second)) {
    EXPECT_EQ(result.vertices, mesh.vertices) << "every bit";
  } else {
    EXPECT_EQ(result.vertices, mesh.vertices.cast<float>().cast<double>()) << "float32, rounded once";
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Pair,
                         ::testing::Combine(::testing::ValuesIn(Written()), ::testing::ValuesIn(Written())),
                         [](const auto& pair) {
                           return std::get<0>(pair.param).substr(1) + "_" + std::get<1>(pair.param).substr(1);
                         });

class Writer : public ::testing::TestWithParam<std::string> {};

TEST_P(Writer, UnitsRoundTrip) {
  const Mesh mesh = ManyDigits(), result = RoundTrip(mesh, GetParam(), 0.001);
  ASSERT_EQ(result.vertices.cols(), mesh.vertices.cols());
  const double digits = KeepsAll(GetParam()) ? 1e-15 : 1e-7;
  EXPECT_LT((result.vertices - mesh.vertices).cwiseAbs().maxCoeff(), digits);
}

TEST_P(Writer, UnusedVerticesAndNetworksAreKeptOrRejected) {
  Mesh wire;
  wire.vertices = Points::Random(3, 4);
  wire.edges.resize(2, 2);
  wire.edges << 0, 3, 2, 0;
  if (!KeepsAll(GetParam())) {
    const auto rejected = Write("a" + GetParam(), wire, 1);
    EXPECT_EQ(rejected.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(rejected.status().message()), HasSubstr("only edges"));
    return;
  }
  const Mesh result = RoundTrip(wire, GetParam());
  EXPECT_EQ(result.vertices, wire.vertices);
  EXPECT_EQ(result.edges, wire.edges);
}

TEST_P(Writer, InvalidMeshesAreRejectedWithTheFilesName) {
  Mesh mesh = ManyDigits();
  mesh.vertices(1, 3) = NAN;
  const auto not_finite = Write("a" + GetParam(), mesh, 1);
  EXPECT_EQ(not_finite.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(not_finite.status().message()), StartsWith("a" + GetParam() + ": vertex 3"));
  mesh = ManyDigits();
  mesh.triangles.resize(3, 0);
  EXPECT_THAT(std::string(Write("a" + GetParam(), mesh, 1).status().message()), HasSubstr("neither triangles nor"));
}

INSTANTIATE_TEST_SUITE_P(Formats, Writer, ::testing::ValuesIn(Written()),
                         [](const auto& ending) { return ending.param.substr(1); });

TEST(Writers, MshKeepsRegions) {
  Mesh mesh = ManyDigits();
  mesh.regions["rim"] = {mesh.triangles(0, 5), mesh.triangles(1, 5), mesh.triangles(2, 5)};
  std::sort(mesh.regions["rim"].begin(), mesh.regions["rim"].end());
  EXPECT_EQ(RoundTrip(mesh, ".msh").regions, mesh.regions);
}

TEST(Writers, MshKeepsRegionsThatOverlapOrHaveNoTriangle) {
  Mesh mesh = ManyDigits();
  std::set<int> two(mesh.triangles.col(4).begin(), mesh.triangles.col(4).end());
  two.insert(mesh.triangles.col(5).begin(), mesh.triangles.col(5).end());
  mesh.regions["all"].resize(static_cast<std::size_t>(mesh.vertices.cols()));
  std::iota(mesh.regions["all"].begin(), mesh.regions["all"].end(), 0);
  mesh.regions["border"] = {0, 2};
  mesh.regions["two"] = {two.begin(), two.end()};
  EXPECT_EQ(RoundTrip(mesh, ".msh").regions, mesh.regions);
}

TEST(Writers, RejectCoordinatesThatReadersReject) {
  Mesh mesh = ManyDigits();
  mesh.vertices(0, 0) = 1e39;
  for (const std::string ending : {".obj", ".msh", ".stl", ".ply", ".vtk", ".vtp"}) {
    EXPECT_THAT(std::string(Write("a" + ending, mesh, 1).status().message()), HasSubstr("at most 1e+09")) << ending;
  }
}

TEST(Writers, FilesDeclareTheirFrame) {
  for (const std::string ending : {".obj", ".stl", ".ply", ".vtk", ".vtp"}) {
    const auto bytes = Write("a" + ending, ManyDigits(), 1);
    ASSERT_TRUE(bytes.ok()) << bytes.status();
    EXPECT_EQ(ParseSurface("a" + ending, *bytes, 1)->frame, Frame::kLps) << ending;
  }
}

TEST(Writers, UnknownExtensionsGiveTheListOfKnownOnes) {
  const auto unknown = Write("a.stp", ManyDigits(), 1);
  EXPECT_EQ(unknown.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(unknown.status().message()), HasSubstr(WrittenEndings()));
}

}  // namespace
}  // namespace phrenic::meshio
