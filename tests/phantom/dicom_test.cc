// DICOM objects of a phantom, as our own reader and programs that others wrote see them.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/imaging/dicom_file.h"
#include "server/imaging/label_file.h"
#include "server/imaging/nifti.h"
#include "server/imaging/nifti_header.h"
#include "server/meshio/formats.h"
#include "server/phantom/dicom/objects.h"
#include "tests/phantom/small_breath.h"

namespace phrenic::phantom {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const DicomStudy kStudy = {"thorax deep 4", "Phrenic phantom: thorax, deep", "test"};

// Returns what a command prints, standard error included.
std::string Printed(const std::string& command) {
  std::string text;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  while (std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), count);
  pclose(pipe);
  return text;
}

bool Succeeds(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

class DicomPhantom : public SmallBreath {
 protected:
  static std::string Seg() { return *WriteSegmentation(kStudy, phantom_->structures(), peak_, 1); }
  static std::string Liver() {
    for (const Structure& structure : All()) {
      if (structure.name != "liver") continue;
      Mesh surface = phantom_->SurfaceOf(structure, 1);
      surface.vertices *= 1e3;
      return *meshio::WriteStl(surface);
    }
    return "";
  }
  // Writes bytes to a file that other programs read. Returns its path.
  static std::string File(const std::string& name, const std::string& bytes) {
    const std::string path = absl::StrCat(testing::TempDir(), "phrenic_phantom_", getpid(), "_", name);
    std::ofstream(path, std::ios::binary) << bytes;
    files_.push_back(path);
    return path;
  }
  void TearDown() override {
    for (const std::string& path : files_) std::filesystem::remove(path);
    files_.clear();
  }

  inline static std::vector<std::string> files_;
};

TEST_F(DicomPhantom, SegmentationIsReadBackVoxelByVoxel) {
  const absl::StatusOr<imaging::LabelVolume> read = imaging::ParseLabels("seg.dcm", Seg());
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_TRUE(read->remarks.empty());
  std::size_t wrong = 0, labelled = 0;
  const Eigen::Affine3d to_read = read->to_patient.inverse() * peak_.labels.to_patient;
  for (int k = 0; k < peak_.labels.size.z(); ++k) {
    for (int j = 0; j < peak_.labels.size.y(); ++j) {
      for (int i = 0; i < peak_.labels.size.x(); ++i) {
        const int label = peak_.labels.labels[peak_.labels.Index({i, j, k})];
        const Eigen::Vector3i there = (to_read * Eigen::Vector3d(i, j, k)).array().round().cast<int>();
        const int found = read->Contains(there) ? read->labels[read->Index(there)] : 0;
        labelled += label != 0;
        wrong += (label == 0 ? "" : All()[label - 1].name) != (found == 0 ? "" : read->names.at(found));
      }
    }
  }
  EXPECT_GT(labelled, 50000U);
  EXPECT_EQ(wrong, 0U);
}

TEST_F(DicomPhantom, TheSameContentHasTheSameIdentifiersAndAnotherHasOthers) {
  EXPECT_EQ(Seg(), Seg());
  DicomStudy other = kStudy;
  other.key += " 2";
  std::set<std::string> identifiers;
  for (const DicomStudy& study : {kStudy, other}) {
    for (const char* what : {"study", "ct 1", "ct 2"}) identifiers.insert(study.Uid(what));
  }
  EXPECT_EQ(identifiers.size(), 6U);
  for (const std::string& uid : identifiers) {
    EXPECT_THAT(uid, StartsWith("2.25."));
    EXPECT_LE(uid.size(), 64U);
    EXPECT_NE(uid[5], '0');
  }
}

TEST_F(DicomPhantom, NamesNoPatient) {
  for (const std::string& bytes :
       {Seg(), *WriteCtSlice(kStudy, peak_, 1, 3), *WriteModel(kStudy, ModelFormat::kStl, Liver(), 3, 1)}) {
    const auto file = imaging::ParseDicom(bytes);
    ASSERT_TRUE(file.ok()) << file.status();
    OFString text;
    for (const DcmTagKey& attribute : {DCM_PatientName, DCM_PatientID, DCM_PatientBirthDate, DCM_PatientSex}) {
      EXPECT_TRUE((*file)->getDataset()->findAndGetOFString(attribute, text).good());
      EXPECT_TRUE(text.empty());
    }
  }
}

TEST_F(DicomPhantom, ModelsHoldTheirFiles) {
  const std::string liver = Liver(), bytes = *WriteModel(kStudy, ModelFormat::kStl, liver, 3, 1);
  const auto file = imaging::ParseDicom(bytes);
  ASSERT_TRUE(file.ok()) << file.status();
  const Uint8* document = nullptr;
  unsigned long length = 0;
  Uint32 stated = 0;
  ASSERT_TRUE((*file)->getDataset()->findAndGetUint8Array(DCM_EncapsulatedDocument, document, &length).good());
  ASSERT_TRUE((*file)->getDataset()->findAndGetUint32(DCM_EncapsulatedDocumentLength, stated).good());
  ASSERT_EQ(stated, liver.size());
  ASSERT_GE(length, liver.size());
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(document), stated), liver);
}

