// Ribs in one label are divided, compared with the same volume with one label per rib.
#include "server/imaging/segmented_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "server/imaging/labels/label_map.h"
#include "server/imaging/phantom.h"

namespace phrenic::imaging {
namespace {

constexpr Label kRibs = 200;

bool IsRib(const v1::LabelMeaning& label) { return label.anatomy().structure() == v1::STRUCTURE_RIB; }

// Replaces the ribs' labels by a single one, in volume and map.
void JoinRibs(LabelVolume& volume, v1::LabelMap& map) {
  std::vector<bool> rib(256, false);
  for (const v1::LabelMeaning& label : map.labels()) rib[label.number()] = IsRib(label);
  std::replace_if(
      volume.labels.begin(), volume.labels.end(), [&rib](Label label) { return rib[label]; }, kRibs);
  auto& labels = *map.mutable_labels();
  labels.erase(std::remove_if(labels.begin(), labels.end(), IsRib), labels.end());
  v1::LabelMeaning& ribs = *map.add_labels();
  ribs.set_number(kRibs);
  ribs.set_name("ribs");
  ribs.mutable_anatomy()->set_structure(v1::STRUCTURE_RIB);
}

// Returns the ribs' centroids [mm].
std::map<std::string, Eigen::Vector3d> Ribs(const LabelVolume& volume, const v1::LabelMap& map, Fallbacks& fallbacks) {
  std::map<std::string, Eigen::Vector3d> centroids;
  const auto parts = FindParts(volume, map, fallbacks);
  EXPECT_TRUE(parts.ok()) << parts.status();
  for (const Part& part : *parts) {
    if (!part.Is(v1::STRUCTURE_RIB)) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t at = 0; at < part.mask.inside.size(); ++at) {
      if (part.mask.inside[at] == 1) sum += part.mask.Position(volume, at);
    }
    centroids[part.name] = sum / static_cast<double>(part.mask.Count());
  }
  return centroids;
}

// Returns the last fallback of a kind; null without one of it.
const Fallback* Of(v1::AssumptionKind kind, const Fallbacks& fallbacks) {
  const Fallback* last = nullptr;
  for (const Fallback& fallback : fallbacks) {
    if (fallback.kind == kind) last = &fallback;
  }
  return last;
}

class RibsInOneLabel : public testing::TestWithParam<const char*> {};

TEST_P(RibsInOneLabel, GetTheirSidesAndNumbers) {
  v1::LabelMap map = *ReadLabelMap("totalsegmentator");
  auto volume = MakePhantom(*FindPhantomBody(GetParam()), {.voxel = 2, .noise = 0.02, .holes = 40}, map);
  ASSERT_TRUE(volume.ok()) << volume.status();
  Fallbacks fallbacks;
  const auto truth = Ribs(*volume, map, fallbacks);
  JoinRibs(*volume, map);
  const auto found = Ribs(*volume, map, fallbacks);
  ASSERT_EQ(truth.size(), 24u);
  const Fallback* left = Of(v1::ASSUMPTION_KIND_RIBS_DIVIDED, fallbacks);
  ASSERT_NE(left, nullptr);
  EXPECT_THAT(left->text, testing::HasSubstr("ribs on the left: one label, divided into 12"));
  EXPECT_THAT(left->parts, testing::ElementsAre("left"));
  EXPECT_THAT(left->values, testing::ElementsAre(12));
  for (const auto& [name, middle] : truth) {
    ASSERT_TRUE(found.contains(name)) << name;
    EXPECT_LT((found.at(name) - middle).norm(), 4) << name;
  }
}

// A thirteenth rib has no place in the maps, and must not become a second "rib-1-left".
TEST(RibsWithNumbers, StayAloneBesideALabelOfRibsWithoutANumber) {
  v1::LabelMap map = *ReadLabelMap("totalsegmentator");
  auto volume = MakePhantom(*FindPhantomBody("adult"), {.voxel = 4, .noise = 0, .holes = 0}, map);
  ASSERT_TRUE(volume.ok()) << volume.status();
  for (v1::LabelMeaning& label : *map.mutable_labels()) {
    if (label.name() != "rib_left_12") continue;
    label.set_name("ribs");
    label.mutable_anatomy()->set_number(0);
    label.mutable_anatomy()->set_side(v1::SIDE_UNSPECIFIED);
  }
  Fallbacks fallbacks;
  const auto parts = FindParts(*volume, map, fallbacks);
  ASSERT_TRUE(parts.ok()) << parts.status();
  const auto named = [&](const char* name) {
    return std::count_if(parts->begin(), parts->end(), [&](const Part& part) { return part.name == name; });
  };
  EXPECT_EQ(named("rib-1-left"), 1);
  EXPECT_EQ(named("rib-12-left"), 0);
  const Fallback* out = Of(v1::ASSUMPTION_KIND_RIBS_LEFT_OUT, fallbacks);
  ASSERT_NE(out, nullptr);
  EXPECT_THAT(out->text, testing::HasSubstr("without a number was left out"));
}

// The bodies whose lowest ribs are less than two voxels apart.
// Files are named after labels.
TEST(LabelNames, AreNoPaths) {
  v1::LabelMap map = *ReadLabelMap("totalsegmentator");
  const auto volume = MakePhantom(*FindPhantomBody("small"), {.voxel = 4}, map);
  ASSERT_TRUE(volume.ok()) << volume.status();
  for (const char* name : {"../../lung", "lung.left", "", "a\\b", "lung\n"}) {
    map.mutable_labels(0)->set_name(name);
    for (v1::LabelMeaning& label : *map.mutable_labels()) {
      if (IsRib(label)) label.set_name(name);
    }
    Fallbacks fallbacks;
    const absl::Status status = FindParts(*volume, map, fallbacks).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << name << ": " << status;
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, RibsInOneLabel, testing::Values("small", "flat"));

}  // namespace
}  // namespace phrenic::imaging
