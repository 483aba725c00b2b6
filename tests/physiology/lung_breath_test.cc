// Lung tissue in the breaths of the thorax: its laws, what each cause does to it, and its files in other programs.
#include "server/physiology/lung_breath.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "server/mechanics/compile/presets.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

using physiology::BreathingLungs;
using physiology::LungCauses;
using physiology::LungReading;
using physiology::Subject;

constexpr size_t kRight = 0, kLeft = 1;

class LungBreath : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    model_ = CoarseThorax();
    subject_ = CoarseSubject();
  }
  static void TearDownTestSuite() {
    subject_.reset();
    model_.reset();
  }

  static const physiology::Recording& Breath(const std::string& preset) { return CoarseBreath(preset); }
  static v1::Parameters Parameters(const std::string& preset) {
    v1::Parameters parameters = model_->parameters;
    parameters.MergeFrom(*FindPreset(model_->scene, preset));
    return parameters;
  }
  static std::vector<LungReading> Read(const std::string& preset,
                                       const LungElasticity& elasticity = physiology::DrivenLungs(),
                                       LungCauses causes = {}) {
    const auto lungs = BreathingLungs::Make(*subject_, elasticity, causes);
    return lungs->Readings(lungs->Motions(Breath(preset)));
  }
  // The air of the breath [m^3].
  static double Air(const std::string& preset) {
    const physiology::Recording& breath = Breath(preset);
    return breath.of[physiology::kVolume][breath.peak_sample] - breath.of[physiology::kVolume].front();
  }
  static std::vector<LungReading> Without(const std::string& preset, LungCauses causes) {
    return Read(preset, physiology::DrivenLungs(), causes);
  }
  static LungElasticity Glued() {
    LungElasticity glued = physiology::DrivenLungs();
    glued.tangential = glued.contact;
    return glued;
  }
  // Mean descent of the tissue at each hilum, of a quiet breath [m].
  static std::array<double, 2> DescentOfHila(LungCauses causes) {
    const auto lungs = BreathingLungs::Make(*subject_, physiology::DrivenLungs(), causes);
    std::array<double, 2> descents = {};
    for (const LungMotion& motion : lungs->Motions(Breath("quiet"))) {
      const LungTissue& tissue = motion.tissue;
      const bool left = tissue.box().center().x() > 0;
      const LungRoot root = {left ? 1.0 : -1.0, tissue.box()};
      double area = 0, moment = 0;
      for (Eigen::Index p = 0; p < tissue.areas().size(); ++p) {
        const Eigen::Vector3d point = tissue.points().col(p), normal = tissue.normals().col(p);
        if (!root.Holds(point, normal)) continue;
        area += tissue.areas()[p];
        moment -= tissue.areas()[p] * tissue.DisplacementAt(motion.nodes, point).z();
      }
      descents[left ? kLeft : kRight] = moment / area;
    }
    return descents;
  }
  static double BackOverFront(const LungReading& lung) {
    return lung.gained[physiology::kLungBack] / lung.gained[physiology::kLungFront];
  }
  static double BaseOverApex(const LungReading& lung) {
    return lung.gained[physiology::kLungBase] / lung.gained[physiology::kLungApex];
  }

  inline static std::shared_ptr<const Model> model_;
  inline static std::shared_ptr<const Subject> subject_;
};

TEST_F(LungBreath, TouchesDiaphragmWallAndMediastinum) {
  const auto lungs = *BreathingLungs::Make(*subject_);
  for (const size_t lung : {kRight, kLeft}) {
    EXPECT_GT(lungs.Share(lung, LungNeighbour::kDiaphragm), 0.07);
    EXPECT_GT(lungs.Share(lung, LungNeighbour::kWall), 0.5);
    EXPECT_GT(lungs.Share(lung, LungNeighbour::kMediastinum), 0.1);
    EXPECT_GT(lungs.Share(lung, LungNeighbour::kNone), 0.05);  // the margin
    EXPECT_LT(lungs.Share(lung, LungNeighbour::kNone), 0.13);
  }
}

