// `phrenic phantom` of a scene: files, numbers, and errors.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;

Outcome BreathPhantom(const std::string& folder, std::vector<std::string> more) {
  std::vector<std::string> arguments = {"phantom",  "thorax", "--resolution", "12",  "--spacing", "6",
                                        "--phases", "2",      "--out",        folder};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Phrenic(arguments);
}

TEST(BreathingPhantom, WritesThePhasesOfABreathAndTheSameAgain) {
  const std::string folder = Scratch("breath"), again = Scratch("breath-again");
  const Outcome made = BreathPhantom(folder, {"--ct", "--field", "--dicom", "seg,obj,stl,ct", "-o", "json"});
  ASSERT_EQ(made.code, 0) << made.err;
  for (const char* file : {"labels-00.nii.gz", "labels-01.nii.gz", "ct-01.nii.gz", "field-01.nii.gz", "seg-01.dcm",
                           "obj-00.dcm", "stl-01.dcm", "ct-01/0001.dcm", "report.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder + "/" + file)) << file;
  }
  EXPECT_FALSE(std::filesystem::exists(folder + "/field-00.nii.gz"));
  EXPECT_EQ(made.json()["phases"].size(), 2U);
  EXPECT_EQ(made.json()["phases"][0]["time"], 0);
  EXPECT_TRUE(made.json()["moved_with_their_surfaces_without_tissue"].empty());
  EXPECT_NEAR(made.json()["phases"][1]["time"], 2, 0.01);
  const auto lung = [&](int phase) {
    return made.json()["phases"][phase]["structures"]["lung_right"]["surface_ml"].get<double>();
  };
  EXPECT_GT(lung(1), 1.05 * lung(0));
  ASSERT_EQ(BreathPhantom(again, {"--ct", "--field", "--dicom", "seg"}).code, 0);
  for (const char* file : {"labels-01.nii.gz", "ct-01.nii.gz", "field-01.nii.gz", "seg-01.dcm"}) {
    EXPECT_EQ(ReadAll(folder + "/" + file), ReadAll(again + "/" + file)) << file;
  }
}

TEST(BreathingPhantom, ThatCannotBeIsAnErrorWithTheRemedy) {
  EXPECT_THAT(BreathPhantom(Scratch("b"), {"--preset", "none"}).err, HasSubstr("palsy-right"));
  EXPECT_THAT(BreathPhantom(Scratch("b"), {"--dicom", "pdf"}).err, HasSubstr("seg"));
  EXPECT_NE(BreathPhantom(Scratch("b"), {"--body", "tall"}).code, 0);
  for (const char* option : {"--labels", "--noise", "--holes", "--seed"}) {  // of a body in one volume
    const Outcome refused = BreathPhantom(Scratch("b"), {option, option[2] == 'l' ? "totalsegmentator" : "0"});
    EXPECT_NE(refused.code, 0) << option;
    EXPECT_THAT(refused.err, HasSubstr(option));
  }
  EXPECT_NE(Phrenic({"phantom", "--ct", "--out", Scratch("c")}).code, 0);
  const Outcome empty = Phrenic({"phantom", "cube-springs", "--out", Scratch("cube")});
  EXPECT_NE(empty.code, 0);
  EXPECT_THAT(empty.err, HasSubstr("no closed body of the scene has a tissue"));
  EXPECT_THAT(Phrenic({"phantom", "thorax", "--resolution", "12", "--out", WriteScratch("file", "x")}).err,
              HasSubstr("it is a folder"));
}

}  // namespace
}  // namespace phrenic::client
