#include "server/anatomy/physique.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "server/anatomy/dimensions.h"
#include "server/mechanics/breathing/wall_grid.h"
#include "server/mesh/self_crossings.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"
#include "server/schema/physique.h"
#include "server/schema/schema.h"
#include "tests/anatomy/parts.h"

namespace phrenic::anatomy {
namespace {

using testing::HasSubstr;

v1::Generated WithPhysique(const v1::Physique& physique, double resolution_mm = 0,
                           v1::Sheet sheet = v1::SHEET_UNSPECIFIED) {
  v1::Generated shape;
  if (resolution_mm > 0) shape.set_resolution_mm(resolution_mm);
  shape.set_sheet(sheet);
  *shape.mutable_physique() = physique;
  return shape;
}

v1::Physique Read(const std::string& text) {
  v1::Physique physique;
  EXPECT_TRUE(schema::ParseText("physique", text, &physique).ok()) << text;
  return physique;
}

// Each parameter at its ends, and all together at ends that bend the most.
std::vector<std::string> Extremes() {
  std::vector<std::string> texts;
  const auto* descriptor = v1::Physique::descriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    if (!descriptor->field(i)->options().HasExtension(v1::quantity)) continue;  // sex
    const auto& quantity = descriptor->field(i)->options().GetExtension(v1::quantity);
    for (const double end : {quantity.minimum(), quantity.maximum()}) {
      texts.push_back(descriptor->field(i)->name() + ": " + std::to_string(end));
    }
  }
  texts.push_back(
      "scoliosis_degrees: 50 kyphosis_degrees: 40 rib_slope_degrees: -12 chest_depth: 1.4 right_dome_height: -0.025");
  texts.push_back(
      "scoliosis_degrees: -50 kyphosis_degrees: -20 rib_slope_degrees: 8 chest_width: 0.8 left_dome_height: 0.02");
  texts.push_back(
      "scoliosis_degrees: 50 kyphosis_degrees: 40 rib_slope_degrees: 8 height: 1.2 left_dome_height: -0.025");
  texts.push_back("sex: SEX_FEMALE");
  texts.push_back("sex: SEX_FEMALE age: 90 barrel_chest: 1 scoliosis_degrees: -50 height: 1.2");
  return texts;
}

// Calls `visit` with points in and around the adult's cage [mm].
template <typename Visit>
void ForEachPlace(const Visit& visit) {
  for (double z = -20; z <= 405; z += 17) {
    for (double x = -140; x <= 140; x += 14) {
      for (double y = -125; y <= 155; y += 14) visit(Eigen::Vector3d(x, y, z));
    }
  }
}

double Determinant(const PhysiqueMap& map, const Eigen::Vector3d& at) {
  constexpr double kStep = 1e-3;
  Eigen::Matrix3d slopes;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
    slopes.col(i) = (map(at + step) - map(at - step)) / (2 * kStep);
  }
  return slopes.determinant();
}

// Returns the angle in the frontal plane between the thoracic vertebrae that are inclined the most, by the axes of
// their bodies [degrees].
double CobbAngle(const PhysiqueMap& map) {
  double least = 1e9, greatest = -1e9;
  for (int number = 1; number <= 12; ++number) {
    const double z = BodyOfVertebra(number).Middle(), y = SpineFront(z) + 10;
    const Eigen::Vector3d across = map({10, y, z}) - map({-10, y, z});
    const double inclination = std::atan2(across.z(), across.x()) * 180 / M_PI;
    least = std::min(least, inclination), greatest = std::max(greatest, inclination);
  }
  return greatest - least;
}

// Returns how the spine's front is inclined backwards at a height [degrees].
double Inclination(const PhysiqueMap& map, double z) {
  const Eigen::Vector3d up = map({0, SpineFront(z + 2), z + 2}) - map({0, SpineFront(z - 2), z - 2});
  return std::atan2(up.y(), up.z()) * 180 / M_PI;
}

TEST(Physique, OfAnAdultChangesNothing) {
  const v1::Anatomy rib = Part(v1::STRUCTURE_RIB, 5, v1::SIDE_LEFT);
  const auto mesh = Generate(rib, WithPhysique(Read("height: 1.75 scoliosis_degrees: 0")));
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(mesh->vertices, MeshOf(rib).vertices);
}

TEST(Physique, IsOneToOneAtItsExtremes) {
  for (const std::string& text : Extremes()) {
    const v1::Physique physique = Read(text);
    const PhysiqueMap map(physique);
    const v1::Physique full = schema::CompletePhysique(physique);
    const double scale = std::pow(full.height() / 1.75, 3) * full.chest_width() * full.chest_depth();
    double least = 1e9;
    ForEachPlace([&](const Eigen::Vector3d& at) { least = std::min(least, Determinant(map, at) / scale); });
    EXPECT_GT(least, 0.15) << text;
  }
}

TEST(Physique, SurfacesStayClosedAndDoNotCrossThemselves) {
  const v1::Anatomy parts[] = {Part(v1::STRUCTURE_RIB, 2, v1::SIDE_LEFT), Part(v1::STRUCTURE_RIB, 8, v1::SIDE_RIGHT),
                               Part(v1::STRUCTURE_VERTEBRA, 8), Part(v1::STRUCTURE_LUNG, 0, v1::SIDE_LEFT),
                               Part(v1::STRUCTURE_DIAPHRAGM)};
  for (const std::string& text : Extremes()) {
    const PhysiqueMap map(Read(text));
    for (const v1::Anatomy& part : parts) {
      Mesh mesh = MeshOf(part, 8);
      for (auto vertex : mesh.vertices.colwise()) vertex = kMillimetre * map(vertex / kMillimetre);
      EXPECT_GT(SignedVolume(mesh.vertices, mesh.triangles), 0) << text;
      EXPECT_EQ(SelfCrossings(mesh, 8 * kMillimetre), 0) << text << " of " << v1::Structure_Name(part.structure());
    }
  }
}

