// `phrenic patient` makes the same patient of a NIfTI file and of a DICOM Segmentation.
#include <gmock/gmock.h>

#include <cstdlib>
#include <set>
#include <string>

#include "absl/strings/str_cat.h"
#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Outcome MakeCoarsePatient(const std::string& labels) {
  return Phrenic({"patient", labels, "--out", Scratch("patients"), "--name", "jane", "--edge-length", "12", "--anyway",
                  "--vertices", "800", "-o", "json"});
}

TEST(PatientCommand, ANiftiFileAndADicomSegmentationAreTheSamePatient) {
  const std::string python = "/usr/bin/python3 ";
  if (std::system((python + "-c 'import nibabel, pydicom' 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "nibabel or pydicom is not installed (python3-nibabel, python3-pydicom)";
  }
  const std::string nifti = Scratch("labels.nii.gz"), dicom = Scratch("labels.dcm");
  ASSERT_EQ(Phrenic({"phantom", "--voxel", "5", "--out", nifti}).code, 0);
  const std::string script = PHRENIC_SOURCE_DIR "/tests/imaging/write_segmentation.py ";
  ASSERT_EQ(std::system((python + script + nifti + " " + dicom).c_str()), 0);
  const Outcome from_nifti = MakeCoarsePatient(nifti), from_dicom = MakeCoarsePatient(dicom);
  ASSERT_EQ(from_nifti.code, 0) << from_nifti.err;
  ASSERT_EQ(from_dicom.code, 0) << from_dicom.err;
  const auto expected = from_nifti.json(), report = from_dicom.json();
  ASSERT_GT(expected["surfaces"].size(), 30U);
  ASSERT_EQ(report["surfaces"].size(), expected["surfaces"].size());
  for (std::size_t s = 0; s < expected["surfaces"].size(); ++s) {
    const auto &surface = report["surfaces"][s], &other = expected["surfaces"][s];
    EXPECT_EQ(surface["body"], other["body"]);
    EXPECT_NEAR(surface["volume_ml"].get<double>() / other["volume_ml"].get<double>(), 1, 1e-3) << surface["body"];
    EXPECT_EQ(surface["label_volume_ml"], other["label_volume_ml"]) << surface["body"];
  }
  EXPECT_EQ(report["ribs"].size(), expected["ribs"].size());
  EXPECT_NEAR(report["diaphragm"]["area_cm2"].get<double>() / expected["diaphragm"]["area_cm2"].get<double>(), 1, 1e-3);
  EXPECT_THAT(from_dicom.out + from_dicom.err, Not(HasSubstr("Doe")));
}

TEST(PatientCommand, ASlabIsRefusedWithReasonsUnlessItIsWantedAnyway) {
  const std::string slab = PHRENIC_SOURCE_DIR "/../shared/data/labels/totalsegmentator_example_seg.nii.gz";
  if (!std::filesystem::exists(slab)) GTEST_SKIP() << "there is no " << slab;
  const std::vector<std::string> words = {"patient",       slab, "--out",      Scratch("slab"),
                                          "--edge-length", "5",  "--vertices", "800"};
  const Outcome refused = Phrenic(words);
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.out, testing::AllOf(HasSubstr("readiness: not usable"), HasSubstr("ribs are missing"),
                                          HasSubstr("cut by the upper border"), HasSubstr("axes of ribs")));
  EXPECT_THAT(refused.err, testing::AllOf(HasSubstr("nothing was written"), HasSubstr("--anyway")));
  EXPECT_FALSE(std::filesystem::exists(Scratch("slab")));
  std::vector<std::string> anyway = words;
  anyway.insert(anyway.end(), {"--anyway", "-o", "json"});
  const Outcome written = Phrenic(anyway);
  EXPECT_EQ(written.code, 0) << written.err;
  EXPECT_EQ(written.json()["readiness"]["verdict"], "READINESS_VERDICT_NOT_USABLE");
  EXPECT_TRUE(std::filesystem::exists(Scratch("slab/scenes/patient.textproto")));
}

// MOOSE writes a file for each of its models.
TEST(PatientCommand, AFolderOfFilesIsOnePatient) {
  const std::string folder = Scratch("moose");
  std::filesystem::create_directories(folder);
  for (const char* model : {"ribs", "vertebrae", "organs", "cardiac"}) {
    const std::string file = absl::StrCat(folder, "/CT_", model, "_0000.nii.gz");
    const std::string map = absl::StrCat("moose-", model);
    ASSERT_EQ(Phrenic({"phantom", "--voxel", "5", "--labels", map, "--out", file}).code, 0) << model;
  }
  const Outcome made = MakeCoarsePatient(folder);
  ASSERT_EQ(made.code, 0) << made.err;
  std::set<std::string> bodies;
  const nlohmann::json report = made.json();
  for (const auto& surface : report["surfaces"]) bodies.insert(surface["body"].get<std::string>());
  for (const char* body : {"rib-5-left", "rib-5-right", "t12", "sternum", "lung-upper-lobe-left"}) {
    EXPECT_TRUE(bodies.contains(body)) << body;
  }
  const Outcome two_maps = Phrenic({"patient", folder, "--out", folder, "--labels", "moose", "--labels", "cads"});
  EXPECT_NE(two_maps.code, 0);
  EXPECT_THAT(two_maps.err, HasSubstr("give one map for all files"));
  const Outcome no_file = Phrenic({"patient", folder, "--out", folder, "--labels", "liver.nii=cads-551"});
  EXPECT_THAT(no_file.err, HasSubstr("liver.nii=cads-551: no label file of this name was given"));
}

TEST(PatientCommand, ADicomFileThatIsNoSegmentationIsNamed) {
  const Outcome outcome = MakeCoarsePatient(WriteScratch("empty.nii", std::string(128, '\0') + "DICM"));
  EXPECT_NE(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("DICOM"));
}

}  // namespace
}  // namespace phrenic::client
