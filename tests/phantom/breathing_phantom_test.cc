// Laws of a 4D phantom: volumes, displacement, mass.
#include "server/phantom/breathing_phantom.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "absl/strings/match.h"
#include "server/imaging/voxelise.h"
#include "server/mesh/normals.h"
#include "server/phantom/hounsfield.h"
#include "tests/compile_text.h"
#include "tests/phantom/small_breath.h"
#include "tests/small_scenes.h"

namespace phrenic::phantom {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Phantom : public SmallBreath {
 protected:
  // Returns the Dice coefficient of each structure between its label at rest and what the field fetches from the peak:
  // the label at x + `share` u(x).
  static std::map<std::string, double> Dice(double share) {
    const imaging::LabelVolume& from = rest_.labels;
    std::vector<double> both(All().size(), 0), either(All().size(), 0);
    std::size_t voxel = 0;
    for (int k = 0; k < from.size.z(); ++k) {
      for (int j = 0; j < from.size.y(); ++j) {
        for (int i = 0; i < from.size.x(); ++i, ++voxel) {
          const Eigen::Vector3d moved =
              Eigen::Vector3d(i, j, k) + share * peak_.field.col(static_cast<Eigen::Index>(voxel)) / kSpacing;
          const Eigen::Vector3i there = moved.array().round().cast<int>();
          const int a = from.labels[voxel];
          if (a == 0) continue;
          const int b = from.Contains(there) ? peak_.labels.labels[from.Index(there)] : 0;
          either[a - 1] += 1;
          if (b > 0) either[b - 1] += 1;
          if (a == b) both[a - 1] += 1;
        }
      }
    }
    std::map<std::string, double> dice;
    for (std::size_t s = 0; s < All().size(); ++s) dice[All()[s].name] = 2 * both[s] / std::max(either[s], 1.0);
    return dice;
  }

