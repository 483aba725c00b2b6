// A volume that is no thorax, or only part of one, gives an error with a remedy or a patient, and never ends the
// process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "absl/strings/match.h"
#include "server/imaging/label_file.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/patient/patient.h"
#include "server/imaging/phantom.h"
#include "server/schema/schema.h"

namespace phrenic::imaging {
namespace {

using Keep = std::function<bool(const v1::LabelMeaning& label, const Eigen::Vector3i& voxel)>;

// A coarse phantom, and what is left of it.
class OddVolumes : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    map_ = *ReadLabelMap("totalsegmentator");
    whole_ = *MakePhantom(*FindPhantomBody("small"), {7, 0, 0, 1}, map_);
    for (const v1::LabelMeaning& label : map_.labels()) meanings_[static_cast<Label>(label.number())] = label;
    pattern_ = *schema::ParseScene("pattern", R"(name: "pattern"
      layers { name: "diaphragm" } layers { name: "ribs" } layers { name: "sternum" } layers { name: "spine" }
      bodies { name: "diaphragm" role: ROLE_DEFORMABLE mass: 3 generated {} }
      motions { ribs { bodies: "ribs" end_states { number: 5 pump_degrees: 9 bucket_degrees: 12 } } }
      forces { action_line { bodies: "diaphragm" origin { x: -0.05 } direction { z: -1 } radius: 0.08 force: 4
                             fall_off: FALL_OFF_CYLINDER } })");
  }

  static LabelVolume Only(const Keep& keep) {
    LabelVolume volume = whole_;
    std::size_t at = 0;
    for (int k = 0; k < volume.size.z(); ++k) {
      for (int j = 0; j < volume.size.y(); ++j) {
        for (int i = 0; i < volume.size.x(); ++i, ++at) {
          Label& label = volume.labels[at];
          if (label != 0 && !keep(meanings_[label], {i, j, k})) label = 0;
        }
      }
    }
    return volume;
  }
  static absl::Status Make(const LabelVolume& volume) {
    PatientOptions options;
    options.edge_length = 15;
    options.diaphragm.vertices = 600;
    return MakePatient(volume, map_, pattern_, options, [](double, std::string_view) { return true; }).status();
  }
  // Its text says what to do.
  static void ExpectRemedy(const absl::Status& status, const std::string& what) {
    EXPECT_TRUE(absl::IsFailedPrecondition(status) || absl::IsInvalidArgument(status)) << what << ": " << status;
    const std::string text(status.message());
    EXPECT_TRUE(absl::StrContains(text, "check") || absl::StrContains(text, "label") || absl::StrContains(text, "map"))
        << what << ": " << text;
  }
  static bool Is(const v1::LabelMeaning& label, v1::Structure structure) {
    return label.anatomy().structure() == structure;
  }

  static v1::LabelMap map_;
  static v1::Scene pattern_;
  static LabelVolume whole_;
  static std::map<Label, v1::LabelMeaning> meanings_;
};

v1::LabelMap OddVolumes::map_;
v1::Scene OddVolumes::pattern_;
LabelVolume OddVolumes::whole_;
std::map<Label, v1::LabelMeaning> OddVolumes::meanings_;

TEST_F(OddVolumes, WithAnAxisReversedAreRefused) {
  const auto reversed = [](int axis) {
    LabelVolume volume = whole_;
    volume.to_patient =
        Eigen::Scaling(Eigen::Vector3d(Eigen::Vector3d::Ones() - 2 * Eigen::Vector3d::Unit(axis))) * volume.to_patient;
    return std::string(Make(volume).message());
  };
  EXPECT_THAT(reversed(0), testing::HasSubstr("the sides are exchanged"));
  EXPECT_THAT(reversed(1), testing::HasSubstr("front and back are exchanged"));
  EXPECT_NE(reversed(2), "");
  EXPECT_EQ(Make(whole_).message(), "");
}

// The size of what is fitted follows the height of the cage.
TEST_F(OddVolumes, AThoraxAsTallAsAHouseIsRefused) {
  LabelVolume tall = whole_;
  const auto first = std::find_if(meanings_.begin(), meanings_.end(), [](const auto& each) {
    return Is(each.second, v1::STRUCTURE_VERTEBRA) && each.second.anatomy().number() == 1;
  });
  const auto last = std::find(whole_.labels.rbegin(), whole_.labels.rend(), first->first);
  ASSERT_NE(last, whole_.labels.rend());
  const auto slice = static_cast<std::size_t>(tall.size.x()) * tall.size.y();
  const auto top = static_cast<std::size_t>(whole_.labels.rend() - last) - 1;
  tall.size.z() += 1000;
  tall.labels.resize(slice * tall.size.z(), 0);
  for (std::size_t at = top; at < tall.labels.size(); at += slice) tall.labels[at] = first->first;
  const absl::Status status = Make(tall);
  ExpectRemedy(status, "tall");
  EXPECT_TRUE(absl::StrContains(status.message(), "proportions")) << status;
}

