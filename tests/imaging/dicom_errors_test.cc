// DICOM files that are no segmentation, damaged or hostile give errors with a remedy and without a patient's data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "absl/strings/match.h"
#include "server/imaging/label_file.h"
#include "tests/imaging/small_segmentation.h"

namespace phrenic::imaging {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Edit = std::function<void(DcmItem& data)>;

// Returns three slices of 4 x 4 pixels with the left half inside.
SmallSegmentation Halves() {
  SmallSegmentation halves;
  halves.rows = halves.columns = 4;
  for (int slice = 0; slice < 3; ++slice) {
    SmallFrame frame{1 + slice % 2, {0, 0, 3.0 * slice}, {}};
    for (int at = 0; at < 16; ++at) frame.pixels.push_back(at % 4 < 2);
    halves.frames.push_back(frame);
  }
  return halves;
}

std::string Edited(const Edit& edit) {
  DcmFileFormat file;
  Halves().Fill(file);
  edit(*file.getDataset());
  return SmallSegmentation::BytesOf(file);
}

// Returns the error's text. Fails the test, and returns an empty text, if the volume is accepted.
std::string ErrorOf(const std::string& bytes) {
  const absl::StatusOr<LabelVolume> volume = ParseLabels("a.dcm", bytes);
  EXPECT_TRUE(absl::IsInvalidArgument(volume.status())) << volume.status();
  return std::string(volume.status().message());
}

// The file is damaged: an error, or a valid volume; neither has a patient's data.
void ExpectErrorOrVolume(const std::string& bytes, const std::string& what) {
  const absl::StatusOr<LabelVolume> volume = ParseLabels("a.dcm", bytes);
  if (volume.ok()) {
    EXPECT_EQ(volume->labels.size(), static_cast<std::size_t>(volume->size.prod())) << what;
    EXPECT_TRUE(volume->to_patient.matrix().allFinite()) << what;
    return;
  }
  const std::string text(volume.status().message());
  EXPECT_TRUE(absl::StartsWith(text, "a.dcm: ")) << what << ": " << text;
  EXPECT_TRUE(absl::StrContains(text, "; ")) << what << " has no remedy: " << text;
  EXPECT_THAT(text, AllOf(Not(HasSubstr("DOE")), Not(HasSubstr("4711")))) << what;
}

TEST(DicomErrors, OtherKindsOfObjectsAreNamed) {
  const std::pair<const char*, const char*> kinds[] = {{UID_CTImageStorage, "slice of a CT"},
                                                       {UID_RTStructureSetStorage, "RT Structure Set"},
                                                       {"1.2.3.4711", "another kind"}};
  for (const auto& [sop_class, words] : kinds) {
    SmallSegmentation other = Halves();
    other.sop_class = sop_class;
    EXPECT_THAT(ErrorOf(other.Bytes()),
                AllOf(HasSubstr(words), HasSubstr("DICOM Segmentation"), Not(HasSubstr("4711"))));
  }
}

TEST(DicomErrors, InvalidAttributesAreNamedWithARemedy) {
  using S = SmallSegmentation;
  const std::pair<const char*, Edit> edits[] = {
      {"SegmentationType", [](DcmItem& data) { S::Put(data, DCM_SegmentationType, "OTHER"); }},
      {"BitsAllocated", [](DcmItem& data) { S::Put(data, DCM_BitsAllocated, 16); }},
      {"BitsAllocated", [](DcmItem& data) { S::Put(data, DCM_SamplesPerPixel, 3); }},
      {"Rows and Columns", [](DcmItem& data) { S::Put(data, DCM_Rows, 0); }},
      {"Rows and Columns", [](DcmItem& data) { S::Put(data, DCM_Columns, 65535); }},
      {"48 are declared", [](DcmItem& data) { S::Put(data, DCM_Columns, 32); }},
      {"NumberOfFrames", [](DcmItem& data) { S::Put(data, DCM_NumberOfFrames, "-1"); }},
      {"NumberOfFrames is 2", [](DcmItem& data) { S::Put(data, DCM_NumberOfFrames, "2"); }},
      {"PixelData has", [](DcmItem& data) { S::Put(data, DCM_NumberOfFrames, "2000000000"); }},
      {"PixelData has", [](DcmItem& data) { delete data.remove(DCM_PixelData); }},
      {"PerFrameFunctionalGroupsSequence",
       [](DcmItem& data) { delete data.remove(DCM_PerFrameFunctionalGroupsSequence); }},
      {"frame 1: ImageOrientationPatient",
       [](DcmItem& data) { delete data.remove(DCM_SharedFunctionalGroupsSequence); }},
      {"concatenation", [](DcmItem& data) { S::Put(data, DCM_InConcatenationNumber, 1); }},
  };
  for (const auto& [words, edit] : edits) {
    const std::string bytes = Edited(edit);
    EXPECT_THAT(ErrorOf(bytes), AllOf(HasSubstr(words), HasSubstr("; "))) << words;
  }
}

TEST(DicomErrors, FramesThatMakeNoGridAreRefused) {
  const std::pair<const char*, std::function<void(SmallSegmentation&)>> edits[] = {
      {"not equidistant", [](SmallSegmentation& all) { all.frames[2].position.z() = 7.37; }},
      {"mm beside the grid", [](SmallSegmentation& all) { all.frames[1].position.x() = 1; }},
      {"voxels of 0.05 to 50 mm",
       [](SmallSegmentation& all) {
         all.spacing = {2, 70};
       }},
      {"span more than 32767", [](SmallSegmentation& all) { all.frames[0].position.z() = -3e6; }},
      {"frame 2 is at the place", [](SmallSegmentation& all) { all.frames[1] = all.frames[0]; }},
      {"orthogonal", [](SmallSegmentation& all) { all.orientation = {1, 0, 0, 1, 0, 0}; }},
      {"PixelSpacing",
       [](SmallSegmentation& all) {
         all.spacing = {0, 1};
       }},
      {"thickness", [](SmallSegmentation& all) { all.frames.resize(1); }},
  };
  for (const auto& [words, edit] : edits) {
    SmallSegmentation bad = Halves();
    edit(bad);
    EXPECT_THAT(ErrorOf(bad.Bytes()), HasSubstr(words));
  }
}

TEST(DicomErrors, AFrameInAnotherOrientationIsRefused) {
  const std::string bytes = Edited([](DcmItem& data) {
    DcmItem& own = SmallSegmentation::Item(data, DCM_PerFrameFunctionalGroupsSequence, 1);
    SmallSegmentation::Put(SmallSegmentation::Item(own, DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient,
                           "0\\1\\0\\0\\0\\1");
  });
  EXPECT_THAT(ErrorOf(bytes), HasSubstr("frame 2: its orientation"));
}

TEST(DicomErrors, CompressedPixelsOtherThanRleAndUnknownTransferSyntaxesAreRefused) {
  std::string bytes = Halves().Bytes();
  const std::size_t at = bytes.find("1.2.840.10008.1.2.1", 132);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 19, "1.2.840.10008.1.2.5");
  EXPECT_THAT(ErrorOf(bytes), AnyOf(HasSubstr("PixelData"), HasSubstr("damaged"))) << "RLE without RLE data";
  bytes.replace(at, 19, "1.2.840.10008.1.2.9");
  EXPECT_THAT(ErrorOf(bytes), HasSubstr("transfer syntax is unknown"));
}

// Returns a file's bytes with a transfer syntax two characters longer.
std::string WithTransferSyntax(std::string bytes, const std::string& old, const std::string& longer) {
  const std::size_t at = bytes.find(old, 132);
  bytes[at - 2] = static_cast<char>(bytes[at - 2] + 2);  // length of the UID, and of the group
  bytes[140] = static_cast<char>(bytes[140] + 2);
  return bytes.replace(at, old.size() + old.size() % 2, longer);  // with its padding
}

TEST(DicomErrors, TheCompressionThatIsNotReadIsNamed) {
  SmallSegmentation fractions = Halves();
  fractions.type = "FRACTIONAL";
  fractions.bits = 8;
  const std::string bytes =
      WithTransferSyntax(fractions.Bytes(EXS_RLELossless), "1.2.840.10008.1.2.5", "1.2.840.10008.1.2.4.90");
  EXPECT_THAT(ErrorOf(bytes), AllOf(HasSubstr("JPEG 2000"), HasSubstr("gdcmconv --raw")));
}

TEST(DicomErrors, EveryTruncationIsAnError) {
  for (const E_TransferSyntax transfer :
       {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit, EXS_DeflatedLittleEndianExplicit}) {
    const std::string whole = Halves().Bytes(transfer);
    for (int part = 0; part < 50; ++part) {
      const std::string cut = whole.substr(0, whole.size() * part / 50);
      EXPECT_FALSE(ParseLabels("a.dcm", cut).ok()) << part;
      ExpectErrorOrVolume(cut, absl::StrCat(part, " / 50 of ", DcmXfer(transfer).getXferName()));
    }
  }
}

TEST(DicomErrors, MutationsGiveAnErrorOrAVolume) {
  std::mt19937 random(1);
  SmallSegmentation fractions = Halves();
  fractions.type = "FRACTIONAL";
  fractions.bits = 8;
  for (const std::string& whole :
       {Halves().Bytes(), Halves().Bytes(EXS_LittleEndianImplicit), Halves().Bytes(EXS_DeflatedLittleEndianExplicit),
        fractions.Bytes(EXS_RLELossless)}) {
    for (int mutation = 0; mutation < 200; ++mutation) {
      std::string bad = whole;
      for (int change = 0; change <= mutation % 3; ++change) {
        bad[132 + random() % (bad.size() - 132)] = static_cast<char>(random());
      }
      ExpectErrorOrVolume(bad, absl::StrCat("mutation ", mutation));
    }
  }
}

// A value whose length is not in the file is not allocated.
TEST(DicomErrors, ALengthBeyondTheFileIsAnError) {
  std::string bytes = Halves().Bytes();
  const std::size_t at =
      bytes.rfind(std::string("\xe0\x7f\x10\x00"
                              "O",
                              5));  // PixelData
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at + 8, 4, "\xf0\xff\xff\xff");
  EXPECT_THAT(ErrorOf(bytes), HasSubstr("truncated"));
}

