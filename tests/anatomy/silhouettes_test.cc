// Generated bones beside those of a real thorax: silhouettes from six views after a similarity registration.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "server/mesh/ellipsoid.h"
#include "server/mesh/units.h"
#include "server/meshio/meshio.h"
#include "tests/anatomy/parts.h"
#include "tests/anatomy/silhouette.h"

namespace phrenic::anatomy {
namespace {

constexpr const char* kOrdinals[] = {"first",   "second", "third", "fourth", "fifth",    "sixth",
                                     "seventh", "eighth", "ninth", "tenth",  "eleventh", "twelfth"};

std::string RealFolder() { return std::string(PHRENIC_SHARED_DIR) + "/data/thorax"; }

// A bone, and the name with which the file of the real one begins.
struct BonePair {
  v1::Anatomy part;
  std::string folder, file;
};

std::vector<BonePair> Pairs() {
  std::vector<BonePair> pairs = {{Part(v1::STRUCTURE_MANUBRIUM), "sternum", "manubrium"},
                                 {Part(v1::STRUCTURE_STERNUM_BODY), "sternum", "body_of_sternum"},
                                 {Part(v1::STRUCTURE_XIPHOID), "sternum", "xiphoid_process"}};
  for (int i = 1; i <= 12; ++i) {
    const std::string name = std::string(kOrdinals[i - 1]) + "_rib";
    pairs.push_back({Part(v1::STRUCTURE_RIB, i, v1::SIDE_RIGHT), "ribs", "right_" + name});
    pairs.push_back({Part(v1::STRUCTURE_RIB, i, v1::SIDE_LEFT), "ribs", "left_" + name});
  }
  for (int i = 1; i <= 15; ++i) {
    const std::string name =
        i <= 12 ? std::string(kOrdinals[i - 1]) + "_thoracic" : std::string(kOrdinals[i - 13]) + "_lumbar";
    pairs.push_back({Part(v1::STRUCTURE_VERTEBRA, i), "spine", name + "_vertebra"});
  }
  return pairs;
}

Mesh RealBone(const BonePair& pair) {
  for (const auto& entry : std::filesystem::directory_iterator(RealFolder() + "/" + pair.folder)) {
    if (!entry.path().filename().string().starts_with(pair.file + "_")) continue;
    auto mesh = meshio::ReadFile(entry.path().string(), 1e-3);
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    return mesh.ok() ? *std::move(mesh) : Mesh();
  }
  ADD_FAILURE() << "no file of " << pair.file;
  return {};
}

// The mean distances of a bone's outlines from those of another, after registration [mm].
struct Comparison {
  std::array<double, kViews.size()> views;
  double scale;
  double Mean() const { return std::accumulate(views.begin(), views.end(), 0.0) / static_cast<double>(views.size()); }
};

Comparison Compare(Mesh bone, const Mesh& other) {
  const Eigen::Affine3d moved = Registered(bone, other);
  bone.vertices = moved * bone.vertices;
  const Eigen::Vector3d centre = other.vertices.rowwise().mean();
  Comparison result{{}, std::cbrt(moved.linear().determinant())};
  for (size_t i = 0; i < kViews.size(); ++i) {
    result.views[i] = MeanDistance(Outline(bone, kViews[i], centre), Outline(other, kViews[i], centre)) / kMillimetre;
  }
  return result;
}

// True if the silhouettes are alike on average and in each view, and the bones of about one size: most differ by less
// than a tenth, the first rib is a fifth longer than the real one.
bool IsAlike(const Comparison& found) {
  return found.Mean() < 3 && std::ranges::max(found.views) < 4 && found.scale > 0.8 && found.scale < 1.2;
}

TEST(Silhouettes, OfSpheresAreTheirRadiiApart) {
  const Eigen::Vector3d centre(0.1, -0.2, 0.3);
  const Mesh small = EllipsoidSurface(centre, Eigen::Vector3d::Constant(0.02), 24, false),
             large = EllipsoidSurface(centre, Eigen::Vector3d::Constant(0.023), 24, false);
  for (const View view : kViews) {
    EXPECT_NEAR(MeanDistance(Outline(small, view, centre), Outline(large, view, centre)), 0.003, 0.0003);
  }
}

TEST(Silhouettes, ABoneThatWasTurnedShiftedAndScaledIsFoundAgain) {
  const Mesh& bone = MeshOf(Part(v1::STRUCTURE_VERTEBRA, 9));
  const Eigen::Affine3d moved = Eigen::Translation3d(0.3, -0.1, 1) * Eigen::Scaling(1.15) *
                                Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, -1).normalized());
  Mesh other = bone;
  other.vertices = moved * bone.vertices;
  const Comparison same = Compare(bone, other);
  EXPECT_NEAR(same.scale, 1.15, 0.005);
  EXPECT_LT(same.Mean(), 0.3);
}

class RealThorax : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(RealFolder() + "/ribs")) GTEST_SKIP() << "the anatomical surfaces are missing";
  }
};

TEST_F(RealThorax, HasTheSilhouettesOfGeneratedBones) {
  std::printf("%-26s %6s %6s %6s %6s %6s %6s %6s mm %6s\n", "", "mean", "front", "back", "left", "right", "above",
              "below", "scale");
  std::map<std::string, std::vector<double>> means;  // by folder
  for (const BonePair& pair : Pairs()) {
    const Comparison found = Compare(MeshOf(pair.part), RealBone(pair));
    std::printf("%-26s %6.2f", pair.file.c_str(), found.Mean());
    for (const double view : found.views) std::printf(" %6.2f", view);
    std::printf("    %6.3f\n", found.scale);
    EXPECT_TRUE(IsAlike(found)) << pair.file;
    means[pair.folder].push_back(found.Mean());
  }
  const auto mean = [&](const char* folder) {
    return std::accumulate(means[folder].begin(), means[folder].end(), 0.0) / static_cast<double>(means[folder].size());
  };
  std::printf("mean of the ribs %.2f, the sternum %.2f, the spine %.2f mm\n", mean("ribs"), mean("sternum"),
              mean("spine"));
  EXPECT_LT(mean("ribs"), 2.35);
  EXPECT_LT(mean("sternum"), 2.55);
  EXPECT_LT(mean("spine"), 2.1);
}

// A rib is a slender arc, which a similarity brings near to its neighbours: rib 6 is 2.3 mm from the real rib 10. Size
// and shape together tell bones apart that are further from each other.
TEST_F(RealThorax, HasOtherSilhouettesOrSizesThanOtherBones) {
  const auto fits = [](const v1::Anatomy& part, const char* folder, const char* file) {
    return IsAlike(Compare(MeshOf(part), RealBone({{}, folder, file})));
  };
  const v1::Anatomy rib = Part(v1::STRUCTURE_RIB, 6, v1::SIDE_LEFT);
  EXPECT_FALSE(fits(rib, "ribs", "left_first_rib"));
  EXPECT_FALSE(fits(rib, "ribs", "left_second_rib"));
  EXPECT_FALSE(fits(rib, "ribs", "left_twelfth_rib"));
  EXPECT_FALSE(fits(Part(v1::STRUCTURE_VERTEBRA, 5), "spine", "second_lumbar_vertebra"));
  EXPECT_FALSE(fits(Part(v1::STRUCTURE_MANUBRIUM), "sternum", "body_of_sternum"));
}

}  // namespace
}  // namespace phrenic::anatomy
