#include <gmock/gmock.h>

#include "tests/compile_text.h"

namespace phrenic {
namespace {

// Two sheets of 3 x 3 vertices 1 mm apart.
std::shared_ptr<const Model> Sheets(const std::string& cross_layer) {
  const auto sheet = [](const std::string& name, const std::string& z) {
    return "bodies { name: '" + name + "' role: ROLE_DEFORMABLE grid { columns: 3 rows: 3 origin { z: " + z +
           " } u { x: 0.01 } v { y: 0.01 } } regions { name: 'edge' low {} high { y: 1 z: 1 } } } ";
  };
  return CompileText("name: 'sheets' " + sheet("lower", "0") + sheet("upper", "0.001") +
                     "forces { cross_layer { bodies: " + "'lower' other_bodies: 'upper' " + cross_layer + " } }");
}

TEST(CrossLayer, JoinsEachVertexToTheNearestOfTheOtherBody) {
  EXPECT_EQ(Sheets("distance: 0.002")->report.springs(), 9);
  EXPECT_EQ(Sheets("distance: 0.002 region: 'edge'")->report.springs(), 3);
  EXPECT_EQ(Sheets("distance: 0.002 exclude_region: 'edge'")->report.springs(), 6);
  EXPECT_EQ(Sheets("distance: 0.0101 neighbours: 16")->report.springs(), 9 + 2 * 12);  // and along each edge, twice
}

TEST(CrossLayer, WithNothingInReachIsLeftOutWithItsReason) {
  const auto model = Sheets("distance: 0.0005");
  EXPECT_TRUE(model->forces.empty());
  EXPECT_THAT(model->report.DebugString(), testing::HasSubstr("no vertex has an opposite one within 0.0005 m"));
}

// A slab's vertices are joined across it, each pair once, and not to their neighbours on the same side.
TEST(CrossLayer, JoinsTheTwoLayersOfOneBody) {
  const auto model = CompileText(
      "name: 'slab' bodies { name: 'slab' role: ROLE_DEFORMABLE block { size { x: 3 y: 3 z: 0.2 } columns: 3 rows: 3 "
      "layers: 1 } } forces { cross_layer { bodies: 'slab' distance: 0.3 } }");
  EXPECT_EQ(model->report.springs(), 4 * 4);
}

}  // namespace
}  // namespace phrenic