TEST_F(DicomPhantom, HasACodeOfItsOwnForEachStructure) {
  const std::string tissue = CodeOf(v1::Anatomy()).value;
  for (const Structure& structure : All()) EXPECT_NE(CodeOf(structure.anatomy).value, tissue) << structure.name;
  std::map<std::string, int> kinds;  // that share a code
  for (int kind = 1; kind < v1::Structure_ARRAYSIZE; ++kind) {
    if (!v1::Structure_IsValid(kind) || kind == v1::STRUCTURE_INNER_CAGE) continue;
    v1::Anatomy anatomy;
    anatomy.set_structure(static_cast<v1::Structure>(kind));
    EXPECT_NE(CodeOf(anatomy).value, tissue) << v1::Structure_Name(anatomy.structure());
    EXPECT_EQ(++kinds[CodeOf(anatomy).value], 1) << v1::Structure_Name(anatomy.structure());
  }
}

TEST(DicomStudy, CutsTextsBetweenCharactersAndRoundsTimesToMilliseconds) {
  const auto common = [](const std::string& description, double time) {
    DicomStudy study = kStudy;
    study.description = description;
    DcmDataset data;
    PutCommon(study, {"seg", "SEG", 1, "a", time}, UID_SegmentationStorage, "1.2.3", data);
    OFString text, at;
    EXPECT_TRUE(data.findAndGetOFString(DCM_StudyDescription, text).good());
    EXPECT_TRUE(data.findAndGetOFString(DCM_ContentTime, at).good());
    return std::pair(std::string(text.c_str()), std::string(at.c_str()));
  };
  const std::string a63(63, 'a');
  EXPECT_EQ(common(a63 + "\u00e4b", 0).first, a63);  // two bytes
  EXPECT_EQ(common(a63.substr(1) + "\u00e4b", 0).first, a63.substr(1) + "\u00e4");
  EXPECT_EQ(common(a63.substr(2) + "\u20acb", 0).first, a63.substr(2) + "\u20ac");  // three bytes
  EXPECT_EQ(common(a63 + "bc", 0).first, a63 + "b");
  EXPECT_EQ(common("a", 59.9999999).second, "000100.000");
  EXPECT_EQ(common("a", 59.9994).second, "000059.999");
  EXPECT_EQ(common("a", 3723.5).second, "010203.500");
}

TEST_F(DicomPhantom, IsValidByDciodvfy) {
  if (!Succeeds("command -v dciodvfy")) GTEST_SKIP() << "dciodvfy is not installed (dicom3tools)";
  for (const auto& [name, bytes] :
       {std::pair("seg.dcm", Seg()), std::pair("ct.dcm", *WriteCtSlice(kStudy, peak_, 1, 3)),
        std::pair("stl.dcm", *WriteModel(kStudy, ModelFormat::kStl, Liver(), 3, 1))}) {
    EXPECT_THAT(Printed("dciodvfy " + File(name, bytes)), Not(HasSubstr("Error"))) << name;
  }
}

TEST_F(DicomPhantom, IsReadByDcmdump) {
  if (!Succeeds("command -v dcmdump")) GTEST_SKIP() << "dcmdump is not installed (dcmtk)";
  const std::string shown = Printed("dcmdump --quiet +P SegmentLabel +P Modality " + File("seg.dcm", Seg()));
  EXPECT_THAT(shown, HasSubstr("lung_right"));
  EXPECT_THAT(shown, HasSubstr("SEG"));
  EXPECT_THAT(shown, Not(HasSubstr("E:")));
}

// Returns a NIfTI file of CT numbers.
std::string CtFile(const PhantomPhase& phase) {
  const imaging::LabelVolume& volume = phase.labels;
  std::string bytes = imaging::NiftiHeaderBytes({{3, volume.size.x(), volume.size.y(), volume.size.z(), 1, 1, 1, 1},
                                                 volume.Spacing(),
                                                 volume.to_patient,
                                                 0,
                                                 4,
                                                 16,
                                                 0});
  bytes.append(reinterpret_cast<const char*>(phase.ct.data()), 2 * phase.ct.size());
  return bytes;
}

TEST_F(DicomPhantom, IsTheSameVolumeInPydicomAndNibabel) {
  const std::string python = "/usr/bin/python3 ";
  if (!Succeeds(python + "-c 'import nibabel, pydicom'")) {
    GTEST_SKIP() << "nibabel or pydicom is not installed (python3-nibabel, python3-pydicom)";
  }
  constexpr int kSlice = 40;
  const std::string command = absl::StrCat(
      python, PHRENIC_SOURCE_DIR, "/tests/phantom/judge_dicom.py ", File("seg.dcm", Seg()), " ",
      File("labels.nii", imaging::WriteNifti(peak_.labels)), " ",
      File("ct.dcm", *WriteCtSlice(kStudy, peak_, 1, kSlice)), " ", File("ct.nii", CtFile(peak_)), " ", kSlice);
  EXPECT_THAT(Printed(command), StartsWith("the same: "));
}

}  // namespace
}  // namespace phrenic::phantom
