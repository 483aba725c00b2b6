// DICOM Segmentations give the voxels, names and places that their standard defines.
#include "server/imaging/dicom_segmentation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "server/imaging/label_file.h"
#include "tests/imaging/small_segmentation.h"

namespace phrenic::imaging {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Eigen::Vector3d kFirst(-40, 30, 100);  // of the lowest slice's first voxel [mm]
constexpr double kApart = 4;                 // slices [mm]

// Returns the label of a voxel of the example: two segments in different slices, no symmetry.
int ExampleLabel(int column, int row, int slice) {
  if (slice == 1) return (column * 7 + row * 3) % 4 == 0 ? 1 : 0;
  return (column + 2 * row + slice) % 3 == 1 ? 1 + (slice == 3) : 0;
}

// Returns a frame for each segment in each slice in which it is: 15 pixels, so that frames begin within bytes.
SmallSegmentation Example() {
  SmallSegmentation example;
  for (int slice = 0; slice < 4; ++slice) {
    for (const int segment : {1, 2}) {
      SmallFrame frame{segment, kFirst + Eigen::Vector3d(0, 0, kApart * slice), {}};
      for (int at = 0; at < 15; ++at) frame.pixels.push_back(ExampleLabel(at % 5, at / 5, slice) == segment);
      const bool empty = std::all_of(frame.pixels.begin(), frame.pixels.end(), [](int pixel) { return pixel == 0; });
      if (!empty) example.frames.push_back(frame);
    }
  }
  return example;
}

// Returns the example as frames of one value a pixel.
SmallSegmentation ExampleLabelMap(int bits) {
  SmallSegmentation example;
  example.type = "LABELMAP";
  example.sop_class = "1.2.840.10008.5.1.4.1.1.66.7";
  example.bits = bits;
  for (int slice = 3; slice >= 0; --slice) {
    SmallFrame frame{0, kFirst + Eigen::Vector3d(0, 0, kApart * slice), {}};
    for (int at = 0; at < 15; ++at) {
      frame.pixels.push_back(static_cast<std::uint16_t>(ExampleLabel(at % 5, at / 5, slice)));
    }
    example.frames.push_back(frame);
  }
  return example;
}

LabelVolume Parsed(const std::string& bytes) {
  absl::StatusOr<LabelVolume> volume = ParseLabels("a.dcm", bytes);
  EXPECT_TRUE(volume.ok()) << volume.status();
  return volume.ok() ? *std::move(volume) : LabelVolume();
}

void ExpectExample(const LabelVolume& volume) {
  ASSERT_EQ(volume.size, Eigen::Vector3i(5, 3, 4));
  std::size_t at = 0;
  for (int slice = 0; slice < 4; ++slice) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 5; ++column, ++at) {
        EXPECT_EQ(volume.labels[at], ExampleLabel(column, row, slice)) << column << " " << row << " " << slice;
      }
    }
  }
  EXPECT_LT((volume.to_patient * Eigen::Vector3d(1, 2, 3) - kFirst - Eigen::Vector3d(3, 4, 12)).norm(), 1e-9);
  EXPECT_THAT(volume.remarks, IsEmpty());
}

TEST(DicomSegmentation, FramesInAnyOrderAndWithinBytesGiveTheSameVolume) {
  SmallSegmentation example = Example();
  std::mt19937 random(1);
  for (int order = 0; order < 8; ++order) {
    ExpectExample(Parsed(example.Bytes()));
    std::shuffle(example.frames.begin(), example.frames.end(), random);
  }
}

TEST(DicomSegmentation, EveryTransferSyntaxGivesTheSameVolume) {
  for (const E_TransferSyntax transfer :
       {EXS_LittleEndianImplicit, EXS_LittleEndianExplicit, EXS_BigEndianExplicit, EXS_DeflatedLittleEndianExplicit}) {
    SCOPED_TRACE(DcmXfer(transfer).getXferName());
    ExpectExample(Parsed(Example().Bytes(transfer)));
    for (const int bits : {8, 16}) ExpectExample(Parsed(ExampleLabelMap(bits).Bytes(transfer)));
  }
  for (const int bits : {8, 16}) ExpectExample(Parsed(ExampleLabelMap(bits).Bytes(EXS_RLELossless)));
}

TEST(DicomSegmentation, AFractionOfAtLeastHalfTheMaximumIsInside) {
  SmallSegmentation half = Example();
  half.type = "FRACTIONAL";
  half.bits = 8;
  for (SmallFrame& frame : half.frames) {
    for (std::uint16_t& pixel : frame.pixels) pixel = pixel == 1 ? 50 : 49;  // of 100
  }
  ExpectExample(Parsed(half.Bytes()));
  ExpectExample(Parsed(half.Bytes(EXS_RLELossless)));
}

