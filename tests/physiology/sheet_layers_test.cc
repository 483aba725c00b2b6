// The generated diaphragm's two layers over its middle surface.
#include <gtest/gtest.h>

#include "server/anatomy/anatomy.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/skinning/body_points.h"
#include "server/mechanics/skinning/tissue_bodies.h"
#include "server/mesh/self_crossings.h"
#include "server/mesh/topology.h"
#include "server/schema/schema.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

std::shared_ptr<const Model> Layers(double middle_mm, double seen_mm = 3.16) {
  const auto part = [](double mm, const std::string& sheet) {
    return " anatomy { structure: STRUCTURE_DIAPHRAGM } generated { resolution_mm: " + std::to_string(mm) + sheet +
           " } } ";
  };
  const auto scene = schema::ParseScene(
      "layers", "name: 'layers' bodies { name: 'middle' role: ROLE_DEFORMABLE" +
                    part(middle_mm, " sheet: SHEET_MIDDLE") + "bodies { name: 'diaphragm' role: ROLE_SEEN" +
                    part(seen_mm, "") +
                    "motions { skin { bodies: 'diaphragm' drivers: 'middle' mode: SKIN_MODE_SHEET } }");
  auto model =
      Compile(*scene, [](const v1::Body& body) { return anatomy::Generate(body.anatomy(), body.generated()); });
  EXPECT_TRUE(model.ok()) << model.status();
  return model.ok() ? *model : nullptr;
}

Points Placed(const Model& model, const Points& middle) {
  State state = model.InitialState();
  state.x = middle;
  Points placed(3, model.bodies[1].mesh.vertices.cols());
  PlaceBody(model, state, 1, placed);
  return placed;
}

// Roughly a breath: domes and wall come down by `depth` [m] where they are above the rim's mean height, and flatten.
Points Breathed(const Points& rest, double depth) {
  Points moved = rest;
  for (auto x : moved.colwise()) {
    const double up = std::max(0.0, x.z() - 0.1) / 0.12, beside = x.x() * x.x() / 0.0144;
    x.z() -= depth * up * up * (1 - 0.4 * beside);
  }
  return moved;
}

class SheetLayersTest : public testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Resolutions, SheetLayersTest, testing::Values(3.16, 5, 6.5));

TEST_P(SheetLayersTest, LayersRestWhereTheyWereGenerated) {
  const auto model = Layers(GetParam());
  ASSERT_NE(model, nullptr);
  EXPECT_LT((Placed(*model, model->rest) - model->bodies[1].mesh.vertices).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT(model->report.mappings(0).largest_distance_mm(), 2.5);
  EXPECT_LT(model->report.mappings(0).mean_distance_mm(), 1.6);
}

TEST_P(SheetLayersTest, LayersOfABreathNeitherCrossNorLoseTheirVolume) {
  const auto model = Layers(GetParam());
  ASSERT_NE(model, nullptr);
  Mesh layers = model->bodies[1].mesh;
  const double rest = SignedVolume(layers.vertices, layers.triangles);
  for (const double depth : {-0.01, 0.02, 0.05}) {
    layers.vertices = Placed(*model, Breathed(model->rest, depth));
    EXPECT_EQ(SelfCrossings(layers, 0.004), 0) << depth;
    EXPECT_NEAR(SignedVolume(layers.vertices, layers.triangles), rest, 0.02 * rest) << depth;
  }
}

TEST(SheetLayers, CoarseLayersHaveAFootOnTheirOwnMiddle) {
  for (const double mm : {7.0, 12.0, 20.0}) {
    const auto model = Layers(mm, mm);
    ASSERT_NE(model, nullptr) << mm;
    EXPECT_LT((Placed(*model, model->rest) - model->bodies[1].mesh.vertices).cwiseAbs().maxCoeff(), 1e-15) << mm;
  }
}

TEST(SheetLayers, AreWhatIsExportedAndMeasured) {
  const auto model = Layers(12, 7);
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(TissueBodies(*model), std::vector<int>{1});
  const auto subject = physiology::Subject::Of(*model);
  ASSERT_TRUE(subject.ok()) << subject.status();
  const auto shortening = [&](const Points& now) { return (*subject)->fibres.Shortening(model->rest, now); };
  State state = model->InitialState();
  EXPECT_NEAR(shortening(state.x), 0, 1e-12);
  state.x *= 0.9;
  EXPECT_NEAR(shortening(state.x), 0.1, 1e-9);
  EXPECT_NEAR((*subject)->fibres.TendonAreaChange(model->rest, state.x), 0.19, 1e-9);
  EXPECT_GT(DomeDescent(**subject, state, v1::SIDE_RIGHT), 20);
}

}  // namespace
}  // namespace phrenic
