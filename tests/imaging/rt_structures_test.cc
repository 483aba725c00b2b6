// Contours of RT Structure Sets as label volumes.
#include "server/imaging/rt_structures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "absl/strings/match.h"
#include "server/imaging/contours/contour_fill.h"
#include "server/imaging/label_file.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/nifti.h"
#include "server/imaging/phantom.h"
#include "tests/imaging/small_structures.h"

namespace phrenic::imaging {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

absl::StatusOr<LabelVolume> ReadRegions(const std::vector<SmallRegion>& regions) {
  return ParseLabels("a.dcm", StructuresFile(regions));
}

// Returns the volume of a label [mm^3].
double VolumeOf(const LabelVolume& volume, Label label) {
  return static_cast<double>(std::count(volume.labels.begin(), volume.labels.end(), label)) *
         std::abs(volume.to_patient.linear().determinant());
}

std::string RefusalOf(const std::vector<SmallRegion>& regions) {
  const absl::StatusOr<LabelVolume> volume = ReadRegions(regions);
  EXPECT_TRUE(absl::IsInvalidArgument(volume.status())) << volume.status();
  return std::string(volume.status().message());
}

TEST(RtStructures, OfABoxHaveItsVolumePlaceAndName) {
  const absl::StatusOr<LabelVolume> volume = ReadRegions({{7, "liver", Box(10, 70, -20, 40, 30)}});
  ASSERT_TRUE(volume.ok()) << volume.status();
  EXPECT_NEAR(VolumeOf(*volume, 7), 60 * 60 * 30, 0.03 * 60 * 60 * 30);
  EXPECT_EQ(volume->names.at(7), "liver");
  EXPECT_EQ(volume->Spacing().z(), 3);
  EXPECT_TRUE(volume->remarks.empty());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double count = 0;
  for (int k = 0; k < volume->size.z(); ++k) {
    for (int j = 0; j < volume->size.y(); ++j) {
      for (int i = 0; i < volume->size.x(); ++i) {
        if (volume->labels[volume->Index({i, j, k})] == 0) continue;
        middle += volume->to_patient * Eigen::Vector3d(i, j, k);
        ++count;
      }
    }
  }
  EXPECT_LT((middle / count - Eigen::Vector3d(40, 10, 13.5)).norm(), 1);
}

TEST(RtStructures, AHoleIsAContourInAnotherOrJoinedToIt) {
  std::vector<SmallContour> two = Box(0, 60, 0, 60, 12), hole = Box(20, 40, 20, 40, 12);
  two.insert(two.end(), hole.begin(), hole.end());
  std::vector<SmallContour> keyhole;
  for (double z = 0; z < 12; z += 3) {
    keyhole.push_back({{0, 0,  z,  60, 0,  z,  60, 60, z,  0, 60, z,  0, 20, z,  20, 20,
                        z, 20, 40, z,  40, 40, z,  40, 20, z, 20, 20, z, 0,  20, z}});
  }
  const double expected = (60 * 60 - 20 * 20) * 12;
  for (const auto& contours : {two, keyhole}) {
    const absl::StatusOr<LabelVolume> volume = ReadRegions({{1, "ring", contours}});
    ASSERT_TRUE(volume.ok()) << volume.status();
    EXPECT_NEAR(VolumeOf(*volume, 1), expected, 0.04 * expected);
  }
}

TEST(RtStructures, ASmallerRegionCountsInALargerOne) {
  const SmallRegion body = {1, "BODY", Box(0, 90, 0, 90, 30)}, lung = {2, "Lung_L", Box(20, 50, 20, 50, 30)};
  for (const auto& regions : {std::vector{body, lung}, std::vector{lung, body}}) {
    const absl::StatusOr<LabelVolume> volume = ReadRegions(regions);
    ASSERT_TRUE(volume.ok()) << volume.status();
    EXPECT_NEAR(VolumeOf(*volume, 2), 30 * 30 * 30, 0.07 * 30 * 30 * 30);
    EXPECT_NEAR(VolumeOf(*volume, 1) + VolumeOf(*volume, 2), 90 * 90 * 30, 0.03 * 90 * 90 * 30);
    EXPECT_THAT(volume->remarks, ElementsAre(HasSubstr("regions overlap in")));
  }
}

TEST(RtStructures, OfNumbersThatAreNoLabelsAreCounted) {
  const absl::StatusOr<LabelVolume> volume =
      ReadRegions({{70000, "heart", Box(0, 30, 0, 30, 9)}, {0, "liver", Box(40, 60, 0, 30, 9)}});
  ASSERT_TRUE(volume.ok()) << volume.status();
  EXPECT_EQ(volume->names.at(1), "heart");
  EXPECT_EQ(volume->names.at(2), "liver");
}

TEST(RtStructures, WhatIsLeftOutIsSaid) {
  std::vector<SmallContour> contours = Box(0, 30, 0, 30, 15);
  contours.erase(contours.begin() + 2);
  contours.push_back({{5, 5, 3}, "POINT"});
  const absl::StatusOr<LabelVolume> volume = ReadRegions({{1, "heart", contours}});
  ASSERT_TRUE(volume.ok()) << volume.status();
  EXPECT_THAT(volume->remarks, ElementsAre(AllOf(HasSubstr("\"heart\""), HasSubstr("1 slices")),
                                           HasSubstr("1 points and open contours")));
}

TEST(RtStructures, ThatAreWrongAreRefusedWithContourAttributeAndRemedy) {
  const auto with = [](const SmallContour& contour) {
    SmallRegion region = {5, "liver", Box(0, 30, 0, 30, 9)};
    region.contours.push_back(contour);
    return RefusalOf({region});
  };
  EXPECT_THAT(with({{0, 0, 3, 9, 0, 3, 9, 9, 6}}),
              AllOf(HasSubstr("a.dcm: contour 4 of the region 5"), HasSubstr("3006,0050"), HasSubstr("export")));
  EXPECT_THAT(with({{0, 0, 3, 9, 0, 3, 9, 9, 3}, "CLOSED_PLANAR", 4}), HasSubstr("3006,0046"));
  EXPECT_THAT(with({{0, 0, 3, 9, 0, 3, 9, 9}}), HasSubstr("contour 4"));
  EXPECT_THAT(with(Rectangle(0, 30, 0, 30, 10.3)), HasSubstr("not equidistant"));
  EXPECT_THAT(with(Rectangle(0, 9000, 0, 30, 3)), HasSubstr("smaller than 3000 mm"));
  EXPECT_THAT(RefusalOf({{1, "BODY", Box(0, 2990, 0, 2990, 1650)}}), HasSubstr("enclose too many pixels"));
  EXPECT_THAT(RefusalOf({}), AllOf(HasSubstr("RT Structure Set"), HasSubstr("3006,0039"), HasSubstr("; ")));
  EXPECT_THAT(RefusalOf({{1, "iso", {{{5, 5, 3}, "POINT"}}}}), HasSubstr("3006,0039"));
}

TEST(RtStructures, ThatAreDamagedGiveAnErrorOrAVolumeAndNoPatient) {
  const std::string whole =
      StructuresFile({{1, "BODY", Box(0, 90, 0, 90, 30)}, {2, "Lung_L", Box(20, 50, 20, 50, 30)}});
  std::mt19937 random(5);
  int errors = 0;
  for (int i = 0; i < 80; ++i) {
    std::string bytes = whole;
    if (i % 4 == 0) bytes.resize(random() % bytes.size());
    for (int k = 0; k < 1 + i % 20 && !bytes.empty(); ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    const absl::StatusOr<LabelVolume> volume = ParseLabels("a.dcm", bytes);
    if (volume.ok()) {
      EXPECT_EQ(volume->labels.size(), static_cast<std::size_t>(volume->size.prod()));
      continue;
    }
    ++errors;
    const std::string text(volume.status().message());
    EXPECT_TRUE(absl::StartsWith(text, "a.dcm")) << text;
    EXPECT_THAT(text, AllOf(Not(HasSubstr("DOE")), Not(HasSubstr("4711"))));
  }
  EXPECT_GT(errors, 20);
}

// Returns the Dice coefficient of a part between two volumes.
double DiceOf(const LabelVolume& a, Label label_a, const LabelVolume& b, Label label_b) {
  const Eigen::Affine3d to_b = b.to_patient.inverse() * a.to_patient;
  double both = 0, in_a = 0;
  for (int k = 0; k < a.size.z(); ++k) {
    for (int j = 0; j < a.size.y(); ++j) {
      for (int i = 0; i < a.size.x(); ++i) {
        if (a.labels[a.Index({i, j, k})] != label_a) continue;
        const Eigen::Vector3i there = (to_b * Eigen::Vector3d(i, j, k)).array().round().cast<int>();
        ++in_a;
        if (b.Contains(there) && b.labels[b.Index(there)] == label_b) ++both;
      }
    }
  }
  const double in_b = VolumeOf(b, label_b) / VolumeOf(a, label_a) * in_a;
  return 2 * both / (in_a + in_b);
}

TEST(RtStructures, OfPydicomAreTheLabelsThatTheirContoursWereDrawnAround) {
  const std::string python = "/usr/bin/python3 ";
  if (std::system((python + "-c 'import matplotlib, nibabel, pydicom' >/dev/null 2>&1").c_str()) != 0) {
    GTEST_SKIP() << "nibabel, pydicom or matplotlib is not installed";
  }
  const v1::LabelMap map = *ReadLabelMap("totalsegmentator");
  const LabelVolume volume = *MakePhantom(*FindPhantomBody("small"), {4, 0, 0, 1}, map);
  const std::string stem = testing::TempDir() + "phrenic_rtstruct_" + std::to_string(getpid());
  std::ofstream(stem + ".nii", std::ios::binary) << WriteNifti(volume);
  const std::string command =
      python + PHRENIC_SOURCE_DIR "/tests/imaging/write_structures.py " + stem + ".nii " + stem + ".dcm 5 10 12 51";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const absl::StatusOr<LabelVolume> read = ReadLabels(stem + ".dcm");
  ASSERT_TRUE(read.ok()) << read.status();
  int found = 0;
  for (const auto& [label, name] : read->names) {
    for (const auto& [number, expected] : volume.names) {
      if (name != expected) continue;
      ++found;
      EXPECT_GT(DiceOf(*read, static_cast<Label>(label), volume, static_cast<Label>(number)), 0.95) << name;
    }
  }
  EXPECT_EQ(found, 4);
  std::filesystem::remove(stem + ".nii");
  std::filesystem::remove(stem + ".dcm");
}

TEST(ContourFill, HasTheAreaOfAPolygonAndIsOddEven) {
  Contour triangle(2, 3);
  triangle << 2.51, 52.51, 2.51, 3.51, 3.51, 43.51;
  double area = 0;
  for (const PixelRun& run : FillContours({&triangle}, {60, 60})) area += run.last - run.first + 1;
  EXPECT_NEAR(area, 1000, 20);
  EXPECT_LE(area, BoxPixels(triangle));
  EXPECT_EQ(BoxPixels(triangle), 51 * 41);
  EXPECT_TRUE(FillContours({&triangle, &triangle}, {60, 60}).empty());
}

}  // namespace
}  // namespace phrenic::imaging