TEST(Physique, TheInnerCageStaysAGridWithHorizontalRowsThatHoldsTheSheet) {
  for (const std::string& text : Extremes()) {
    const auto cage = Generate(Part(v1::STRUCTURE_INNER_CAGE), WithPhysique(Read(text), 8));
    ASSERT_TRUE(cage.ok());
    const auto grid = WallGrid::Find(cage->vertices);
    ASSERT_TRUE(grid.ok()) << text << ": " << grid.status();
    // As high as the sheet lies against it.
    EXPECT_GT(cage->vertices(2, (grid->star_rows() - 1) * grid->columns()), 0.08) << text;
  }
}

TEST(Physique, TheMiddleSheetIsInsideTheInnerCageOfThePerson) {
  const v1::Physique physique = Read("scoliosis_degrees: 40 kyphosis_degrees: 20 rib_slope_degrees: -6");
  const auto cage = Generate(Part(v1::STRUCTURE_INNER_CAGE), WithPhysique(physique));
  const auto sheet = Generate(Part(v1::STRUCTURE_DIAPHRAGM), WithPhysique(physique, 6.5, v1::SHEET_MIDDLE));
  ASSERT_TRUE(cage.ok() && sheet.ok());
  const auto grid = WallGrid::Find(cage->vertices);
  ASSERT_TRUE(grid.ok());
  int outside = 0;
  for (const auto x : sheet->vertices.colwise()) {
    const PolarPoint at = grid->Polar(x);
    const GridCoordinates place =
        grid->Locate(cage->vertices, at.azimuth, at.z, grid->Guess(cage->vertices, at.azimuth, at.z));
    if (place.row < grid->star_rows() - 1 && at.radius > grid->Polar(grid->At(cage->vertices, place)).radius + 1e-3) {
      ++outside;
    }
  }
  EXPECT_EQ(outside, 0);
}

TEST(Physique, TheCobbAngleIsTheOneAskedFor) {
  for (const double cobb : {-50.0, -20.0, 10.0, 30.0, 50.0}) {
    const PhysiqueMap map(Read("scoliosis_degrees: " + std::to_string(cobb)));
    EXPECT_NEAR(CobbAngle(map), std::abs(cobb), 1 + 0.06 * std::abs(cobb)) << cobb;
    const double z = BodyOfVertebra(8).Middle();
    const Eigen::Vector3d apex = map({0, SpineFront(z), z});
    EXPECT_LT(apex.x() * cobb, 0) << "convex to the right for positive angles";
  }
}

TEST(Physique, TheHumpIsBehindTheConvexSide) {
  const PhysiqueMap map(Read("scoliosis_degrees: 40"));
  const double right = map({-90, 90, 250}).y(), left = map({90, 90, 250}).y();
  EXPECT_GT(right, left + 15);
}

TEST(Physique, KyphosisIsAddedToTheAdults) {
  constexpr double kLower = 174, kUpper = 322;  // where it inclines the spine the most [mm]
  const auto kyphosis = [&](const PhysiqueMap& map) { return Inclination(map, kLower) - Inclination(map, kUpper); };
  for (const double more : {-20.0, 20.0, 40.0}) {
    EXPECT_NEAR(kyphosis(PhysiqueMap(Read("kyphosis_degrees: " + std::to_string(more)))),
                kyphosis(PhysiqueMap({})) + more, 0.1 * std::abs(more));
  }
}

TEST(Physique, HeightWidthAndDepthScale) {
  const PhysiqueMap map(Read("height: 1.4 chest_width: 1.1 chest_depth: 0.9"));
  EXPECT_TRUE(map({10, 20, 30}).isApprox(0.8 * Eigen::Vector3d(11, 18, 30), 1e-12));
}

TEST(Physique, ADomeIsRaisedAloneAndTheRimStays) {
  const PhysiqueMap map(Read("right_dome_height: -0.02"));
  EXPECT_NEAR(map({-60, 0, 205}).z(), 205 - 20, 4);
  EXPECT_NEAR(map({60, 0, 205}).z(), 205, 1);
  EXPECT_EQ(map({-120, 0, 90}).z(), 90);
}

TEST(Physique, IsCheckedByField) {
  const auto scene = schema::ParseScene("x.textproto",
                                        "name: \"x\" physique { scoliosis_degrees: 80 } bodies { name: "
                                        "\"a\" role: ROLE_SEEN generated {} }");
  ASSERT_FALSE(scene.ok());
  EXPECT_THAT(scene.status().message(), HasSubstr("scoliosis_degrees"));
}

TEST(Physique, OfASceneIsThatOfEveryGeneratedBodyWithoutOne) {
  const auto scene = schema::ParseScene(
      "x.textproto",
      "name: \"x\" physique { height: 1.6 } bodies { name: \"a\" role: ROLE_SEEN generated {} } bodies { name: \"b\" "
      "role: ROLE_SEEN generated { physique { height: 1.9 } } }");
  ASSERT_TRUE(scene.ok()) << scene.status();
  EXPECT_EQ(scene->bodies(0).generated().physique().height(), 1.6);
  EXPECT_EQ(scene->bodies(1).generated().physique().height(), 1.9);
}

}  // namespace
}  // namespace phrenic::anatomy