TEST(DicomSegmentation, SlicesWithoutFramesAreEmpty) {
  for (const double stated : {0.0, 4.0}) {
    SmallSegmentation gap = Example();
    gap.between_slices = stated;
    std::erase_if(gap.frames, [](const SmallFrame& frame) { return frame.position.z() == kFirst.z() + kApart; });
    const LabelVolume volume = Parsed(gap.Bytes());
    ASSERT_EQ(volume.size.z(), 4);
    EXPECT_EQ(std::count(volume.labels.begin() + 15, volume.labels.begin() + 30, 0), 15);
    EXPECT_EQ(volume.labels[volume.Index({1, 0, 0})], ExampleLabel(1, 0, 0));
    EXPECT_EQ(volume.labels[volume.Index({1, 0, 3})], ExampleLabel(1, 0, 3));
  }
}

TEST(DicomSegmentation, AnyOrientationAndTiltIsKept) {
  SmallSegmentation oblique = Example();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3d step = turn * Eigen::Vector3d(0.5, 1, kApart);  // a tilted gantry
  oblique.orientation = {turn(0, 0), turn(1, 0), turn(2, 0), turn(0, 1), turn(1, 1), turn(2, 1)};
  for (SmallFrame& frame : oblique.frames) {
    frame.position = kFirst + (frame.position.z() - kFirst.z()) / kApart * step;
  }
  const LabelVolume volume = Parsed(oblique.Bytes());
  ASSERT_EQ(volume.size, Eigen::Vector3i(5, 3, 4));
  const Eigen::Vector3d expected = kFirst + 4 * 3 * turn.col(0) + 2 * 2 * turn.col(1) + 3 * step;
  EXPECT_LT((volume.to_patient * Eigen::Vector3d(4, 2, 3) - expected).norm(), 1e-3);
  EXPECT_EQ(volume.labels[volume.Index({4, 2, 3})], ExampleLabel(4, 2, 3));
}

// Seen from below, the first row and column are elsewhere; the patient is the same.
TEST(DicomSegmentation, AMirroredOrientationIsTheSamePatient) {
  SmallSegmentation mirrored = Example();
  mirrored.orientation = {-1, 0, 0, 0, 1, 0};
  for (SmallFrame& frame : mirrored.frames) {
    frame.position.x() += 12;
    for (int row = 0; row < 3; ++row) {
      std::reverse(frame.pixels.begin() + 5 * row, frame.pixels.begin() + 5 * row + 5);
    }
  }
  const LabelVolume volume = Parsed(mirrored.Bytes());
  EXPECT_GT(volume.to_patient.linear().determinant(), 0);
  for (int at = 0; at < 60; ++at) {
    const Eigen::Vector3d voxel = Eigen::Vector3i(at % 5, at / 5 % 3, at / 15).cast<double>();
    const Eigen::Vector3d there =
        volume.to_patient.inverse() * (kFirst + Eigen::Vector3d(3 * voxel.x(), 2 * voxel.y(), kApart * voxel.z()));
    EXPECT_EQ(volume.labels[volume.Index(there.array().round().cast<int>())],
              ExampleLabel(at % 5, at / 5 % 3, at / 15));
  }
}

TEST(DicomSegmentation, OfOverlappingSegmentsTheHigherNumberCountsAndARemarkSaysSo) {
  for (const bool reversed : {false, true}) {
    SmallSegmentation both = Example();
    both.frames = {{2, kFirst, std::vector<std::uint16_t>(15, 1)},
                   {1, kFirst, std::vector<std::uint16_t>(15, 1)},
                   {1, kFirst + Eigen::Vector3d(0, 0, kApart), std::vector<std::uint16_t>(15, 1)}};
    if (reversed) std::reverse(both.frames.begin(), both.frames.end());
    const LabelVolume volume = Parsed(both.Bytes());
    EXPECT_EQ(volume.labels[7], 2);
    EXPECT_EQ(volume.labels[22], 1);
    EXPECT_THAT(volume.remarks, ElementsAre(HasSubstr("overlap in 15 voxels")));
  }
}

TEST(DicomSegmentation, NamesAreLabelsAndMeaningsAreCodesWithLaterality) {
  const LabelVolume volume = Parsed(Example().Bytes());
  EXPECT_EQ(volume.names.at(1), "liver");
  EXPECT_EQ(volume.names.at(2), "Segment 2");
  EXPECT_EQ(volume.meanings.at(2), "Second rib Left");
}

// Frames have the attribute that is shared by default.
TEST(DicomSegmentation, AFramesOwnGroupTakesPrecedence) {
  DcmFileFormat file;
  SmallSegmentation example = Example();
  example.Fill(file);
  example.Put(
      example.Item(example.Item(*file.getDataset(), DCM_SharedFunctionalGroupsSequence), DCM_PixelMeasuresSequence),
      DCM_PixelSpacing, "9\\9");
  for (std::size_t f = 0; f < example.frames.size(); ++f) {
    DcmItem& own = example.Item(*file.getDataset(), DCM_PerFrameFunctionalGroupsSequence, static_cast<long>(f));
    example.Put(example.Item(own, DCM_PixelMeasuresSequence), DCM_PixelSpacing, "2\\3");
  }
  ExpectExample(Parsed(example.BytesOf(file)));
}

}  // namespace
}  // namespace phrenic::imaging