// The tissue gains the air that the pressures move; following what touches it at rest alone, less than two thirds of a
// quiet breath.
TEST_F(LungBreath, GainsTheAirOfTheBreath) {
  for (const char* preset : {"quiet", "deep", "palsy-right", "ventilator", "upright"}) {
    const auto lungs = Read(preset);
    EXPECT_NEAR(lungs[kRight].volume + lungs[kLeft].volume, Air(preset), 0.02 * Air(preset)) << preset;
  }
  const auto unfilled = Without("quiet", {.space = false});
  EXPECT_LT(unfilled[kRight].volume + unfilled[kLeft].volume, 0.67 * Air("quiet"));
}

// Supine, the back gains more, because it is less stretched by the weight; without weight it does not.
TEST_F(LungBreath, VentilatesTheDependentPartMore) {
  const auto supine = Read("quiet"), weightless = Without("quiet", {.weight = false});
  for (const size_t lung : {kRight, kLeft}) {
    EXPECT_GT(BackOverFront(supine[lung]), 1.25);
    EXPECT_LT(BackOverFront(weightless[lung]), 1.15);
  }
}

// Upright, weight moves air from apex to base, and does nothing from front to back.
TEST_F(LungBreath, VentilatesTheBaseMoreUpright) {
  const auto upright = Read("upright"), weightless = Without("upright", {.weight = false});
  for (const size_t lung : {kRight, kLeft}) {
    EXPECT_GT(BaseOverApex(upright[lung]), 1.3 * BaseOverApex(weightless[lung]));
    EXPECT_NEAR(BackOverFront(upright[lung]), BackOverFront(weightless[lung]), 0.08);
  }
}

// People's hila descend by 0.33 to 0.64 of what the lower third does (regions_of_people.py).
TEST_F(LungBreath, IsHeldAtItsRoot) {
  const auto rooted = Read("quiet"), rootless = Without("quiet", {.root = false});
  const std::array<double, 2> held = DescentOfHila({}), free = DescentOfHila({.root = false});
  for (const size_t lung : {kRight, kLeft}) {
    std::printf("hilum %.1f mm, without its root %.1f; base over apex %.2f, %.2f\n", 1e3 * held[lung], 1e3 * free[lung],
                BaseOverApex(rooted[lung]), BaseOverApex(rootless[lung]));
    EXPECT_LT(held[lung], 0.9 * free[lung]);
    EXPECT_GT(BaseOverApex(rooted[lung]), BaseOverApex(rootless[lung]));
  }
}

// The base gains about what the apex does, as in people (0.35 to 1.66; median right 0.95, left 1.09), because the
// pressure that fills the lungs pushes nothing through the wall, and their bulk modulus is well above the shear
// modulus.
TEST_F(LungBreath, VentilatesTheBaseAboutAsTheApexSupine) {
  LungElasticity compressible = physiology::DrivenLungs();
  compressible.poisson = 0.2;
  const auto supine = Read("quiet"), other = Read("quiet", compressible);
  EXPECT_GT(BaseOverApex(supine[kRight]), 0.85);
  EXPECT_GT(BaseOverApex(supine[kLeft]), 1);
  EXPECT_LT(BaseOverApex(other[kRight]), 0.95 * BaseOverApex(supine[kRight]));
}

// The margin slides into the recess: the base widens there. Bound, it is drawn down with the sheet instead.
TEST_F(LungBreath, WidensAtTheBaseWhereItsMarginIsFree) {
  const auto is_free = BreathingLungs::Make(*subject_),
             bound = BreathingLungs::Make(*subject_, physiology::DrivenLungs(), {.margin = false});
  const auto with = Read("quiet"), without = Without("quiet", {.margin = false});
  for (const size_t lung : {kRight, kLeft}) {
    EXPECT_LT(bound->Share(lung, LungNeighbour::kNone), 0.7 * is_free->Share(lung, LungNeighbour::kNone));
    EXPECT_GT(BaseOverApex(with[lung]), BaseOverApex(without[lung]));
  }
}

// A ventilator pushes the upper part of the domes down, where the abdomen presses least: air moves forward.
TEST_F(LungBreath, MovesForwardWithAVentilator) {
  const auto breathes = Read("quiet"), ventilated = Read("ventilator");
  for (const size_t lung : {kRight, kLeft}) {
    EXPECT_LT(BackOverFront(ventilated[lung]), 0.9 * BackOverFront(breathes[lung]));
  }
}

