// An organ that is carried by a sheet and a bone, without jumps.
#include <gtest/gtest.h>

#include <cmath>

#include "server/mechanics/skinning/body_points.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// A dome of 120 mm radius, an organ below it, and a bone at rest beside the organ if `bone`.
std::shared_ptr<const Model> DomeWithOrgan(bool bone) {
  const std::string rest =
      "bodies { name: 'bone' role: ROLE_AT_REST ellipsoid { centre { y: 0.11 z: -0.02 } radii { x: 0.02 y: 0.02 z: "
      "0.05 "
      "} divisions: 3 } } ";
  return CompileText(
      "name: 'dome' bodies { name: 'sheet' role: ROLE_DEFORMABLE ellipsoid { radii { x: 0.12 y: 0.12 z: 0.12 } "
      "divisions: 12 upper_half: true } } " +
      (bone ? rest : "") +
      "bodies { name: 'organ' role: ROLE_SEEN ellipsoid { centre { z: 0.035 } radii { x: 0.09 y: 0.09 z: 0.08 } "
      "divisions: 16 } } motions { skin { bodies: 'organ' drivers: 'sheet' " +
      (bone ? "drivers: 'bone' " : "") + "mode: SKIN_MODE_SMOOTH } }");
}

const BodyModel& OrganOf(const Model& model) { return model.bodies.back(); }

Points CarriedOrgan(const Model& model, const Points& x) {
  State state = model.InitialState();
  state.x = x;
  Points out(3, OrganOf(model).mesh.vertices.cols());
  PlaceBody(model, state, static_cast<int>(model.bodies.size()) - 1, out);
  return out;
}

TEST(SmoothSkin, AtRestLeavesTheOrganWhereItIs) {
  const auto model = DomeWithOrgan(true);
  EXPECT_LT((CarriedOrgan(*model, model->rest) - OrganOf(*model).mesh.vertices).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SmoothSkin, FollowsATranslationOfItsOnlyDriver) {
  const auto model = DomeWithOrgan(false);
  const Eigen::Vector3d by(0.01, -0.02, -0.03);
  const Points moved = OrganOf(*model).mesh.vertices.colwise() + by;
  EXPECT_LT((CarriedOrgan(*model, model->rest.colwise() + by) - moved).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(SmoothSkin, IsHeldByABoneNearIt) {
  const auto model = DomeWithOrgan(true);
  const Eigen::Vector3d by(0, 0, -0.03);
  const Points moved = CarriedOrgan(*model, model->rest.colwise() + by) - OrganOf(*model).mesh.vertices;
  Eigen::Index behind = 0, above = 0;
  OrganOf(*model).mesh.vertices.row(1).maxCoeff(&behind);
  OrganOf(*model).mesh.vertices.row(2).maxCoeff(&above);
  EXPECT_NEAR(moved(2, above), -0.03, 1e-9);
  EXPECT_GT(moved(2, behind), -0.015);
  EXPECT_LE(moved(2, behind), 0);
}

// A sheet that flattens: its middle falls, its rim stays. The organ has no folds and no tears, and its top keeps below.
TEST(SmoothSkin, FlattenedSheetCarriesAllOfTheOrganWithoutJumps) {
  const auto model = DomeWithOrgan(false);
  Points x = model->rest;
  x.row(2) *= 0.6;
  const Mesh& organ = OrganOf(*model).mesh;
  const Points moved = CarriedOrgan(*model, x) - organ.vertices;
  for (Eigen::Index t = 0; t < organ.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = organ.triangles(k, t), b = organ.triangles((k + 1) % 3, t);
      const double length = (organ.vertices.col(a) - organ.vertices.col(b)).norm();
      EXPECT_LT((moved.col(a) - moved.col(b)).norm(), 0.8 * length);
    }
  }
  Eigen::Index bottom = 0, top = 0;
  organ.vertices.row(2).minCoeff(&bottom);
  organ.vertices.row(2).maxCoeff(&top);
  EXPECT_LT(moved(2, top), -0.04);
  EXPECT_LT(moved(2, bottom), 0.6 * moved(2, top)) << "the depth follows what is above it";
}

}  // namespace
}  // namespace phrenic
