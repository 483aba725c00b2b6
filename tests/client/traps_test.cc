// What could be taken for an answer: wrong units, comparisons with nothing comparable, and arguments that cannot be
// right.
#include <gmock/gmock.h>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string SquareOfSide(const std::string& name, const std::string& side) {
  return WriteScratch(name + ".obj",
                      "v 0 0 0\nv " + side + " 0 0\nv " + side + " " + side + " 0\nv 0 " + side + " 0\nf 1 2 3 4\n");
}

TEST(Traps, AComparisonOfMetresWithMillimetresWarnsInEveryOutput) {
  const std::string a = SquareOfSide("millimetres", "200"), b = SquareOfSide("metres", "0.2");
  for (const char* output : {"table", "json", "csv"}) {
    const Outcome compared = Phrenic({"compare", a, b, "-o", output});
    EXPECT_EQ(compared.code, 0) << compared.err;
    EXPECT_THAT(compared.err, HasSubstr("warning: A is 282.8 mm across and B 0.2828 mm")) << output;
  }
  const Outcome right = Phrenic({"compare", a, b, "--unit-b", "1000"});
  EXPECT_THAT(right.err, Not(HasSubstr("warning")));
}

TEST(Traps, ArgumentsThatCannotBeRightAreErrorsOfUsage) {
  const std::string a = SquareOfSide("a", "200");
  const std::vector<std::vector<std::string>> lines = {
      {"run", "cube-springs", "--seconds", "-3"},
      {"run", "cube-springs", "--set", "x=99"},
      {"run", "cube-springs", "--set", "elasticity=-1"},
      {"run", "cube-springs", "--set", "elasticity=nan"},
      {"run", "cube-springs", "--set", "elasticity"},
      {"run", "cube-springs", "--set", "integrator=magic"},
      {"run", "cube-springs", "--pull", "cube"},
      {"run", "cube-springs", "--pull", "cube:0:1,2"},
      {"run", "cube-springs", "--export", "cube.xyz"},
      {"run", "cube-springs", "--export", "cube.msh", "--from", "nan"},
      {"study", "cost", "cube-springs", "--set", "x=99"},
      {"create", "cube-springs", "--set", "x=99"},
      {"set", "s", "x=99"},
      {"export", "s", "cube.xyz"},
      {"compare", a, a, "--map", "map.xyz"},
      {"compare", a, a, "--check", "x=1"},
      {"convert", a, Scratch("b.obj"), "--offset-mm", "0,1"},
      {"convert", a, Scratch("b.obj"), "--offset-mm", "0,nan,0"},
  };
  for (const auto& line : lines) {
    const Outcome run = Phrenic(line);
    EXPECT_EQ(run.code, 2) << ::testing::PrintToString(line) << run.err;
    EXPECT_THAT(run.err, Not(IsEmpty())) << ::testing::PrintToString(line);
  }
}

TEST(Traps, ANameWithTwoValuesIsAnErrorOfUsage) {
  const std::string a = SquareOfSide("twice", "200"), volume = Scratch("twice.nii.gz");
  const std::vector<std::vector<std::string>> lines = {
      {"phantom", "--out", volume, "--physique", "height=1.6", "--physique", "height=1.9"},
      {"run", "cube-springs", "--seconds", "0.01", "--set", "elasticity=1", "--set", "elasticity=2"},
      {"run", "cube-springs", "--seconds", "0.01", "--pull", "cube:0:0,0,1", "--pull", "cube:0:0,0,2"},
      {"set", "s", "breath_force=1", "breath_force=2"},
      {"compare", a, a, "--check", "hd95_max=1,hd95_max=2"},
      {"fit", "thorax", "--volume", a, "--error", "volume=1", "--error", "volume=2"},
      {"credibility", "thorax", "--use", a, "--evidence", "x=a", "--evidence", "x=b"},
      {"calibrate", "thorax", "--vary", "breath_force", "--vary", "breath_force:1:2"},
      {"study", "sensitivity", "thorax", "--vary", "breath_force:1:2", "--vary", "breath_force:1:3"},
  };
  for (const auto& line : lines) {
    const Outcome run = Phrenic(line);
    EXPECT_EQ(run.code, 2) << ::testing::PrintToString(line) << run.err;
    EXPECT_THAT(run.err, HasSubstr(" is given twice, as ")) << ::testing::PrintToString(line);
  }
  const Outcome two =
      Phrenic({"run", "cube-springs", "--seconds", "0.01", "--set", "elasticity=1", "--set", "time_step=0.001"});
  EXPECT_EQ(two.code, 0) << two.err;
}

TEST(Traps, OnlyAModelOfTheThesisIsComparedWithTheThesis) {
  const Outcome sheet = Phrenic({"run", "sheet-2d", "--seconds", "0.1"});
  ASSERT_EQ(sheet.code, 0) << sheet.err;
  EXPECT_THAT(sheet.out, Not(HasSubstr("thesis")));
  const Outcome json = Phrenic({"run", "sheet-2d", "--seconds", "0.1", "-o", "json"});
  EXPECT_FALSE(json.json().contains("thesis"));
  const Outcome cube = Phrenic({"run", "cube-springs", "--seconds", "0.1"});
  EXPECT_THAT(cube.out, HasSubstr("fig. 5.10"));
}

TEST(Convert, ShiftsASurfaceInTheUnitOfItsFile) {
  const std::string in = WriteScratch("shift.obj", "v 0 135 0\nv 1 135 0\nv 0 136 0\nf 1 2 3\n"),
                    out = Scratch("out.obj");
  ASSERT_EQ(Phrenic({"convert", in, out, "--offset-mm", "0,-135,0"}).code, 0);
  EXPECT_THAT(ReadAll(out), HasSubstr("v 0 0 0\nv 1 0 0\nv 0 1 0\n"));
  ASSERT_EQ(Phrenic({"convert", in, out, "--out-unit-mm", "10", "--offset-mm", "0,-130,0"}).code, 0);
  EXPECT_THAT(ReadAll(out), HasSubstr("v 0 0.5 0\n"));
}

}  // namespace
}  // namespace phrenic::client