// ../shared/physiology.md: more at the base than at the apex, more at the back than in front.
TEST_F(LungBreath, MovesDownMostAtTheBaseAndTheBack) {
  for (const LungReading& lung : Read("quiet")) {
    EXPECT_GT(lung.caudal[physiology::kLungBase], lung.caudal[physiology::kLungMiddle]);
    EXPECT_GT(lung.caudal[physiology::kLungMiddle], lung.caudal[physiology::kLungApex]);
    EXPECT_GT(lung.caudal[physiology::kLungApex], 0);
    EXPECT_GT(lung.back_over_front, 1.3);
    EXPECT_LT(lung.upwards, 0.1);
  }
}

// What is measured as the lungs' motion is that of their tissue: the seen surfaces follow the ribs up.
TEST_F(LungBreath, IsWhatTheTableMeasures) {
  const physiology::Recording& quiet = Breath("quiet");
  const auto tissue = physiology::ShiftOf(physiology::LoweredInBreath(quiet));
  const auto surfaces = physiology::ShiftOf(physiology::LoweredLungs(*model_, subject_->parts, quiet.base, quiet.peak));
  EXPECT_GT(tissue.least, 0);
  EXPECT_LT(surfaces.least, 0);
  EXPECT_GT(tissue.base, surfaces.base + 0.001);
}

TEST_F(LungBreath, MovesUpAtTheTopWhereItIsGlued) {
  const auto slides = Read("quiet"), glued = Read("quiet", Glued());
  for (const size_t lung : {kRight, kLeft}) {
    EXPECT_GT(glued[lung].upwards, 0.2);
    EXPECT_LT(glued[lung].caudal[physiology::kLungMiddle], 0.5 * slides[lung].caudal[physiology::kLungMiddle]);
    EXPECT_LT(glued[lung].caudal[physiology::kLungApex], 0);
  }
}

// The side that the diaphragm leaves is drawn up and gets less air; in health both get alike.
TEST_F(LungBreath, IsVentilatedLessWhereTheDiaphragmIsParalysed) {
  const auto health = Read("quiet"), palsy = Read("palsy-right");
  EXPECT_NEAR(health[kRight].volume / health[kLeft].volume, 1.1, 0.2);
  EXPECT_LT(palsy[kRight].volume, 0.7 * palsy[kLeft].volume);
  EXPECT_LT(palsy[kRight].gained[physiology::kLungBase], 0.5 * palsy[kLeft].gained[physiology::kLungBase]);
  EXPECT_LT(palsy[kRight].gained[physiology::kLungBase], health[kRight].gained[physiology::kLungBase]);
  EXPECT_LT(palsy[kRight].caudal[physiology::kLungBase], 0);
  EXPECT_GT(palsy[kLeft].caudal[physiology::kLungBase], 0.01);
}

TEST_F(LungBreath, StandsStillBehindAnOpenPleura) {
  const auto open = Read("pneumothorax-right");
  EXPECT_EQ(open[kRight].volume, 0);
  EXPECT_GT(open[kLeft].volume, 1e-4);
}

bool Runs(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

// VTK reads the image and nibabel the displacement; they must agree with each other in LPS.
TEST_F(LungBreath, IsReadByVtkAndNibabelAlike) {
  const std::string python = "/usr/bin/python3 ";
  if (!Runs(python + "-c 'import vtk'")) GTEST_SKIP() << "VTK is not installed (python3-vtk9)";
  if (!Runs(python + "-c 'import nibabel'")) GTEST_SKIP() << "nibabel is not installed (python3-nibabel)";
  const std::string vti = testing::TempDir() + "phrenic_lungs.vti", nii = testing::TempDir() + "phrenic_lungs.nii.gz",
                    vtu = testing::TempDir() + "phrenic_lungs.vtu";
  const std::string lungs =
      PHRENIC_BINARY_DIR "/phrenic lungs thorax --resolution 20 --preset quiet --spacing 12 --grid ";
  ASSERT_TRUE(Runs(lungs + vti));
  ASSERT_TRUE(Runs(lungs + nii));
  ASSERT_TRUE(Runs(lungs + vtu));
  EXPECT_EQ(
      std::system(
          (python + PHRENIC_SOURCE_DIR "/tests/physiology/read_lung_fields.py " + vti + " " + nii + " " + vtu).c_str()),
      0);
  std::remove(vti.c_str());
  std::remove(nii.c_str());
  std::remove(vtu.c_str());
}

}  // namespace
}  // namespace phrenic