TEST_F(OddVolumes, WithoutAStructureGiveAPatientOrARemedy) {
  const std::pair<const char*, Keep> kinds[] = {
      {"no lungs", [](const auto& label, const auto&) { return !Is(label, v1::STRUCTURE_LUNG); }},
      {"no ribs", [](const auto& label, const auto&) { return !Is(label, v1::STRUCTURE_RIB); }},
      {"no vertebrae", [](const auto& label, const auto&) { return !Is(label, v1::STRUCTURE_VERTEBRA); }},
      {"no organs", [](const auto& label, const auto&) { return label.organ() == v1::ORGAN_UNSPECIFIED; }},
      {"one of each",
       [](const auto& label, const auto&) {
         return label.anatomy().number() == 9 || (Is(label, v1::STRUCTURE_LUNG) && label.number() == 10);
       }},
      {"upper ribs alone",
       [](const auto& label, const auto&) { return !Is(label, v1::STRUCTURE_RIB) || label.anatomy().number() < 3; }},
      {"the highest vertebra alone",
       [](const auto& label, const auto&) {
         return !Is(label, v1::STRUCTURE_VERTEBRA) || label.anatomy().number() == 1;
       }},
      {"lungs and spine",
       [](const auto& label, const auto&) {
         return Is(label, v1::STRUCTURE_LUNG) || Is(label, v1::STRUCTURE_VERTEBRA) || label.anatomy().number() == 1;
       }},
      {"every fifth slice", [](const auto&, const Eigen::Vector3i& voxel) { return voxel.z() % 5 == 0; }},
      {"scattered voxels", [](const auto&, const Eigen::Vector3i& voxel) { return (voxel.sum() * 7919) % 31 == 0; }},
      {"the left half", [](const auto&, const Eigen::Vector3i& voxel) { return voxel.x() > whole_.size.x() / 2; }},
      {"the lower half", [](const auto&, const Eigen::Vector3i& voxel) { return voxel.z() < whole_.size.z() / 2; }},
  };
  for (const auto& [what, keep] : kinds) {
    const absl::Status status = Make(Only(keep));
    if (!status.ok()) ExpectRemedy(status, what);
  }
}

TEST_F(OddVolumes, InAnotherFrameGiveAPatientOrARemedy) {
  const std::pair<const char*, Eigen::Affine3d> frames[] = {
      {"upside down", Eigen::Affine3d(Eigen::Scaling(1., 1., -1.))},
      {"back to front", Eigen::Affine3d(Eigen::Scaling(1., -1., 1.))},
      {"on its side", Eigen::Affine3d(Eigen::AngleAxisd(1.5707963, Eigen::Vector3d::UnitY()))},
      {"a tenth", Eigen::Affine3d(Eigen::Scaling(0.1))},
      {"five times", Eigen::Affine3d(Eigen::Scaling(5.))},
      {"flat", Eigen::Affine3d(Eigen::Scaling(1., 1., 0.1))},
      {"far away", Eigen::Affine3d(Eigen::Translation3d(9e4, -9e4, 9e4))},
  };
  for (const auto& [what, frame] : frames) {
    LabelVolume volume = whole_;
    volume.to_patient = frame * volume.to_patient;
    const absl::Status status = Make(volume);
    if (!status.ok()) ExpectRemedy(status, what);
  }
}

TEST_F(OddVolumes, OfAnySizeWithoutAThoraxAreRefused) {
  for (const Eigen::Vector3i& size : {Eigen::Vector3i(1, 1, 1), {1, 1, 400}, {400, 1, 1}, {2, 2, 2}, {30, 30, 30}}) {
    for (const int label : {0, 5, 10, 92, 31, 65535}) {
      LabelVolume volume;
      volume.size = size;
      volume.labels.assign(static_cast<std::size_t>(size.prod()), static_cast<Label>(label));
      ExpectRemedy(Make(volume), absl::StrCat("label ", label));
    }
  }
}

// Each label alone in all voxels, up to the border, three at a time.
TEST_F(OddVolumes, OfSlabsThatTouchTheBorderAreRefused) {
  LabelVolume volume;
  volume.size = {24, 16, 24};
  volume.to_patient = Eigen::Affine3d(Eigen::Scaling(12.));
  for (int first = 0; first + 2 < map_.labels_size(); first += 3) {
    volume.labels.clear();
    for (int i = 0; i < volume.size.prod(); ++i) {
      volume.labels.push_back(static_cast<Label>(map_.labels(first + i % 24 / 8).number()));
    }
    const absl::Status status = Make(volume);
    if (!status.ok()) ExpectRemedy(status, map_.labels(first).name());
  }
}

TEST_F(OddVolumes, OfSlabsInThePlaceOfAThoraxGiveAPatientOrARemedy) {
  LabelVolume volume;
  volume.size = {30, 20, 40};
  volume.to_patient = Eigen::Affine3d(Eigen::Scaling(10.));
  for (const int thick : {1, 2, 5, 13}) {
    volume.labels.clear();
    for (int k = 0; k < volume.size.z(); ++k) {
      for (int at = 0; at < volume.size.x() * volume.size.y(); ++at) {
        volume.labels.push_back(static_cast<Label>(map_.labels(k / thick % map_.labels_size()).number()));
      }
    }
    const absl::Status status = Make(volume);
    if (!status.ok()) ExpectRemedy(status, absl::StrCat(thick, " voxels thick"));
  }
}

TEST(OddVolumeFiles, FoldersAndDevicesAreErrors) {
  EXPECT_TRUE(absl::IsNotFound(ReadLabels(testing::TempDir()).status()));
  EXPECT_FALSE(ReadLabels("/dev/null").ok());
  EXPECT_TRUE(absl::IsNotFound(ReadLabelMap(testing::TempDir()).status()));
}

}  // namespace
}  // namespace phrenic::imaging
