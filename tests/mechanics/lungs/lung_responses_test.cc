#include "server/mechanics/lungs/lung_responses.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <random>

#include "server/mesh/ellipsoid.h"

namespace phrenic {
namespace {

// A lung without a model: its lowest part lies on a diaphragm, its margin is free, the rest is on the wall.
class LungResponsesTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const Mesh shape = EllipsoidSurface({0.07, 0.01, 0.25}, {0.05, 0.08, 0.12}, 24, false);
    tissue_ = std::make_unique<LungTissue>(*LungTissue::Make(shape, {.edge = 0.02}));
    for (const auto& point : tissue_->points().colwise()) {
      const double z = point.z() - tissue_->box().center().z();
      neighbours_.push_back(z < -0.04   ? LungNeighbour::kDiaphragm
                            : z < -0.03 ? LungNeighbour::kNone
                                        : LungNeighbour::kWall);
    }
    lung_ = std::make_unique<LungResponses>(*LungResponses::Make(*tissue_, neighbours_, {LungWeight()}));
  }
  static void TearDownTestSuite() {
    lung_.reset();
    tissue_.reset();
    neighbours_.clear();
  }

  // The diaphragm falls and tilts, the wall widens; NaN at free points.
  static Points Breath() {
    Points displacement = Points::Constant(3, tissue_->points().cols(), std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index p = 0; p < displacement.cols(); ++p) {
      const Eigen::Vector3d at = tissue_->points().col(p) - tissue_->box().center();
      const LungNeighbour of = neighbours_[static_cast<size_t>(p)];
      if (of == LungNeighbour::kDiaphragm) displacement.col(p) << 0, 0, -0.01 - 0.05 * at.y();
      if (of == LungNeighbour::kWall) displacement.col(p) << 0.02 * at.x(), -0.002, 0;
    }
    return displacement;
  }

  inline static std::unique_ptr<LungTissue> tissue_;
  inline static std::vector<LungNeighbour> neighbours_;
  inline static std::unique_ptr<LungResponses> lung_;
};

TEST_F(LungResponsesTest, MovesAsTheFullSolutionWhereTheSurroundingsMoveSmoothly) {
  const Points full = tissue_->SolveVectors(Breath());
  const Points reduced = lung_->Nodes(lung_->Amplitudes(Breath()));
  EXPECT_LT((reduced - full).norm(), 0.03 * full.norm());
}

// Two weights in one set of shapes, each with its own responses to motion and pressure.
TEST_F(LungResponsesTest, MovesAsTheFullSolutionUnderEachWeight) {
  const std::vector<LungWeight> weights = {{}, {{0, 0, 2}, tissue_->box().center(), 1}};
  const LungResponses lung = *LungResponses::Make(*tissue_, neighbours_, weights);
  for (size_t i = 0; i < weights.size(); ++i) {
    const PressedLung full = tissue_->Under(weights[i]).SolvePressed(Breath());
    EXPECT_LT((lung.Nodes(lung.Amplitudes(Breath(), i)) - full.followed).norm(), 0.03 * full.followed.norm()) << i;
    const Points pressed = lung.Nodes(lung.PerPressure(i)) / LungElasticity().contact;
    EXPECT_LT((pressed - full.pressed).norm(), 0.03 * full.pressed.norm()) << i;
  }
  EXPECT_GT((lung.Amplitudes(Breath(), 1) - lung.Amplitudes(Breath(), 0)).norm(),
            0.03 * lung.Amplitudes(Breath(), 0).norm());
}

