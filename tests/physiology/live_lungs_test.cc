// The interior of the lungs as viewers read it: its error against the full solution, its laws, its causes, its limits.
#include "server/physiology/live_lungs.h"

#include <gtest/gtest.h>

#include "server/mechanics/step/step.h"
#include "server/mesh/topology.h"
#include "server/physiology/lung_breath.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

using physiology::LiveLungs;
using physiology::LungMoment;

constexpr size_t kRightLung = 0, kLeftLung = 1;

class LiveLungsTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    model_ = CoarseThorax();
    lungs_ = std::make_unique<LiveLungs>(*LiveLungs::Make(*model_));
  }
  static void TearDownTestSuite() {
    lungs_.reset();
    model_.reset();
  }

  static const physiology::Recording& Breath(const std::string& preset) { return CoarseBreath(preset); }
  // What the lungs gain from the beginning of a breath to its peak.
  static std::vector<LungMoment> Gained(const std::string& preset) {
    const physiology::Recording& breath = Breath(preset);
    std::vector<LungMoment> peak = lungs_->At(breath.peak, breath.parameters);
    const std::vector<LungMoment> base = lungs_->At(breath.base, breath.parameters);
    for (size_t i = 0; i < peak.size(); ++i) {
      peak[i].amplitudes -= base[i].amplitudes;
      peak[i].volume -= base[i].volume;
      for (size_t r = 0; r < physiology::kLungRegions; ++r) {
        peak[i].caudal[r] -= base[i].caudal[r];
        peak[i].gained[r] -= base[i].gained[r];
      }
    }
    return peak;
  }

  inline static std::shared_ptr<const Model> model_;
  inline static std::unique_ptr<LiveLungs> lungs_;
};

// The reduction: few shapes beside the full solution, over the inside, relative to the root mean square displacement.
TEST_F(LiveLungsTest, MovesAsTheFullSolutionWithinNinePerCent) {
  const auto full = *physiology::BreathingLungs::Make(*CoarseSubject());
  for (const char* preset : {"quiet", "deep", "palsy-right", "ventilator", "upright"}) {
    const std::vector<LungMotion> motions = full.Motions(Breath(preset));
    const std::vector<LungMoment> gained = Gained(preset);
    for (const size_t lung : {kRightLung, kLeftLung}) {
      const auto field = *SampleLungs(std::span(&motions[lung], 1), 0.006);
      const Points reduced = lungs_->lungs()[lung].responses.Nodes(gained[lung].amplitudes);
      double error = 0, size = 0, ventilation_error = 0, ventilation = 0;
      for (Eigen::Index i = 0; i < field.ventilation.size(); ++i) {
        if (field.lung[static_cast<size_t>(i)] == 0) continue;
        const Eigen::Vector3d at = field.PointAt(i);
        error += (motions[lung].tissue.DisplacementAt(reduced, at) - field.displacement.col(i)).squaredNorm();
        size += field.displacement.col(i).squaredNorm();
        const double gain = motions[lung].tissue.GradientAt(reduced, at).trace();
        ventilation_error += std::pow(gain - field.ventilation[i], 2);
        ventilation += std::pow(field.ventilation[i], 2);
      }
      std::printf("%s, %s, %td shapes: displacement off by %.1f %%, ventilation by %.1f %%\n", preset,
                  lungs_->lungs()[lung].name.c_str(), gained[lung].amplitudes.size(), 100 * std::sqrt(error / size),
                  100 * std::sqrt(ventilation_error / ventilation));
      EXPECT_LT(std::sqrt(error / size), 0.09) << preset << " " << lung;
    }
  }
}

// Gauss: what the tissue gains inside is what its surface sweeps.
TEST_F(LiveLungsTest, GainsInsideWhatItsSurfaceSweeps) {
  for (const char* preset : {"quiet", "deep"}) {
    const std::vector<LungMoment> gained = Gained(preset);
    for (const size_t lung : {kRightLung, kLeftLung}) {
      const LiveLungs::Lung& live = lungs_->lungs()[lung];
      const Mesh& mesh = model_->bodies[static_cast<size_t>(live.body)].mesh;
      constexpr double kSmall = 1e-3;  // of the motion: the gain is linear, the volume of a moved surface is not
      Points moved = mesh.vertices;
      for (auto vertex : moved.colwise()) {
        vertex += live.responses.At(kSmall * gained[lung].amplitudes, Eigen::Vector3d(vertex)).displacement;
      }
      const double swept = (SignedVolume(moved, mesh.triangles) - SignedVolume(mesh.vertices, mesh.triangles)) / kSmall;
      EXPECT_NEAR(gained[lung].volume, swept, 0.05 * std::abs(swept)) << preset << " " << lung;
      EXPECT_GT(gained[lung].volume, 1e-4);
    }
  }
}

TEST_F(LiveLungsTest, GainTheAirOfTheBreath) {
  for (const char* preset : {"quiet", "palsy-right", "upright"}) {
    const physiology::Recording& breath = Breath(preset);
    const auto& volume = breath.of[physiology::kVolume];
    const double air = volume[breath.peak_sample] - volume.front();
    const std::vector<LungMoment> gained = Gained(preset);
    EXPECT_NEAR(gained[kRightLung].volume + gained[kLeftLung].volume, air, 0.02 * air) << preset;
  }
}

