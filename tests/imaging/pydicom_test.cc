// A phantom's NIfTI file and the DICOM Segmentation that nibabel and pydicom make of it are the same volume.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "server/imaging/label_file.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/nifti.h"
#include "server/imaging/phantom.h"

namespace phrenic::imaging {
namespace {

bool Succeeds(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

// Returns the name of the label that the map gives each number.
std::map<int, std::string> KnownLabels(const LabelVolume& volume, const v1::LabelMap& map) {
  std::map<int, std::string> names;
  std::vector<std::string> remarks;
  const v1::LabelMap resolved = Resolve(map, volume, remarks);
  for (const v1::LabelMeaning& label : resolved.labels()) names[label.number()] = label.name();
  return names;
}

// Returns how many voxels of a volume have another label in `read`, whose axes may run otherwise.
std::size_t WrongVoxels(const LabelVolume& volume, const LabelVolume& read, const v1::LabelMap& map) {
  std::map<int, std::string> expected = KnownLabels(volume, map), names = KnownLabels(read, map);
  const Eigen::Affine3d to_read = read.to_patient.inverse() * volume.to_patient;
  std::size_t wrong = 0, at = 0;
  for (int k = 0; k < volume.size.z(); ++k) {
    for (int j = 0; j < volume.size.y(); ++j) {
      for (int i = 0; i < volume.size.x(); ++i, ++at) {
        const Eigen::Vector3i there = (to_read * Eigen::Vector3d(i, j, k)).array().round().cast<int>();
        const Label label = read.Contains(there) ? read.labels[read.Index(there)] : 0;
        if (expected[volume.labels[at]] != names[label]) ++wrong;
      }
    }
  }
  return wrong;
}

TEST(Pydicom, WritesTheVoxelsAndNamesThatAreRead) {
  const std::string python = "/usr/bin/python3 ";
  if (!Succeeds(python + "-c 'import nibabel, pydicom'")) {
    GTEST_SKIP() << "nibabel or pydicom is not installed (python3-nibabel, python3-pydicom)";
  }
  const v1::LabelMap map = *ReadLabelMap("totalsegmentator");
  const LabelVolume volume = *MakePhantom(*FindPhantomBody("small"), {6, 0.02, 10, 1}, map);
  const std::string stem = testing::TempDir() + "phrenic_pydicom_" + std::to_string(getpid());
  const std::string nifti = stem + ".nii", dicom = stem + ".dcm";
  std::ofstream(nifti, std::ios::binary) << WriteNifti(volume);
  for (const char* transfer : {"explicit", "implicit", "big", "deflated"}) {
    const std::string convert = absl::StrCat(python, PHRENIC_SOURCE_DIR "/tests/imaging/write_segmentation.py ", nifti,
                                             " ", dicom, " ", transfer);
    ASSERT_EQ(std::system(convert.c_str()), 0);
    const absl::StatusOr<LabelVolume> read = ReadLabels(dicom);
    ASSERT_TRUE(read.ok()) << transfer << ": " << read.status();
    EXPECT_EQ(WrongVoxels(volume, *read, map), 0U) << transfer;
  }
  std::filesystem::remove(nifti);
  std::filesystem::remove(dicom);
}

}  // namespace
}  // namespace phrenic::imaging
