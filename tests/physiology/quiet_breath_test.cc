// The generated thorax at its defaults makes a quiet breath that lies inside the published ranges: dome descent 10-25
// mm (mean 18 +- 3), left over right 0.6-1.1, sternum 1.5-5 mm ventral and 2-9 mm cranial, lower ribs 1.5-5 mm to each
// side, dome speed 2-25 mm/s.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "server/anatomy/anatomy.h"
#include "server/mechanics/compile.h"
#include "server/mechanics/step.h"
#include "server/schema/schema.h"

namespace phrenic {
namespace {

std::shared_ptr<const Model> CompileThorax() {
  std::ifstream file(std::string(PHRENIC_SOURCE_DIR) + "/server/scenes/thorax.textproto");
  std::stringstream text;
  text << file.rdbuf();
  const auto scene = schema::ParseScene("thorax.textproto", text.str());
  EXPECT_TRUE(scene.ok()) << scene.status();
  auto model = Compile(
      *scene, [](const v1::Body& body) { return anatomy::Generate(body.anatomy(), body.generated().resolution_mm()); });
  EXPECT_TRUE(model.ok()) << model.status();
  return *model;
}

int BodyNamed(const Model& model, const std::string& name) {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (model.bodies[b].name == name) return b;
  }
  ADD_FAILURE() << "no body " << name;
  return 0;
}

// Displacements of a body's vertices from rest, 3 x n [mm].
Points Displacements(const Model& model, const State& state, const std::string& name) {
  const int body = BodyNamed(model, name);
  Points placed(3, model.bodies[body].mesh.vertices.cols());
  PlaceBody(model, state, body, placed);
  return 1e3 * (placed - model.bodies[body].mesh.vertices);
}

// What a radiologist measures: how much lower the highest point of a dome is, more than 35 mm from the midline [mm].
double DomeDescent(const Model& model, const State& state, double side) {
  const BodyModel& diaphragm = model.bodies[BodyNamed(model, "diaphragm")];
  const auto top = [&](const ConstPoints& x) {
    double highest = -1e9;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      if (side * diaphragm.mesh.vertices(0, i) > 0.035) highest = std::max(highest, x(2, i));
    }
    return highest;
  };
  const Eigen::Index n = diaphragm.mesh.vertices.cols();
  return 1e3 * (top(diaphragm.mesh.vertices) - top(state.x.middleCols(diaphragm.first_vertex, n)));
}

class QuietBreath : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    model_ = CompileThorax();
    state_ = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    const double dt = model_->parameters.time_step(), peak = model_->parameters.breath_length() / 2;
    double descent = 0;
    double sampled = 0;
    while (state_.time < peak) {
      ASSERT_TRUE(Step(*model_, model_->parameters, dt, state_, work).ok()) << "diverged at " << state_.time << " s";
      if (state_.time - sampled < 0.1) continue;
      const double now = DomeDescent(*model_, state_, -1);
      fastest_ = std::max(fastest_, (now - descent) / (state_.time - sampled));
      descent = now, sampled = state_.time;
    }
  }
  static void TearDownTestSuite() { model_.reset(); }

  static std::shared_ptr<const Model> model_;
  static State state_;  // at the peak of the first breath
  static double fastest_;
};

std::shared_ptr<const Model> QuietBreath::model_;
State QuietBreath::state_;
double QuietBreath::fastest_ = 0;

void ExpectBetween(double low, double value, double high, const std::string& what) {
  std::printf("%-24s %6.2f   accepted %g to %g\n", what.c_str(), value, low, high);
  EXPECT_GE(value, low) << what;
  EXPECT_LE(value, high) << what;
}

TEST_F(QuietBreath, DomesDescendAsMuchAsPublished) {
  const double right = DomeDescent(*model_, state_, -1), left = DomeDescent(*model_, state_, 1);
  ExpectBetween(10, right, 25, "right_dome_mm");
  ExpectBetween(0.6, left / right, 1.1, "left_over_right");
  ExpectBetween(2, fastest_, 25, "dome_speed_mm_per_s");
}

TEST_F(QuietBreath, SternumMovesForwardAndUpButNotSideways) {
  const Eigen::Vector3d moved = Displacements(*model_, state_, "sternum-body").rowwise().mean();
  ExpectBetween(1.5, -moved.y(), 5, "sternum_ventral_mm");
  ExpectBetween(2, moved.z(), 9, "sternum_cranial_mm");
  EXPECT_LT(std::abs(moved.x()), 0.01);
}

TEST_F(QuietBreath, LowerRibsMoveOutwardsOnBothSidesAlike) {
  for (int rib = 7; rib <= 10; ++rib) {
    const std::string name = "rib-" + std::to_string(rib);
    const double right = -Displacements(*model_, state_, name + "-right").row(0).minCoeff();
    const double left = Displacements(*model_, state_, name + "-left").row(0).maxCoeff();
    ExpectBetween(1.5, right, 5, name + "_right_lateral_mm");
    EXPECT_NEAR(right, left, 0.1);
  }
}

TEST_F(QuietBreath, RigidLinksHoldTheTendon) {
  ASSERT_FALSE(model_->constraints.empty());
  EXPECT_GT(model_->report.rigid_links(), 500);
  EXPECT_LT(model_->constraints.front()->Residual(state_), 1e-9);
}

TEST_F(QuietBreath, IsMadeByTheSizeOfMeshThatWasPromised) {
  const Eigen::Index vertices = model_->bodies[BodyNamed(*model_, "diaphragm")].mesh.vertices.cols();
  EXPECT_GE(vertices, 20'000);
  EXPECT_LE(vertices, 21'000);
}

}  // namespace
}  // namespace phrenic
