// `phrenic phantom` of a scene: files, numbers, and errors.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;

Outcome BreathPhantom(const std::string& folder, std::vector<std::string> more, const char* spacing_mm = "6") {
  std::vector<std::string> arguments = {"phantom",  "thorax", "--resolution", "12",  "--spacing", spacing_mm,
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

TEST(BreathingPhantom, OfASmallPersonIsTheAdultsScaled) {
  const auto lung = [](const char* height) {
    // The surface's volume is that of any voxels.
    const Outcome made =
        BreathPhantom(Scratch(height), {"--physique", std::string("height=") + height, "-o", "json"}, "10");
    EXPECT_EQ(made.code, 0) << made.err;
    return made.json()["phases"][0]["structures"]["lung_right"]["surface_ml"].get<double>();
  };
  EXPECT_NEAR(lung("1.4") / lung("1.75"), std::pow(1.4 / 1.75, 3), 1e-6);
}

// Returns the number of voxels of a phantom without a scene.
double Voxels(const std::string& out, std::vector<std::string> more) {
  std::vector<std::string> arguments = {"phantom", "--voxel", "8", "--out", out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome made = Phrenic(arguments);
  EXPECT_EQ(made.code, 0) << made.err;
  int x = 0, y = 0, z = 0;
  EXPECT_EQ(sscanf(made.out.substr(made.out.find(": ") + 2).c_str(), "%d x %d x %d", &x, &y, &z), 3) << made.out;
  return 1.0 * x * y * z;
}

TEST(Phantom, OfAPersonHasItsShapeAndTheAdultWrittenOutIsTodays) {
  const std::string adult = Scratch("adult.nii"), written = Scratch("written.nii"), woman = Scratch("woman.nii");
  const double of_adult = Voxels(adult, {});
  EXPECT_EQ(Voxels(written, {"--physique", "sex=male", "--physique", "age=30"}), of_adult);
  EXPECT_EQ(ReadAll(written), ReadAll(adult));
  EXPECT_LT(Voxels(woman, {"--physique", "sex=female"}), 0.85 * of_adult);
}

TEST(Phantom, ThatIsNoPersonIsAnErrorThatNamesTheNumber) {
  const auto error = [](const char* number) {
    return Phrenic({"phantom", "--physique", number, "--out", "x.nii"}).err;
  };
  EXPECT_THAT(error("age=7"), HasSubstr("age: 7 is outside 20 to 90 years"));
  EXPECT_THAT(error("hight=1.7"), HasSubstr("did you mean height?"));
  EXPECT_THAT(error("sex"), HasSubstr("name=value"));
  EXPECT_NE(Phrenic({"phantom", "--physique", "age=70", "--body", "tall", "--out", "x.nii"}).code, 0);
  EXPECT_THAT(Phrenic({"run", "cube-springs", "--physique", "age=70"}).err, HasSubstr("generates no body"));
}

}  // namespace
}  // namespace phrenic::client
