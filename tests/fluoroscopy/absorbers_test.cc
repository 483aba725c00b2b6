// What absorbs in the generated thorax, at rest and in a deep breath.
#include "server/fluoroscopy/absorbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/anatomy/anatomy.h"
#include "server/fluoroscopy/attenuation.h"
#include "server/fluoroscopy/closing.h"
#include "server/fluoroscopy/outline.h"
#include "server/fluoroscopy/picture_file.h"
#include "server/mesh/topology.h"
#include "tests/compile_text.h"
#include "tests/physiology/generated_thorax.h"
#include "tests/small_scenes.h"

namespace phrenic::fluoroscopy {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

constexpr int kPixels = 128;

class Thorax : public testing::Test {
 protected:
  static void SetUpTestSuite() { model_ = CompileShipped("thorax", 12); }
  static void TearDownTestSuite() { model_.reset(); }

  static State Inspired() {
    v1::Parameters parameters = model_->parameters;
    parameters.MergeFrom(*FindPreset(model_->scene, "deep"));
    State state = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    while (state.time < 3) {
      EXPECT_TRUE(Step(*model_, parameters, parameters.time_step(), state, work).ok());
    }
    return state;
  }

  static Picture Shown(const Absorbers& absorbers, const CArm& arm = {}) {
    return LineIntegrals(absorbers.all, ProjectionOf(arm, absorbers.isocentre), kPixels);
  }

  static std::shared_ptr<const Model> model_;
};

std::shared_ptr<const Model> Thorax::model_;

// The volume that a surface has in a picture by parallel rays.
double VolumeInPicture(const Absorber& surface, const Eigen::Vector3d& isocentre) {
  const Projection at = ProjectionOf({.source_to_detector = 0}, isocentre);
  const double pixel = 2 * at.half_width / kPixels;
  return LineIntegrals({{surface.name, surface.vertices, surface.triangles, 1}}, at, kPixels).sum() * pixel * pixel;
}

TEST_F(Thorax, HasEveryClosedBodyWithTissueAndATrunkAroundIt) {
  const Absorbers found = *AbsorbersAt(*model_, model_->InitialState());
  EXPECT_THAT(found.open, IsEmpty());
  EXPECT_THAT(found.all, Contains(Field(&Absorber::name, "lung-left")));
  EXPECT_THAT(found.all, Not(Contains(Field(&Absorber::name, "chest-wall"))));
  EXPECT_THAT(found.all, Not(Contains(Field(&Absorber::name, StartsWith("lobe-")))));
  const Absorber& trunk = found.all.back();
  EXPECT_EQ(trunk.name, "trunk");
  Mesh mesh;
  mesh.vertices = trunk.vertices;
  mesh.triangles = trunk.triangles;
  EXPECT_TRUE(AnalyseTopology(mesh).watertight());
  EXPECT_GT(SignedVolume(trunk.vertices, trunk.triangles), 0.02);
  for (const Absorber& each : found.all) {
    EXPECT_EQ(ClosedTriangles(each.vertices, each.triangles)->cols(), each.triangles.cols()) << each.name;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(each.vertices.row(axis).minCoeff(), trunk.vertices.row(axis).minCoeff() - 1e-12) << each.name;
      EXPECT_LE(each.vertices.row(axis).maxCoeff(), trunk.vertices.row(axis).maxCoeff() + 1e-12) << each.name;
    }
  }
}

TEST_F(Thorax, AbsorbsNowhereLessThanAirOrMoreThanBone) {
  const Absorbers found = *AbsorbersAt(*model_, model_->InitialState());
  const Picture picture = Shown(found),
                trunk = LineIntegrals({found.all.back()}, ProjectionOf({}, found.isocentre), kPixels);
  const double wall = CoefficientOf(Tissue::kWall);
  const Eigen::ArrayXXd thickness = trunk / wall;
  EXPECT_GT((picture - CoefficientOf(Tissue::kAir) * thickness).minCoeff(), -0.05) << "nothing counts twice";
  EXPECT_LT((picture - CoefficientOf(Tissue::kCortical) * thickness).maxCoeff(), 0.05);
}

// A lung's tissue keeps its mass: its density falls as its volume rises, and a deep breath is darker.
TEST_F(Thorax, LungsKeepTheirMassInADeepBreath) {
  const State inspired = Inspired();
  const Absorbers before = *AbsorbersAt(*model_, model_->InitialState()), after = *AbsorbersAt(*model_, inspired);
  for (size_t i = 0; i < before.lungs.size(); ++i) {
    const auto of = [&](const Absorbers& found) {
      for (const Absorber& each : found.all) {
        if (each.name == before.lungs[i].name) return VolumeInPicture(each, found.isocentre);
      }
      return 0.0;
    };
    EXPECT_GT(of(after), 1.2 * of(before)) << before.lungs[i].name;
    EXPECT_NEAR(after.lungs[i].density * of(after), before.lungs[i].density * of(before),
                0.01 * before.lungs[i].density * of(before))
        << before.lungs[i].name << ": mass [g/cm3 x m3]";
    EXPECT_NEAR(before.lungs[i].density, 0.3, 1e-9);
  }
  // A ray through the right lung, at the isocentre's height.
  const int row = kPixels / 2, column = kPixels / 4;
  EXPECT_LT(Shown(after)(row, column), 0.9 * Shown(before)(row, column));
}

