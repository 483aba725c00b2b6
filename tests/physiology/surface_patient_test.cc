// `thorax-patient`: the thorax that its muscles move, in the surface files of a person. Skipped without them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "server/imaging/surfaces/derived_bodies.h"
#include "server/mechanics/step/step.h"
#include "server/mesh/self_crossings.h"
#include "server/mesh/triangle_tree.h"
#include "server/meshio/meshio.h"
#include "server/physiology/cavity.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

const std::string kSurfaces = PHRENIC_SHARED_DIR "/data/";

absl::StatusOr<Mesh> ReadSurface(const v1::Body& body) {
  return meshio::ReadFile(kSurfaces + body.file().path(), body.file().unit());
}

v1::Scene PatientsScene() {
  std::ifstream file(PHRENIC_SOURCE_DIR "/server/scenes/thorax-patient.textproto");
  std::stringstream text;
  text << file.rdbuf();
  return *schema::ParseScene("thorax-patient.textproto", text.str());
}

class SurfacePatient : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!std::filesystem::is_directory(kSurfaces)) return;
    const v1::Scene scene = PatientsScene();
    const auto model = Compile(scene, imaging::WithDerived(&ReadSurface, scene));
    ASSERT_TRUE(model.ok()) << model.status();
    model_ = *model;
    subject_ = *physiology::Subject::Of(*model_);
  }
  static void TearDownTestSuite() {
    breaths_.clear();
    subject_.reset();
    model_.reset();
  }
  void SetUp() override {
    if (!std::filesystem::is_directory(kSurfaces)) GTEST_SKIP() << "there are no patient's surfaces at " << kSurfaces;
    ASSERT_NE(subject_, nullptr);
  }

  static v1::Parameters With(const std::string& preset) {
    v1::Parameters parameters = model_->parameters;
    parameters.MergeFrom(*FindPreset(model_->scene, preset));
    return parameters;
  }
  static const physiology::Recording& Breathe(const std::string& preset) {
    if (const auto found = breaths_.find(preset); found != breaths_.end()) return found->second;
    auto recording = physiology::Record(
        *subject_, preset, With(preset), [](double) { return true; }, physiology::FlawSearch::kNever);
    EXPECT_TRUE(recording.ok()) << recording.status();
    EXPECT_EQ(recording->problem, "");
    return breaths_.emplace(preset, *std::move(recording)).first->second;
  }
  static double Measure(const std::string& name, const v1::Parameters& parameters, const State& state,
                        Workspace& work) {
    const EvalContext at = MakeEvalContext(*model_, parameters, state, work.scratch);
    const auto found = std::ranges::find_if(model_->measures, [&](const auto& each) { return each->name() == name; });
    return (*found)->Value(at);
  }

  inline static std::shared_ptr<const Model> model_;
  inline static std::unique_ptr<const physiology::Subject> subject_;
  inline static std::map<std::string, physiology::Recording> breaths_;
};

TEST_F(SurfacePatient, WithoutDriveNothingMoves) {
  v1::Parameters parameters = With("quiet");
  parameters.set_diaphragm_activation(0);
  parameters.set_intercostal_activation(0);
  State state = model_->InitialState();
  Workspace work = model_->MakeWorkspace();
  while (state.time < 10) ASSERT_TRUE(Step(*model_, parameters, parameters.time_step(), state, work).ok());
  const Eigen::Index vertices = model_->coordinates.front().vertex;  // those of coordinates follow
  const double moved = (state.x - model_->rest).leftCols(vertices).colwise().norm().maxCoeff();
  std::printf("moved by %.4f mm in 10 s\n", 1e3 * moved);
  EXPECT_LT(moved, 1e-4);
}