TEST_F(LiveLungsTest, RestsInTheStateOfRest) {
  State rest = model_->InitialState();
  for (const LungMoment& lung : lungs_->At(rest, model_->parameters)) {
    EXPECT_LT(lung.amplitudes.cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT(std::abs(lung.volume), 1e-8);
  }
}

// The regions agree with those that `phrenic lungs` averages over points of the full solution.
TEST_F(LiveLungsTest, HasTheRegionsOfTheFullSolution) {
  const auto full = *physiology::BreathingLungs::Make(*CoarseSubject());
  const auto readings = full.Readings(full.Motions(Breath("quiet")));
  const std::vector<LungMoment> gained = Gained("quiet");
  for (const size_t lung : {kRightLung, kLeftLung}) {
    for (size_t r = 0; r < physiology::kLungRegions; ++r) {
      EXPECT_NEAR(gained[lung].caudal[r], readings[lung].caudal[r], 8e-4) << lung << " " << r;
      EXPECT_NEAR(gained[lung].gained[r], readings[lung].gained[r], 0.015) << lung << " " << r;
    }
  }
}

// Counterfactual: without its phrenic nerve, the right side moves up and gains less at the base than the left.
TEST_F(LiveLungsTest, IsVentilatedLessAtTheBaseOfAParalysedSide) {
  const auto palsy = Gained("palsy-right"), health = Gained("quiet");
  const auto base = [](const LungMoment& lung) { return lung.gained[physiology::kLungBase]; };
  EXPECT_LT(base(palsy[kRightLung]), 0.5 * base(palsy[kLeftLung]));
  EXPECT_GT(base(health[kRightLung]), 0.7 * base(health[kLeftLung]));
  EXPECT_LT(palsy[kRightLung].caudal[physiology::kLungBase], 0);
  EXPECT_GT(palsy[kLeftLung].caudal[physiology::kLungBase], 0.005);
}

TEST_F(LiveLungsTest, StandsStillBehindAnOpenPleura) {
  const auto open = Gained("pneumothorax-right");
  EXPECT_EQ(open[kRightLung].volume, 0);
  EXPECT_GT(open[kLeftLung].volume, 1e-4);
}

TEST_F(LiveLungsTest, IsReadInsideTheLungsAlone) {
  const physiology::Recording& breath = Breath("quiet");
  const auto moments = lungs_->At(breath.peak, breath.parameters);
  for (size_t i = 0; i < 2; ++i) {
    const Mesh& mesh = model_->bodies[static_cast<size_t>(lungs_->lungs()[i].body)].mesh;
    const Eigen::Vector3d middle = (mesh.vertices.rowwise().minCoeff() + mesh.vertices.rowwise().maxCoeff()) / 2;
    const auto read = lungs_->Read(moments, middle);
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->lung, static_cast<int>(i));
    EXPECT_LT(read->tissue.displacement.z(), 0);
  }
  EXPECT_FALSE(lungs_->Read(moments, {0, 0, -1}).has_value());
}

// Boundary modes move a person's lungs: the tissue at a vertex is where the vertex is, and region means are those of
// the field that `phrenic lungs` writes.
TEST(LiveLungs, OfAPersonAreTheirSurfacesTissue) {
  const auto model = CompileShipped("person-1", 0);
  const auto lungs = LiveLungs::Make(*model);
  ASSERT_TRUE(lungs.ok()) << lungs.status();
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  while (state.time < model->parameters.breath_length() / 2) {
    ASSERT_TRUE(Step(*model, model->parameters, model->parameters.time_step(), state, work).ok());
  }
  const std::vector<LungMoment> moments = lungs->At(state, model->parameters);
  ASSERT_EQ(moments.size(), 2);
  for (size_t i = 0; i < 2; ++i) {
    const BodyModel& body = model->bodies[static_cast<size_t>(lungs->lungs()[i].body)];
    for (Eigen::Index v = 0; v < body.mesh.vertices.cols(); ++v) {
      const Eigen::Vector3d rest = body.mesh.vertices.col(v);
      const Eigen::Vector3d moved = state.x.col(body.first_vertex + v) - rest;
      ASSERT_LT((lungs->lungs()[i].responses.At(moments[i].amplitudes, rest).displacement - moved).norm(), 1e-9);
    }
    const double swept =
        SignedVolume(state.x.middleCols(body.first_vertex, body.mesh.vertices.cols()), body.mesh.triangles) -
        SignedVolume(body.mesh.vertices, body.mesh.triangles);
    EXPECT_GT(swept, 5e-5) << body.name;
    EXPECT_NEAR(moments[i].volume / swept, 1, 0.1) << body.name;
  }
  const auto motions = physiology::MotionsOfModes(*model, model->parameters);
  ASSERT_TRUE(motions.ok()) << motions.status();
  const std::vector<physiology::LungReading> readings = physiology::ReadingsOf(*motions);
  for (size_t i = 0; i < 2; ++i) {
    for (const int region : {physiology::kLungBase, physiology::kLungMiddle, physiology::kLungApex}) {
      EXPECT_GT(readings[i].caudal[region], 0) << i << " " << region;
    }
    EXPECT_GT(readings[i].caudal[physiology::kLungBase], readings[i].caudal[physiology::kLungApex]);
    EXPECT_GE(readings[i].volume * 1.05, moments[i].volume) << "the peak of the breath";
  }
}

TEST(LiveLungs, AreRefusedForASceneWithoutLungs) {
  const auto model = CompileShipped("sheet-2d");
  const auto lungs = LiveLungs::Make(*model);
  EXPECT_EQ(lungs.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_NE(lungs.status().message().find("lacks lungs"), std::string::npos);
}

TEST(LiveLungs, OfTooManyTrianglesAreRefused) {
  const auto model = CompileShipped(
      "thorax", [](const v1::Body& body) { return body.anatomy().structure() == v1::STRUCTURE_LUNG ? 2 : 12; });
  const auto lungs = LiveLungs::Make(*model);
  EXPECT_EQ(lungs.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_NE(lungs.status().message().find("make their surfaces coarser"), std::string::npos) << lungs.status();
}

}  // namespace
}  // namespace phrenic