TEST_F(Thorax, IsWrittenAsPngAndAsNifti) {
  const Absorbers found = *AbsorbersAt(*model_, model_->InitialState());
  const Picture picture = Shown(found);
  const Window window = WindowOf(picture);
  EXPECT_LT(window.low, 2.5) << "lungs";
  EXPECT_GT(window.high, 4) << "spine and abdomen";
  EXPECT_THAT(WritePng(picture, window, false), StartsWith("\x89PNG\r\n\x1a\n"));
  const std::string nifti = WriteNifti(picture, ProjectionOf({}, found.isocentre));
  EXPECT_EQ(nifti.size(), 352u + 4u * kPixels * kPixels);
}

TEST(Absorbers, OfASceneWithoutTissueAreAnError) {
  const auto model = CompileText(kTriangle);
  if (model == nullptr) return;
  EXPECT_FALSE(AbsorbersAt(*model, model->InitialState()).ok());
}

// Lobes beside a lung would count twice; without one they are the lungs.
TEST(Absorbers, OfLobesAreLungsOnlyInAbsenceOfALung) {
  const auto lungs_of = [](const std::vector<std::string>& names) {
    std::string text = kTriangle;
    for (const std::string& name : names) {
      text += "bodies { name: '" + name + R"(' role: ROLE_AT_REST polyhedron {
        vertices {} vertices { x: 0.1 } vertices { y: 0.1 } vertices { z: 0.1 }
        triangles { a: 0 b: 2 c: 1 } triangles { a: 0 b: 1 c: 3 }
        triangles { a: 0 b: 3 c: 2 } triangles { a: 1 b: 2 c: 3 } } })";
    }
    std::vector<std::string> found;
    const auto model = CompileText(text);
    if (model == nullptr) return found;
    const auto absorbers = AbsorbersAt(*model, model->InitialState());
    EXPECT_TRUE(absorbers.ok());
    for (const LungNow& lung : absorbers->lungs) found.push_back(lung.name);
    return found;
  };
  EXPECT_THAT(lungs_of({"lobe-upper-left", "lung-left"}), ElementsAre("lung-left"));
  EXPECT_THAT(lungs_of({"lobe-upper-left", "lobe-lower-left"}), ElementsAre("lobe-upper-left", "lobe-lower-left"));
}

TEST(LungCoefficient, FallsWithVolumeToThatOfAir) {
  EXPECT_GT(LungCoefficient(1, 1), LungCoefficient(1, 2));
  EXPECT_NEAR(LungCoefficient(1, 1), 5.8, 0.1) << "0.3 g/cm3";
  EXPECT_NEAR(LungCoefficient(1, 1e9), CoefficientOf(Tissue::kAir), 1e-6);
}

// NIST's values at 60 and 80 keV enclose those at 70 keV.
TEST(Coefficients, LieBetweenThoseOfTheTable) {
  const auto between = [](double value, double at60, double at80, double density) {
    EXPECT_LT(value, 100 * at60 * density);
    EXPECT_GT(value, 100 * at80 * density);
  };
  between(CoefficientOf(Tissue::kCortical), 0.3148, 0.2229, 1.92);
  between(CoefficientOf(Tissue::kOrgan), 0.2048, 0.1823, 1.06);
  between(CoefficientOf(Tissue::kBlood), 0.2057, 0.1827, 1.06);
  between(CoefficientOf(Tissue::kFluid), 0.2059, 0.1837, 1.015);
  between(CoefficientOf(Tissue::kAir), 0.1875, 0.1662, 0.0012);
}

TEST(TissueOf, IsToldByNameBeforeLayer) {
  EXPECT_EQ(TissueOf("disc-t1", "discs"), Tissue::kCartilage);
  EXPECT_EQ(TissueOf("t12", "spine"), Tissue::kVertebra);
  EXPECT_EQ(TissueOf("rib-3-left", "ribs"), Tissue::kRib);
  EXPECT_EQ(TissueOf("cartilage-3-left", "cartilages"), Tissue::kCartilage);
  EXPECT_EQ(TissueOf("superior-vena-cava", "caval-veins"), Tissue::kBlood);
  EXPECT_EQ(TissueOf("kidney-left", "kidneys"), Tissue::kOrgan);
  EXPECT_EQ(TissueOf("lobe-upper-left", "upper-lobes"), Tissue::kLung);
  // The shoulder girdle is outside of the trunk's outline.
  EXPECT_EQ(TissueOf("fissure-oblique-left", "fissures"), std::nullopt);
  EXPECT_EQ(TissueOf("clavicle-left", "clavicles"), std::nullopt);
  EXPECT_EQ(TissueOf("scapula-left", "scapulae"), std::nullopt);
  EXPECT_EQ(TissueOf("right-lower", "lungs"), Tissue::kLung);
  EXPECT_EQ(TissueOf("chest-wall", "mechanics"), std::nullopt);
  EXPECT_EQ(TissueOf("cloth", "cloth"), std::nullopt);
}

}  // namespace
}  // namespace phrenic::fluoroscopy