TEST_F(SurfacePatient, NoRibPiercesTheSheetAtRestAndTheMuscleDoesNotCrossItself) {
  const physiology::FlawValues flaws = subject_->flaws.At(model_->InitialState());
  std::printf("at rest: %g crossings of the layers, %g crossed, %g vertices of lungs through them\n",
              flaws[physiology::kSelfCrossings], flaws[physiology::kCrossedLayers], flaws[physiology::kPiercingLungs]);
  EXPECT_EQ(flaws[physiology::kPiercingRibs], 0);
  EXPECT_EQ(SelfCrossings(model_->bodies[static_cast<size_t>(subject_->parts.muscle)].mesh, 0.004), 0);
}

TEST_F(SurfacePatient, WhatIsSeenIsThePersonsDiaphragm) {
  const v1::Scene scene = PatientsScene();
  const auto body = std::ranges::find(scene.bodies(), "diaphragm", &v1::Body::name);
  v1::Body read = *body;
  *read.mutable_file() = v1::SurfaceFile(body->derived().file());
  read.mutable_file()->set_unit(1e-3);
  const Mesh file = *ReadSurface(read);
  const Mesh& seen = model_->bodies[static_cast<size_t>(subject_->parts.sheet)].mesh;
  ASSERT_EQ(seen.vertices.cols(), file.vertices.cols());
  const TriangleTree tree(file.vertices, file.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(file.vertices, boxes);
  double sum = 0;
  for (const auto x : seen.vertices.colwise()) sum += std::sqrt(tree.Nearest(file.vertices, boxes, x, 1).squared);
  const double mean = 1e3 * sum / static_cast<double>(seen.vertices.cols());
  std::printf("the layers are %.2f mm from the file on average\n", mean);
  EXPECT_LT(mean, 1.5);
}

TEST_F(SurfacePatient, VolumeIsTheFlowIntegratedAndThatOfTheCavity) {
  const v1::Parameters parameters = With("quiet");
  State state = model_->InitialState();
  Workspace work = model_->MakeWorkspace();
  const double rest = Measure("lung volume", parameters, state, work);
  double integrated = 0, worst = 0, greatest = 0, flow = Measure("flow", parameters, state, work);
  while (state.time < 4) {
    const double before = state.time, flow_before = flow;
    ASSERT_TRUE(Step(*model_, parameters, parameters.time_step(), state, work).ok());
    flow = Measure("flow", parameters, state, work);
    integrated += (state.time - before) * (flow_before + flow) / 2;
    const double volume = Measure("lung volume", parameters, state, work) - rest;
    worst = std::max(worst, std::abs(integrated - volume));
    greatest = std::max(greatest, volume);
  }
  EXPECT_GT(greatest, 0.4e-3);
  EXPECT_LT(worst, 1e-3 * greatest);
  const physiology::Recording& quiet = Breathe("quiet");
  const auto& volume = quiet.of[physiology::kVolume];
  const double grown = physiology::CavityGrowth(*model_, subject_->parts, quiet.base, quiet.peak);
  EXPECT_NEAR(grown / (volume[quiet.peak_sample] - volume[0]), 1, 0.02);
}

TEST_F(SurfacePatient, AParalysedSideMovesLessThanTheOther) {
  const auto range = [](const physiology::Recording& breath, physiology::Quantity quantity) {
    return breath.of[quantity][0] - breath.of[quantity][breath.peak_sample];
  };
  const physiology::Recording &quiet = Breathe("quiet"), &palsy = Breathe("palsy-right");
  const double right = range(palsy, physiology::kRightApex), left = range(palsy, physiology::kLeftApex);
  std::printf("descent of right and left dome: quiet %.1f, %.1f mm; right palsy %.1f, %.1f mm\n",
              1e3 * range(quiet, physiology::kRightApex), 1e3 * range(quiet, physiology::kLeftApex), 1e3 * right,
              1e3 * left);
  EXPECT_GT(range(quiet, physiology::kRightApex), 0.01);
  EXPECT_LT(right, 0.2 * left);
  EXPECT_GT(left, 0.01);
}

}  // namespace
}  // namespace phrenic