  // Returns the mass of a structure by its CT numbers, or with one CT number [g].
  static double Mass(const Structure& structure, const PhantomPhase& phase, std::optional<double> hounsfield = {}) {
    double mass = 0;
    for (std::size_t v = 0; v < phase.ct.size(); ++v) {
      if (phase.labels.labels[v] == structure.number) mass += DensityOf(hounsfield.value_or(phase.ct[v]));
    }
    return mass * std::pow(kSpacing / 10, 3);
  }
};

TEST_F(Phantom, LabelsHaveTheVolumesOfTheSurfaces) {
  for (std::size_t phase = 0; phase < 2; ++phase) {
    const PhantomPhase& rendered = phase == 0 ? rest_ : peak_;
    for (std::size_t s = 0; s < All().size(); ++s) {
      const StructureVoxels& voxels = rendered.structures[s];
      const Mesh surface = phantom_->SurfaceOf(All()[s], phase);
      const double area = 1e6 * VertexAreas(surface.vertices, surface.triangles).sum();
      const double volume = static_cast<double>(voxels.inside) * std::pow(kSpacing, 3);
      // Voxels at the surface are in or out by chance: of area / h^2 of them, twice the standard deviation and a half.
      const double allowed = 1.5 * std::pow(kSpacing, 3) * std::sqrt(area) / kSpacing;
      EXPECT_NEAR(volume, voxels.enclosed_mm3, allowed) << All()[s].name << " in phase " << phase;
      if (voxels.enclosed_mm3 > 2e5) {
        EXPECT_NEAR(volume / voxels.enclosed_mm3, 1, 0.02) << All()[s].name;
      }
      EXPECT_LE(voxels.labelled, voxels.inside);
    }
  }
}

TEST_F(Phantom, TheVolumesOfOnePhaseAreNotThoseOfAnother) {
  for (std::size_t s = 0; s < All().size(); ++s) {
    if (All()[s].tissue != fluoroscopy::Tissue::kLung) continue;
    EXPECT_GT(peak_.structures[s].enclosed_mm3, 1.3 * rest_.structures[s].enclosed_mm3);
  }
}

TEST_F(Phantom, EveryVoxelThatIsCountedHasItsLabel) {
  std::vector<std::size_t> counted(All().size() + 1, 0);
  for (const imaging::Label label : peak_.labels.labels) ++counted[label];
  for (std::size_t s = 0; s < All().size(); ++s) EXPECT_EQ(counted[s + 1], peak_.structures[s].labelled);
}

TEST_F(Phantom, TheFieldBringsTheLabelsOfRestOntoThoseOfThePeak) {
  const std::map<std::string, double> with = Dice(1), without = Dice(0), backwards = Dice(-1);
  double mean_with = 0, mean_without = 0;
  for (const auto& [name, dice] : with) {
    EXPECT_GT(dice, 0.6) << name;  // cartilages are three voxels wide
    mean_with += dice / static_cast<double>(with.size());
    mean_without += without.at(name) / static_cast<double>(with.size());
  }
  EXPECT_GT(mean_with, 0.9);
  EXPECT_LT(mean_without, 0.65);
  for (const char* organ : {"lung_right", "lung_left", "liver", "heart", "stomach", "spleen"}) {
    EXPECT_GT(with.at(organ), 0.95) << organ;
    EXPECT_LT(without.at(organ), with.at(organ) - 0.05) << organ;
    EXPECT_LT(backwards.at(organ), without.at(organ)) << organ;
  }
  EXPECT_LT(phantom_->misfit(), 1.5e-3);
}

TEST_F(Phantom, TheFieldIsZeroOutsideTheLabelsOfRest) {
  for (std::size_t v = 0; v < rest_.labels.labels.size(); ++v) {
    if (rest_.labels.labels[v] == 0) {
      ASSERT_EQ(peak_.field.col(static_cast<Eigen::Index>(v)).norm(), 0);
    }
  }
}

TEST_F(Phantom, LungsKeepTheirMass) {
  for (const Structure& structure : All()) {
    if (structure.tissue != fluoroscopy::Tissue::kLung) continue;
    const double rest = Mass(structure, rest_), peak = Mass(structure, peak_);
    EXPECT_NEAR(peak / rest, 1, 0.025) << structure.name;
    EXPECT_GT(Mass(structure, peak_, LungHounsfield(1)) / rest, 1.3) << "a constant density gains mass";
  }
}

TEST_F(Phantom, TheTextureOfLungsMovesWithThemAndKeepsTheirMass) {
  absl::StatusOr<BreathingPhantom> textured = BreathingPhantom::Make(*model_, states_, {kSpacing, true, true, 0.5});
  ASSERT_TRUE(textured.ok());
  const PhantomPhase rest = *textured->Render(0, Go), peak = *textured->Render(1, Go);
  for (const Structure& structure : All()) {
    if (structure.tissue != fluoroscopy::Tissue::kLung) continue;
    EXPECT_NEAR(Mass(structure, peak) / Mass(structure, rest), 1, 0.025) << structure.name;
    // Correlation of the density at rest with what the field fetches, and with what is at the same place.
    Eigen::Matrix2d moments[2] = {Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
    for (int share = 0; share < 2; ++share) {
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      double count = 0;
      for (std::size_t v = 0; v < rest.ct.size(); ++v) {
        if (rest.labels.labels[v] != structure.number) continue;
        const std::size_t x = rest.labels.size.x(), layer = x * rest.labels.size.y();
        const Eigen::Vector3d at(static_cast<double>(v % x), static_cast<double>(v % layer / x),
                                 static_cast<double>(v / layer));
        const Eigen::Vector3i there =
            (at + share * peak.field.col(static_cast<Eigen::Index>(v)) / kSpacing).array().round().cast<int>();
        const std::size_t to = rest.labels.Index(there);
        if (!rest.labels.Contains(there) || peak.labels.labels[to] != structure.number) continue;
        const Eigen::Vector2d pair(rest.ct[v], peak.ct[to]);
        sum += pair, count += 1;
        moments[share] += pair * pair.transpose();
      }
      moments[share] = Eigen::Matrix2d(moments[share] / count - sum * sum.transpose() / (count * count));
      moments[share] /= std::sqrt(moments[share](0, 0) * moments[share](1, 1));
    }
    EXPECT_GT(moments[1](0, 1), 0.55) << structure.name << ": voxels of 4 mm are coarse for a grain of 10 mm";
    EXPECT_LT(moments[0](0, 1), moments[1](0, 1) - 0.3) << structure.name << " without the field";
  }
}

TEST_F(Phantom, TheFirstPhaseIsTheSceneAtRest) {
  EXPECT_EQ(rest_.time, 0);
  EXPECT_EQ(rest_.field.size(), 0);
  imaging::LabelVolume expected = rest_.labels;
  for (const Structure& structure : All()) {
    if (structure.name != "liver") continue;
    std::fill(expected.labels.begin(), expected.labels.end(), 0);
    imaging::Voxelise(model_->bodies[structure.body].mesh, 1, expected);
    std::size_t inside = 0, outside = 0;
    for (std::size_t v = 0; v < expected.labels.size(); ++v) {
      inside += expected.labels[v];
      if (rest_.labels.labels[v] == structure.number && expected.labels[v] == 0) ++outside;
    }
    EXPECT_NEAR(static_cast<double>(inside), static_cast<double>(rest_.structures[structure.number - 1].inside), 3);
    EXPECT_LE(outside, 3U);
  }
}

TEST_F(Phantom, IsTheSameEveryTime) {
  absl::StatusOr<BreathingPhantom> again = BreathingPhantom::Make(*model_, states_, {kSpacing, true, true});
  ASSERT_TRUE(again.ok());
  const absl::StatusOr<PhantomPhase> peak = again->Render(1, Go);  // without the first phase before it
  ASSERT_TRUE(peak.ok());
  EXPECT_EQ(peak->labels.labels, peak_.labels.labels);
  EXPECT_EQ(peak->ct, peak_.ct);
  EXPECT_EQ(peak->field, peak_.field);
}

TEST_F(Phantom, OfAbsurdSizeIsRefusedWithASpacingThatIsPossible) {
  const absl::Status refused = BreathingPhantom::Make(*model_, states_, {0.2, true, true}).status();
  EXPECT_TRUE(absl::IsInvalidArgument(refused));
  EXPECT_THAT(std::string(refused.message()), HasSubstr("or more is possible"));
  const Eigen::Vector3d sizes(400, 350, 450);
  const double smallest = SmallestSpacing(sizes);
  EXPECT_LE(((sizes / smallest).array().ceil() + 1).prod(), kMostPhantomVoxels);
  EXPECT_GT(((sizes / (0.8 * smallest)).array().ceil() + 1).prod(), kMostPhantomVoxels);
  EXPECT_TRUE(absl::IsInvalidArgument(BreathingPhantom::Make(*model_, {}, {}).status()));
}

TEST_F(Phantom, EndsWhenItIsToldTo) {
  int calls = 0;
  const auto stop = [&] { return ++calls > 5 ? absl::CancelledError("stop") : absl::OkStatus(); };
  EXPECT_TRUE(absl::IsCancelled(phantom_->Render(1, stop).status()));
  EXPECT_EQ(calls, 6);
}

TEST(Hounsfield, OfTissuesIsThatOfTextbooks) {
  using fluoroscopy::Tissue;
  EXPECT_NEAR(HounsfieldOf(Tissue::kMuscle), 45, 15);
  EXPECT_NEAR(HounsfieldOf(Tissue::kFluid), 15, 10);
  EXPECT_NEAR(HounsfieldOf(Tissue::kOrgan), 55, 15);
  EXPECT_NEAR(HounsfieldOf(Tissue::kAir), -1000, 5);
  EXPECT_GT(HounsfieldOf(Tissue::kCortical), 1000);
  EXPECT_GT(HounsfieldOf(Tissue::kRib), HounsfieldOf(Tissue::kVertebra));
  EXPECT_NEAR(LungHounsfield(1), -700, 5);
  for (double ratio = 0.4; ratio < 4; ratio += 0.1) {
    EXPECT_NEAR(DensityOf(LungHounsfield(ratio)) * ratio, 0.3, 0.004) << "mass at " << ratio;
  }
}

// Returns the phantom of one body, a tetrahedron that faces outwards or inwards.
absl::StatusOr<BreathingPhantom> PhantomOfTetrahedron(const std::string& name, bool outwards, bool ct, bool field,
                                                      std::shared_ptr<const Model>& model) {
  const std::string triangles = outwards ? R"(triangles { a: 0 b: 2 c: 1 } triangles { a: 0 b: 1 c: 3 }
                                              triangles { a: 0 b: 3 c: 2 } triangles { a: 1 b: 2 c: 3 })"
                                         : R"(triangles { a: 0 b: 1 c: 2 } triangles { a: 0 b: 3 c: 1 }
                                              triangles { a: 0 b: 2 c: 3 } triangles { a: 1 b: 3 c: 2 })";
  model = CompileText(Triangle("bodies { name: '" + name + R"(' role: ROLE_AT_REST polyhedron {
    vertices {} vertices { x: 0.2 } vertices { y: 0.2 } vertices { z: 0.2 })" +
                               triangles + "} }"));
  if (model == nullptr) return absl::InternalError("the scene has an error");
  return BreathingPhantom::Make(*model, {model->InitialState()}, {8, ct, field});
}

TEST(PhantomWithoutTissue, IsRefusedForALungAndListedForAnOrgan) {
  std::shared_ptr<const Model> model;
  const auto inwards = PhantomOfTetrahedron("lung-left", false, true, false, model);
  EXPECT_TRUE(absl::IsInvalidArgument(inwards.status()));
  EXPECT_THAT(std::string(inwards.status().message()), AllOf(HasSubstr("lung-left"), HasSubstr("outwards")));
  EXPECT_TRUE(PhantomOfTetrahedron("lung-left", false, false, false, model).ok()) << "labels need no tissue";
  EXPECT_TRUE(PhantomOfTetrahedron("lung-left", true, true, true, model).ok());
  const auto organ = PhantomOfTetrahedron("liver", false, true, true, model);
  ASSERT_TRUE(organ.ok()) << organ.status();
  EXPECT_THAT(organ->without_tissue(), ElementsAre("liver"));
  const auto whole = PhantomOfTetrahedron("liver", true, true, true, model);
  ASSERT_TRUE(whole.ok()) << whole.status();
  EXPECT_THAT(whole->without_tissue(), IsEmpty());
}

}  // namespace
}  // namespace phrenic::phantom
