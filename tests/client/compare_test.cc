// `phrenic compare`: distances of surfaces and motions, limits, colour maps, and invalid input.
#include <gmock/gmock.h>

#include <cstdlib>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

// A square of 100 mm at height z [mm].
std::string Square(const std::string& name, const std::string& z) {
  return WriteScratch(name + ".obj",
                      "v 0 0 " + z + "\nv 100 0 " + z + "\nv 100 100 " + z + "\nv 0 100 " + z + "\nf 1 2 3 4\n");
}

bool Installed(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

TEST(Compare, JsonHasEveryMeasureInMillimetres) {
  const Outcome compared = Phrenic({"compare", Square("a", "0"), Square("b", "3"), "-o", "json"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  const auto json = compared.json();
  ASSERT_FALSE(json.is_discarded()) << compared.out;
  EXPECT_THAT(json["definition"].get<std::string>(), StartsWith("phrenic-surface-distance-1"));
  const auto distance = json["rows"][0]["distance"];
  for (const char* measure : {"hd_max", "hd95_max", "hd95_pooled", "assd", "mean_a_to_b", "mean_b_to_a", "rms_a_to_b",
                              "rms_b_to_a", "p95_a_to_b", "p95_b_to_a"}) {
    EXPECT_NEAR(distance[measure].get<double>(), 3, 1e-6) << measure;
  }
  EXPECT_EQ(distance["surface_dice"], 0);
  EXPECT_GT(std::stoi(distance["samples_a"].get<std::string>()), 20'000);
}

TEST(Compare, TableAndCsvHaveTheSameNumbers) {
  const std::string a = Square("a", "0"), b = Square("b", "3");
  const Outcome table = Phrenic({"compare", a, b});
  ASSERT_EQ(table.code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("hd95_max      mm        3.0000"));
  EXPECT_THAT(table.err, IsEmpty());
  const Outcome csv = Phrenic({"compare", a, b, "--output", "csv"});
  ASSERT_EQ(csv.code, 0) << csv.err;
  EXPECT_THAT(csv.out, StartsWith("region,time,hd_max,hd_max_bound,hd95_max,"));
  EXPECT_THAT(csv.out, HasSubstr("\n,,3,3.0003,3,3,3,"));
}

TEST(Compare, AnExceededLimitIsNamedAndHasExitCodeFour) {
  const std::string a = Square("a", "0"), b = Square("b", "3");
  const Outcome kept = Phrenic({"compare", "--check", "hd_max=3.1,surface_dice=1", "--tolerance", "4", a, b});
  EXPECT_EQ(kept.code, 0) << kept.err;
  const Outcome missed =
      Phrenic({"compare", a, b, "--check", "hd_max=3.1,mean_a_to_b=1", "--check", "surface_dice=0.9"});
  EXPECT_EQ(missed.code, 4);
  EXPECT_THAT(missed.err, HasSubstr("mean_a_to_b is 3 mm; the limit is at most 1"));
  EXPECT_THAT(missed.err, HasSubstr("surface_dice is 0; the limit is at least 0.9"));
  EXPECT_THAT(missed.out, HasSubstr("hd_max")) << "the numbers are printed anyway";
  const std::string wire = WriteScratch("wire.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  const Outcome nothing = Phrenic({"compare", a, wire, "--check", "hd_max=1000"});
  EXPECT_EQ(nothing.code, 4) << "NaN meets no limit";
  EXPECT_THAT(nothing.out, HasSubstr("NaN"));
}

TEST(Compare, TheMapOpensInGmsh) {
  const std::string map = Scratch("map.msh");
  ASSERT_EQ(Phrenic({"compare", Square("a", "0"), Square("b", "3"), "--map", map}).code, 0);
  if (!Installed("command -v gmsh")) GTEST_SKIP() << "gmsh is not installed";
  const std::string geo = WriteScratch("map.geo", "Merge \"" + map +
                                                      "\";\nPrintf(\"nodes %g\", Mesh.NbNodes);\n"
                                                      "Printf(\"least %g most %g\", View[0].Min, View[0].Max);\n");
  const std::string log = Scratch("map.log");
  ASSERT_EQ(std::system(("gmsh -parse_and_exit " + geo + " >" + log + " 2>&1").c_str()), 0);
  EXPECT_THAT(ReadAll(log), HasSubstr("nodes 4"));
  EXPECT_THAT(ReadAll(log), HasSubstr("least 3 most 3"));
}

TEST(Compare, TheMapOpensInVtk) {
  const std::string map = Scratch("map.vtp"), out = Scratch("map.txt");
  ASSERT_EQ(Phrenic({"compare", Square("a", "0"), Square("b", "3"), "--map", map}).code, 0);
  if (!Installed("/usr/bin/python3 -c 'import vtk'")) GTEST_SKIP() << "VTK is not installed (python3-vtk9)";
  const std::string script = WriteScratch("map.py",
                                          "import sys, vtk\n"
                                          "reader = vtk.vtkXMLPolyDataReader()\n"
                                          "reader.SetFileName(sys.argv[1])\n"
                                          "reader.Update()\n"
                                          "out = reader.GetOutput()\n"
                                          "print(out.GetNumberOfPoints(), out.GetNumberOfCells(),\n"
                                          "      out.GetPointData().GetScalars().GetRange(), out.GetBounds())\n");
  ASSERT_EQ(std::system(("/usr/bin/python3 " + script + " " + map + " >" + out + " 2>&1").c_str()), 0);
  EXPECT_EQ(ReadAll(out), "4 2 (3.0, 3.0) (0.0, 100.0, 0.0, 100.0, 0.0, 0.0)\n");
}

TEST(Compare, ExportedMotionsHaveARowPerTimeAndABaseline) {
  const std::string a = Scratch("a.msh"), b = Scratch("b.msh");
  for (const auto& [file, force] : {std::pair(a, "1"), std::pair(b, "2")}) {
    const Outcome run = Phrenic({"run", "cube-tensegrity", "--seconds", "1", "--fps", "4", "--set",
                                 std::string("breath_force=") + force, "--export", file});
    ASSERT_EQ(run.code, 0) << run.err;
  }
  const Outcome itself = Phrenic({"compare", a, a, "-o", "json", "--check", "hd_max=1e-6"});
  ASSERT_EQ(itself.code, 0) << itself.err;
  EXPECT_EQ(itself.json()["rows"].size(), 6U) << "one over all times and five times";
  EXPECT_GT(itself.json()["rows"][0]["baseline"]["hd_max"].get<double>(), 1) << "the cube moves";
  const Outcome other = Phrenic({"compare", a, b, "--regions"});
  ASSERT_EQ(other.code, 0) << other.err;
  EXPECT_THAT(other.out, HasSubstr("standing still"));
  EXPECT_THAT(other.out, HasSubstr("at each time [s], in mm"));
}

TEST(Compare, ANamedServerCompares) {
  const RunningServer server;
  ASSERT_GT(server.port(), 0);
  const std::string a = Square("a", "0"), b = Square("b", "3");
  const Outcome there = Phrenic({"compare", a, b, "--server", server.address(), "-o", "csv"});
  ASSERT_EQ(there.code, 0) << there.err;
  EXPECT_EQ(there.out, Phrenic({"compare", a, b, "-o", "csv"}).out);
  EXPECT_EQ(Phrenic({"compare", a, b, "--server", "127.0.0.1:1"}).code, 3);
}

TEST(Compare, ASessionsBodyIsComparedInItsPresentState) {
  const RunningServer server;
  ASSERT_GT(server.port(), 0);
  const std::vector<std::string> at = {"--server", server.address()};
  const auto there = [&](std::vector<std::string> words) {
    words.insert(words.end(), at.begin(), at.end());
    return Phrenic(words);
  };
  ASSERT_EQ(there({"create", "cube-tensegrity", "--id", "cube"}).code, 0);
  const std::string cube = Scratch("cube.msh");
  ASSERT_EQ(there({"export", "cube", cube, "--seconds", "1", "--fps", "2"}).code, 0);
  const Outcome same = there({"compare", "session:cube/cube", cube, "-o", "json", "--check", "hd_max=1e-3"});
  ASSERT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(same.json()["a"], "session:cube/cube");
  EXPECT_EQ(same.json()["state_a"]["tick"], "0");
  const Outcome later = there({"compare", "session:cube", cube, "--time-b", "1", "--check", "hd_max=1e-3"});
  EXPECT_EQ(later.code, 4) << "the cube moves in that second";
  EXPECT_THAT(later.out, HasSubstr("A is cube of session cube at 0 s, tick 0"));
  const Outcome nobody = there({"compare", "session:nobody", cube});
  EXPECT_EQ(nobody.code, 1);
  EXPECT_THAT(nobody.err, HasSubstr("there is no session \"nobody\""));
  EXPECT_EQ(Phrenic({"compare", "session:cube", cube, "--server", "127.0.0.1:1"}).code, 3);
}

struct BadArguments {
  std::vector<std::string> arguments;
  int code;
  const char* words;
};

TEST(Compare, InvalidArgumentsHaveTheRightExitCode) {
  const std::string a = Square("a", "0");
  const BadArguments lines[] = {
      {{a}, 2, "B is required"},
      {{a, "/nowhere/b.obj"}, 1, "cannot read the surface \"/nowhere/b.obj\""},
      {{a, testing::TempDir()}, 1, "cannot read"},
      {{a, WriteScratch("b.stp", "solid")}, 2, "b.stp:1: the file name extension is not one of"},
      {{a, WriteScratch("bad.obj", "v 1 2\n")}, 2, "bad.obj:1:"},
      {{a, a, "--check", "hd=2"}, 2, "there is no measure \"hd\"; there are hd_max"},
      {{a, a, "--check", "hd_max"}, 2, "write measure=number"},
      {{a, a, "--check", "hd_max=soon"}, 2, "write measure=number"},
      {{a, a, "--tolerance", "-1"}, 2, "--tolerance"},
      {{a, a, "--spacing", "0.0001"}, 2, "spacing_mm: 0.0001 mm needs"},
      {{a, a, "--map", "map"}, 2, "there are msh, vtp"},
      {{a, a, "--map", Scratch("map.png")}, 2, "there are msh, vtp"},
      {{a, a, "--map", "/nowhere/map.vtp"}, 1, "cannot write /nowhere/map.vtp"},
      {{a, a, "-o", "yaml"}, 2, "--output"},
  };
  for (const BadArguments& line : lines) {
    std::vector<std::string> arguments = {"compare"};
    arguments.insert(arguments.end(), line.arguments.begin(), line.arguments.end());
    const Outcome compared = Phrenic(arguments);
    EXPECT_EQ(compared.code, line.code) << testing::PrintToString(line.arguments);
    EXPECT_THAT(compared.err, HasSubstr(line.words)) << testing::PrintToString(line.arguments);
  }
}

TEST(Compare, HelpIsMadeFromTheSchema) {
  const Outcome help = Phrenic({"compare", "--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* words : {"hd95_pooled", "95th percentile over both surfaces' area together", "Tolerance [mm]"}) {
    EXPECT_THAT(help.out, HasSubstr(words));
  }
}

}  // namespace
}  // namespace phrenic::client
