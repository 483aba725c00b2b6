// `phrenic fluoroscopy`: pictures as files, numbers, and errors.
#include <gmock/gmock.h>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

Outcome XRay(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"fluoroscopy", "thorax", "--resolution", "12", "--size", "64"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Phrenic(arguments);
}

TEST(Fluoroscopy, WritesGreyAndNumbersOfAMoment) {
  const std::string png = Scratch("chest.png"), nifti = Scratch("chest.nii"), zipped = Scratch("chest.nii.gz");
  const Outcome grey = XRay({"--out", png});
  ASSERT_EQ(grey.code, 0) << grey.err;
  EXPECT_THAT(ReadAll(png), StartsWith("\x89PNG"));
  EXPECT_THAT(grey.out, HasSubstr("lung-left: 0.300 g/cm3"));
  const Outcome numbers = XRay({"--view", "left-lateral", "--out", nifti, "-o", "json"});
  ASSERT_EQ(numbers.code, 0) << numbers.err;
  EXPECT_EQ(ReadAll(nifti).size(), 352u + 4 * 64 * 64);
  EXPECT_GT(numbers.json()["largest_integral"], 4);
  EXPECT_LT(numbers.json()["largest_integral"], 15);
  EXPECT_TRUE(numbers.json()["left_out"].empty());
  EXPECT_EQ(XRay({"--lao", "45", "--cranial", "-10", "--distance", "0", "--out", zipped}).code, 0);
}

TEST(Fluoroscopy, OfADeepBreathHasLighterLungs) {
  const Outcome deep = XRay({"--preset", "deep", "--at", "1.5", "--out", Scratch("deep.png"), "-o", "json"});
  ASSERT_EQ(deep.code, 0) << deep.err;
  EXPECT_LT(deep.json()["lung_density_g_cm3"]["lung-right"], 0.27);
  EXPECT_NEAR(deep.json()["time"], 1.5, 0.01);
}

TEST(Fluoroscopy, ThatCannotBeIsAnErrorWithTheRemedy) {
  EXPECT_THAT(XRay({"--out", Scratch("chest.bmp")}).err, HasSubstr(".png"));
  EXPECT_THAT(XRay({"--out", Scratch("chest.png"), "--view", "oblique"}).err, HasSubstr("left-lateral"));
  EXPECT_THAT(XRay({"--out", Scratch("chest.png"), "--distance", "0.3"}).err, HasSubstr("give 0.8 m or more"));
  EXPECT_THAT(XRay({"--out", Scratch("chest.png"), "--preset", "none"}).err, HasSubstr("palsy-right"));
  const Outcome empty = Phrenic({"fluoroscopy", "cube-springs", "--out", Scratch("cube.png")});
  EXPECT_NE(empty.code, 0);
  EXPECT_THAT(empty.err, HasSubstr("no body of the scene has a tissue"));
}

}  // namespace
}  // namespace phrenic::client