// Returns the head of a file, to which `count` beginnings of nested sequences are added.
std::string NestedSequences(int count) {
  const std::string whole = Halves().Bytes();
  std::string bytes = whole.substr(0, whole.find(std::string("\x08\x00\x16\x00UI", 6)));
  for (int level = 0; level < count; ++level) {
    bytes.append("\x40\x00\x30\xa7SQ\0\0\xff\xff\xff\xff", 12).append("\xfe\xff\x00\xe0\xff\xff\xff\xff", 8);
  }
  return bytes;
}

TEST(DicomErrors, SequencesNestedTooDeeplyAreRefused) {
  EXPECT_THAT(ErrorOf(NestedSequences(100000)), HasSubstr("nested too deeply"));
  EXPECT_THAT(ErrorOf(NestedSequences(10)), Not(HasSubstr("nested too deeply")));
}

TEST(DicomErrors, TheContentDecidesNotTheName) {
  EXPECT_TRUE(ParseLabels("a.nii.gz", Halves().Bytes()).ok());
  EXPECT_THAT(ErrorOf(std::string(200, 'x')), HasSubstr("not a NIfTI"));
  EXPECT_THAT(ErrorOf(std::string(128, '\0') + "DICM"), HasSubstr("; "));
}

}  // namespace
}  // namespace phrenic::imaging