// The root's descent, which acts along the surface, beside what acts along the normal.
TEST_F(LungResponsesTest, FollowsTheRootAsTheFullSolution) {
  LungElasticity elasticity = {.edge = 0.02};
  elasticity.root = {1, tissue_->box()};
  const LungTissue tissue = *LungTissue::Make(tissue_->surface(), elasticity);
  std::vector<LungNeighbour> neighbours = neighbours_;
  Points displacement = Breath();
  for (size_t p = 0; p < neighbours.size(); ++p) {
    const auto at = static_cast<Eigen::Index>(p);
    if (!tissue.rooted()[p]) continue;
    neighbours[p] = LungNeighbour::kMediastinum;
    displacement.col(at) << 0.001, 0, -0.004 - 0.02 * (tissue.box().center().z() - tissue.points()(2, at));
  }
  const LungResponses lung = *LungResponses::Make(tissue, neighbours, {LungWeight()});
  const Points full = tissue.SolveVectors(displacement), reduced = lung.Nodes(lung.Amplitudes(displacement));
  EXPECT_LT((reduced - full).norm(), 0.03 * full.norm());
  EXPECT_GT((tissue_->SolveVectors(displacement) - full).norm(), 0.1 * full.norm()) << "without the root";
}

TEST_F(LungResponsesTest, RestsWhereNothingMoves) {
  const Eigen::VectorXd amplitudes = lung_->Amplitudes(Points::Zero(3, tissue_->points().cols()));
  EXPECT_EQ(amplitudes, Eigen::VectorXd::Zero(amplitudes.size()));
}

TEST_F(LungResponsesTest, IsLinear) {
  const Points once = Breath();
  const Eigen::VectorXd one = lung_->Amplitudes(once), two = lung_->Amplitudes(-2 * once);
  EXPECT_LT((two + 2 * one).norm(), 1e-12 * one.norm());
}

TEST_F(LungResponsesTest, HasFewShapes) {
  EXPECT_GT(lung_->shapes().cols(), 5);
  EXPECT_LE(lung_->shapes().cols(), LungResponses::kMostShapes);
  EXPECT_EQ(lung_->shapes().rows(), 3 * lung_->grid().nodes().cols());
}

// At a point as on the nodes, and the gradient as the difference of displacements.
TEST_F(LungResponsesTest, IsReadAtAPoint) {
  const Eigen::VectorXd amplitudes = lung_->Amplitudes(Breath());
  const Points nodes = lung_->Nodes(amplitudes);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-0.5, 0.5);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d at =
        tissue_->box().center() +
        Eigen::Vector3d::NullaryExpr([&] { return part(random); }).cwiseProduct(tissue_->box().sizes()) / 2;
    const TissueAtPoint here = lung_->At(amplitudes, at);
    EXPECT_LT((here.displacement - tissue_->DisplacementAt(nodes, at)).norm(), 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d next = lung_->At(amplitudes, at + kStep * Eigen::Vector3d::Unit(axis)).displacement;
      EXPECT_LT(((next - here.displacement) / kStep - here.gradient.col(axis)).norm(), 1e-3);
    }
  }
}

TEST_F(LungResponsesTest, HoldsWhatIsInsideAlone) {
  EXPECT_TRUE(lung_->grid().Holds(tissue_->box().center()));
  EXPECT_FALSE(lung_->grid().Holds(tissue_->box().min()));
  EXPECT_FALSE(lung_->grid().Holds(tissue_->box().center() + Eigen::Vector3d(0, 0, 10)));
  EXPECT_FALSE(lung_->grid().Holds(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())));
}

TEST(TissueAtPoint, HasTheStrainsOfItsGradient) {
  TissueAtPoint tissue = {Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
  tissue.gradient.diagonal() << 0.1, -0.02, 0.05;
  EXPECT_NEAR(tissue.Ventilation(), 0.13, 1e-12);
  EXPECT_NEAR(tissue.LargestStrain(), 0.1, 1e-12);
  tissue.gradient.setZero();
  tissue.gradient(0, 1) = 0.2;  // simple shear: principal strains +-0.1
  EXPECT_NEAR(tissue.LargestStrain(), 0.1, 1e-12);
  tissue.gradient(1, 0) = -0.2;  // a rotation alone
  EXPECT_NEAR(tissue.LargestStrain(), 0, 1e-12);
}

TEST_F(LungResponsesTest, StopsWithTheReason) {
  const StopCheck stop([] { return true; }, 0, "--x");
  EXPECT_EQ(LungResponses::Make(*tissue_, neighbours_, {LungWeight()}, stop).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace phrenic
