// Reading and writing NIfTI label volumes: orientation, values, names, malformed files.
#include "server/imaging/nifti.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "server/imaging/gzip.h"

namespace phrenic::imaging {
namespace {

using ::testing::HasSubstr;

// Returns a volume with an offset, three different spacings and a rotation; one voxel of each label, not symmetric.
LabelVolume Asymmetric() {
  LabelVolume volume;
  volume.size = {5, 4, 3};
  volume.to_patient.linear() =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()) * Eigen::Vector3d(1.5, 2, 3).asDiagonal();
  volume.to_patient.translation() = Eigen::Vector3d(40, -170, 1080);
  volume.labels.assign(60, 0);
  volume.labels[volume.Index({4, 0, 0})] = 5;
  volume.labels[volume.Index({0, 3, 0})] = 51;
  volume.labels[volume.Index({1, 2, 2})] = 40000;
  volume.names = {{5, "liver"}, {51, "heart"}};
  return volume;
}

template <typename T>
void Put(std::string& bytes, std::size_t at, T number, std::endian order = std::endian::little) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(number);
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  std::memcpy(bytes.data() + at, raw.data(), raw.size());
}

// Returns a file of two voxels along i with only a qform: a rotation by 180 degrees about k, so that i points to the
// patient's left and j to posterior.
std::string ByQform(bool second_version, std::endian order) {
  const std::size_t header = second_version ? 540 : 348;
  std::string bytes(header + 4 + 2, '\0');
  Put<std::int32_t>(bytes, 0, static_cast<std::int32_t>(header), order);
  bytes.replace(second_version ? 4 : 344, 3, second_version ? "n+2" : "n+1");
  const auto real = [&](std::size_t first, std::size_t second, int index, double value) {
    second_version ? Put<double>(bytes, second + 8 * index, value, order)
                   : Put<float>(bytes, first + 4 * index, static_cast<float>(value), order);
  };
  for (int k = 0; k < 4; ++k) {
    const int along = k == 0 ? 3 : k == 1 ? 2 : 1;
    second_version ? Put<std::int64_t>(bytes, 16 + 8 * k, along, order)
                   : Put<std::int16_t>(bytes, 40 + 2 * k, static_cast<std::int16_t>(along), order);
    real(76, 104, k, 1 + k);
  }
  Put<std::int16_t>(bytes, second_version ? 12 : 70, 2, order);  // unsigned bytes
  second_version ? Put<std::int64_t>(bytes, 168, static_cast<std::int64_t>(header) + 4, order)
                 : Put<float>(bytes, 108, static_cast<float>(header) + 4, order);
  second_version ? Put<std::int32_t>(bytes, 344, 1, order) : Put<std::int16_t>(bytes, 252, 1, order);
  real(256, 352, 2, 1);  // quatern_d: 180 degrees about k
  for (int k = 0; k < 3; ++k) real(268, 376, k, 10 * (k + 1));
  bytes[header + 4] = 7;
  bytes[header + 5] = 9;
  return bytes;
}

TEST(Nifti, WrittenFilesRoundTripPlainAndGzipped) {
  const LabelVolume volume = Asymmetric();
  for (const std::string& bytes : {WriteNifti(volume), Deflate(WriteNifti(volume))}) {
    const auto read = ParseNifti("a.nii", bytes);
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_EQ(read->labels, volume.labels);
    EXPECT_EQ(read->names, volume.names);
    EXPECT_LT((read->to_patient.matrix() - volume.to_patient.matrix()).cwiseAbs().maxCoeff(), 1e-4);
  }
}

TEST(Nifti, RasBecomesLps) {
  std::string bytes = WriteNifti(Asymmetric());
  const float srow_x[4] = {2, 0, 0, 100};  // i points to the right, NIfTI's +x
  std::memcpy(bytes.data() + 280, srow_x, sizeof(srow_x));
  const auto read = ParseNifti("a.nii", bytes);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_NEAR((read->to_patient * Eigen::Vector3d(1, 0, 0)).x(), -102, 1e-4) << "+x is the patient's left";
}

TEST(Nifti, TheQformIsReadInBothVersionsAndEndiannesses) {
  for (const bool second : {false, true}) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
      const auto read = ParseNifti("a.nii", ByQform(second, order));
      ASSERT_TRUE(read.ok()) << read.status();
      EXPECT_EQ(read->labels, (std::vector<Label>{7, 9}));
      const Eigen::Vector3d second_voxel = read->to_patient * Eigen::Vector3d(1, 0, 0);
      EXPECT_LT((second_voxel - Eigen::Vector3d(-10 + 2, -20, 30)).norm(), 1e-4) << second_voxel.transpose();
    }
  }
}

TEST(Nifti, EveryTruncationFailsAndEveryFlippedByteGivesAnErrorOrAVolume) {
  const std::string plain = WriteNifti(Asymmetric()), packed = Deflate(plain);
  for (const std::string& good : {plain, packed}) {
    for (std::size_t length = 0; length < good.size(); ++length) {
      EXPECT_FALSE(ParseNifti("cut.nii", good.substr(0, length)).ok()) << length;
    }
    for (std::size_t at = 0; at < good.size(); ++at) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ 0xff);
      const auto read = ParseNifti("bad.nii", bad);
      EXPECT_TRUE(!read.ok() || read->labels.size() == static_cast<std::size_t>(read->size.prod())) << at;
    }
  }
}

TEST(Nifti, AFileThatDeclaresMoreThanItCanHoldIsRejectedBeforeInflating) {
  std::string bomb = WriteNifti(Asymmetric());
  for (int k = 1; k <= 3; ++k) Put<std::int16_t>(bomb, 40 + 2 * k, 1000);
  EXPECT_THAT(std::string(ParseNifti("b.nii", bomb).status().message()), HasSubstr("truncated"));
  EXPECT_THAT(std::string(ParseNifti("b.nii.gz", Deflate(bomb)).status().message()), HasSubstr("more than a file of"));
}

struct Bad {
  std::size_t at;
  std::int16_t value;
  const char* words;
};

TEST(Nifti, HeaderErrorsNameProblemAndRemedy) {
  for (const Bad& bad :
       {Bad{70, 16, "labels are integers"}, Bad{40, 2, "3 dimensions"}, Bad{48, 4, "only a single volume"},
        Bad{254, 0, "left and right are unknown"}, Bad{42, -3, "1 to 32767"}}) {
    std::string bytes = WriteNifti(Asymmetric());
    Put<std::int16_t>(bytes, 40, 4);
    Put<std::int16_t>(bytes, bad.at, bad.value);
    EXPECT_THAT(std::string(ParseNifti("b.nii", bytes).status().message()), HasSubstr(bad.words));
  }
  EXPECT_THAT(std::string(ParseNifti("b.nii", "no image").status().message()), HasSubstr("not a NIfTI"));
}

}  // namespace
}  // namespace phrenic::imaging
