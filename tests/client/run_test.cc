// `phrenic run`: simulation and export without a server, and invalid input.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Returns a scene, with the text `from` replaced by `to`.
std::string Scene(const std::string& from = "", const std::string& to = "") {
  std::string text = R"(
    name: "sheet"
    bodies {
      name: "sheet" role: ROLE_DEFORMABLE mass: 3 fixed_vertices: [0]
      polyhedron { vertices { } vertices { x: 1 } vertices { y: 1 } triangles { a: 0 b: 1 c: 2 } }
    }
    forces { springs { bodies: "sheet" stiffness: 20 } }
    forces { gravity { bodies: "sheet" acceleration { z: -1 } } }
    probes { name: "corner" body: "sheet" vertex: 2 }
    parameters { time_step: 0.01 }
  )";
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(Run, PrintsTheCostBesideTheThesisFigure) {
  const Outcome run = Phrenic({"run", "cube-tensegrity", "--seconds", "1"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("8 vertices, 12 springs, 4 rigid links"));
  EXPECT_THAT(run.out, HasSubstr("1.000 s simulated in 200 steps"));
  EXPECT_THAT(run.out, HasSubstr("x real time"));
  EXPECT_THAT(run.out, HasSubstr("fig. 5.10, cube, 8 vertices, with rigid links"));
  EXPECT_THAT(run.err, IsEmpty()) << "no progress bar without a terminal";
}

TEST(Run, JsonHasTheNumbersAndTheReport) {
  const Outcome run = Phrenic({"run", "cube-springs", "--seconds", "0.5", "-o", "json"});
  ASSERT_EQ(run.code, 0) << run.err;
  const auto json = run.json();
  ASSERT_FALSE(json.is_discarded()) << run.out;
  EXPECT_EQ(json["steps"], 100);
  EXPECT_NEAR(json["simulated_seconds"].get<double>(), 0.5, 1e-9);
  EXPECT_GT(json["steps_per_second"].get<double>(), 0);
  EXPECT_GT(json["thesis"]["steps_per_second"].get<double>(), 0);
  EXPECT_EQ(json["report"]["scene"], "cube-springs");
}

// Two masses at a metre's distance from each other and from two ends that are driven three metres apart.
std::string Torn() {
  return WriteScratch("torn.textproto", R"(
    name: "torn"
    bodies {
      name: "row" role: ROLE_DEFORMABLE mass: 4
      polyhedron { vertices { } vertices { x: 1 } vertices { x: 2 } vertices { x: 3 } }
    }
    motions { oscillation { body: "row" vertices: [0] amplitude { x: -1 } period: 1 } }
    motions { oscillation { body: "row" vertices: [3] amplitude { x: 1 } period: 1 } }
    constraints {
      rigid_links { body: "row" list { links { a: 0 b: 1 } links { a: 1 b: 2 } links { a: 2 b: 3 } } }
    }
    parameters { time_step: 0.01 }
  )");
}

TEST(Run, WarnsOfLinksThatContradictEachOtherInEveryOutput) {
  const std::string what = "rigid-links:row does not hold, it is off by";
  const std::string file = Torn();
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--export", Scratch("torn.msh")}, {"-o", "json"}}) {
    std::vector<std::string> words = {"run", file, "--seconds", "0.25"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_THAT(Phrenic(words).err, HasSubstr(what));
    words.insert(words.end(), {"--check", "residual_mm=0.001"});
    const Outcome checked = Phrenic(words);
    EXPECT_EQ(checked.code, 4);
    EXPECT_THAT(checked.err, HasSubstr("the limit is at most 0.001"));
  }
  EXPECT_EQ(Phrenic({"run", "cube-tensegrity", "--seconds", "1", "--check", "residual_mm=0.001"}).code, 0);
  EXPECT_THAT(Phrenic({"run", file, "--check", "height=3"}).err, HasSubstr("residual_mm=LIMIT"));
}

// An export steps a copy of the session: what is reported is that copy at its end.
TEST(Run, WithAnExportReportsTheEndOfTheRun) {
  const Outcome run = Phrenic({"run", Torn(), "--seconds", "0.25", "--export", Scratch("torn.msh"), "-o", "json"});
  ASSERT_EQ(run.code, 0) << run.err;
  const auto json = run.json();
  ASSERT_FALSE(json.is_discarded()) << run.out;
  EXPECT_NEAR(json["session"]["time"].get<double>(), 0.25, 1e-9);
  EXPECT_GT(json["session"]["constraint_residual"].get<double>(), 0.1);
  EXPECT_GT(json["constraint_residual_mm"].get<double>(), 100);
  EXPECT_EQ(json["warnings"].size(), 1);
  EXPECT_EQ(json["session"]["warnings"], json["warnings"]);
}

TEST(Run, PrintsTheScenesMeasures) {
  const std::string measured = "measures { name: 'height' highest { body: 'sheet' } } parameters";
  const std::string file = WriteScratch("measured.textproto", Scene("parameters", measured));
  const Outcome run = Phrenic({"run", file, "--seconds", "0.5"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("measure"));
  EXPECT_THAT(run.out, HasSubstr("height"));
  EXPECT_THAT(run.out, HasSubstr("mm"));
  const auto json = Phrenic({"run", file, "--seconds", "0.5", "-o", "json"}).json();
  ASSERT_EQ(json["measures"].size(), 1U);
  const auto& height = json["measures"][0];
  EXPECT_EQ(height["name"], "height");
  EXPECT_EQ(height["unit"], "m");
  EXPECT_LE(height["minimum"].get<double>(), height["last"].get<double>());
  EXPECT_LE(height["last"].get<double>(), height["maximum"].get<double>());
  EXPECT_EQ(height["maximum"].get<double>(), 0) << "one corner is fixed and the others fall";
}

TEST(Run, EqualSettingsGiveEqualHashesOthersDoNot) {
  const auto hash = [](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", "cube-tensegrity", "--seconds", "1", "--output", "json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome run = Phrenic(arguments);
    EXPECT_EQ(run.code, 0) << run.err;
    return run.json()["state_hash"].get<std::string>();
  };
  const std::string plain = hash({});
  EXPECT_EQ(plain.size(), 16U);
  EXPECT_EQ(hash({}), plain);
  EXPECT_EQ(hash({"--export", Scratch("same.msh")}), plain) << "recording does not change the motion";
  EXPECT_NE(hash({"--set", "breath_force=2"}), plain);
  EXPECT_NE(hash({"--set", "apply_links=off"}), plain);
}

TEST(Run, ExportedMshOpensInGmshWithEveryFrame) {
  const std::string file = Scratch("motion.msh");
  const Outcome run = Phrenic({"run", "cube-tensegrity", "--seconds", "2", "--fps", "5", "--export", file});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("wrote " + file));
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
  if (std::system("command -v gmsh >/dev/null 2>&1") != 0) GTEST_SKIP() << "gmsh is not installed";
  const std::string geo = WriteScratch("motion.geo", "Merge \"" + file +
                                                         "\";\nPrintf(\"steps %g\", View[0].NbTimeStep);\n"
                                                         "Printf(\"nodes %g\", Mesh.NbNodes);\n"
                                                         "Printf(\"largest %g\", View[0].Max);\n");
  const std::string log = Scratch("gmsh.log");
  ASSERT_EQ(std::system(("gmsh -parse_and_exit " + geo + " >" + log + " 2>&1").c_str()), 0);
  EXPECT_THAT(ReadAll(log), HasSubstr("steps 11"));
  EXPECT_THAT(ReadAll(log), HasSubstr("nodes 8"));
  EXPECT_THAT(ReadAll(log), Not(HasSubstr("largest 0\n"))) << "the cube moves";
}

TEST(Run, ExportedDeplHasARowPerVertexAndFrame) {
  const std::string file = Scratch("motion.depl");
  const Outcome run = Phrenic({"run", "cube-springs", "--seconds", "1", "--fps", "4", "--export", file});
  ASSERT_EQ(run.code, 0) << run.err;
  std::ifstream depl(file);
  std::string kind;
  int vertices = 0, shapes = 0, rows = 0;
  depl >> kind >> vertices >> shapes >> rows;
  EXPECT_EQ(kind, "TRIANGLES");
  EXPECT_EQ(vertices, 8);
  EXPECT_EQ(rows, 5);
  const std::vector<double> numbers((std::istream_iterator<double>(depl)), {});
  EXPECT_EQ(numbers.size(), 8U * 5 * 3);
}

TEST(Run, ASceneIsDescribedWithoutAServer) {
  const Outcome outcome = Phrenic({"describe", "cube-tensegrity"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Largest stable step"));
  EXPECT_EQ(Phrenic({"describe", "cube-tensegrity", "--server", "127.0.0.1:1"}).code, 3) << "it asks the named server";
}

TEST(Run, ASceneFileRuns) {
  const Outcome run = Phrenic({"run", WriteScratch("own.textproto", Scene()), "--seconds", "0.1", "-o", "json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.json()["steps"], 10);
}

TEST(Run, ADivergedRunFailsAndLeavesNoFile) {
  const std::string scene = WriteScratch("diverges.textproto", Scene("time_step: 0.01", "time_step: 0.1"));
  const std::string file = Scratch("diverged.msh");
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--export", file}}) {
    std::vector<std::string> arguments = {"run", scene, "--seconds", "60", "--set", "elasticity=100"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome run = Phrenic(arguments);
    EXPECT_EQ(run.code, 1);
    EXPECT_THAT(run.err, HasSubstr("diverged"));
    EXPECT_THAT(run.err, HasSubstr("time_step")) << "the remedy is named";
  }
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
}

struct BadScene {
  const char* what;
  const char* from;
  const char* to;
  const char* words;
  int code = 2;
};

TEST(Run, InvalidScenesAreRejectedWithFieldOrLine) {
  const BadScene scenes[] = {
      {"malformed", "bodies {", "bodies [", "bad.textproto:4:"},
      {"unknown field", "mass: 3", "maas: 3", "maas"},
      {"negative mass", "mass: 3", "mass: -3", "bodies[0].mass: -3 is outside"},
      {"index past the end", "fixed_vertices: [0]", "fixed_vertices: [7]", "7"},
      {"triangle past the end", "c: 2 }", "c: 9 }", "9"},
      {"empty body", "vertices { } vertices { x: 1 } vertices { y: 1 } triangles { a: 0 b: 1 c: 2 }", "", "vertices"},
      {"unknown body", "springs { bodies: \"sheet\"", "springs { bodies: \"shoot\"", "shoot"},
      {"parameter out of range", "time_step: 0.01", "breath_force: 99", "breath_force: 99 is outside 0 to 20"},
      {"missing mesh file",
       "polyhedron { vertices { } vertices { x: 1 } vertices { y: 1 } triangles { a: 0 b: 1 c: 2 } }",
       "file { path: \"nowhere/lung.obj\" }", "lung.obj", 1},
  };
  for (const BadScene& scene : scenes) {
    const std::string file = WriteScratch("bad.textproto", Scene(scene.from, scene.to));
    const Outcome run = Phrenic({"run", file, "--seconds", "0.1", "--data", testing::TempDir()});
    EXPECT_EQ(run.code, scene.code) << scene.what;
    EXPECT_THAT(run.err, HasSubstr(scene.words)) << scene.what;
    EXPECT_THAT(run.out, IsEmpty()) << scene.what;
  }
}

struct BadRun {
  std::vector<std::string> arguments;
  int code;
  const char* words;
};

TEST(Run, InvalidArgumentsHaveTheRightExitCode) {
  const BadRun lines[] = {
      {{"run", "no-such-scene"}, 1, "cube-springs"},
      {{"run", "/nowhere/scene.textproto"}, 1, "/nowhere/scene.textproto"},
      {{"run", "cube-springs", "--set", "breath_force=99"}, 2, "breath_force: 99 is outside 0 to 20"},
      {{"run", "cube-springs", "--set", "breath_farce=1"}, 2, "breath_force"},
      {{"run", "cube-springs", "--set", "breath_force"}, 2, "name=value"},
      {{"run", "cube-springs", "--set", "integrator=magic"}, 2, "did you mean static? There are semi_implicit_euler"},
      {{"run", "cube-springs", "--export", Scratch("motion.avi")}, 2, "msh, depl"},
      {{"run", "cube-springs", "--export", "/nowhere/motion.msh"}, 1, "/nowhere/motion.msh"},
      {{"run", "cube-springs", "--seconds", "-1"}, 2, "--seconds"},
      {{"run", "cube-springs", "--resolution", "0.01"}, 2, "--resolution"},
      {{"run", "cube-springs", "-o", "yaml"}, 2, "--output"},
      {{"run"}, 2, "SCENE"},
      {{"dance"}, 2, ""},
      {{"lern"}, 2, "first examples are in the help"},
      {{"rnu"}, 2, "did you mean run?"},
      {{"RUN"}, 2, "did you mean run?"},
      {{"campaign", "rnu"}, 2, "did you mean run?"},
      {{"lsit"}, 2, "did you mean sessions?"},
      {{"--halp"}, 2, "did you mean --help?"},
      {{"run", "--halp"}, 2, "did you mean --help?"},
      {{}, 2, "Usage\n  phrenic COMMAND"},
  };
  for (const BadRun& line : lines) {
    const Outcome run = Phrenic(line.arguments);
    EXPECT_EQ(run.code, line.code) << testing::PrintToString(line.arguments);
    EXPECT_THAT(run.err, HasSubstr(line.words)) << testing::PrintToString(line.arguments);
  }
}

TEST(Help, IsMadeFromTheSchema) {
  const Outcome help = Phrenic({"run", "--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* words : {"breath_force", "0 to 20", "time_step", "automatic", "Switches every action line",
                            "integrator", "velocity_verlet"}) {
    EXPECT_THAT(help.out, HasSubstr(words));
  }
  const Outcome all = Phrenic({"--help"});
  EXPECT_EQ(all.code, 0);
  for (const char* command : {"scenes", "describe", "run", "create", "sessions", "watch", "set", "play", "pause",
                              "step", "reset", "delete", "export"}) {
    EXPECT_THAT(all.out, HasSubstr(command));
  }
}

// True if the process has an open file without a name: its spool.
bool Spools(pid_t pid) {
  std::error_code error;
  const std::string folder = "/proc/" + std::to_string(pid) + "/fd";
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string target = std::filesystem::read_symlink(entry.path(), error).string();
    if (target.find("(deleted)") != std::string::npos) return true;
  }
  return false;
}

TEST(Run, InterruptedLeavesNoFiles) {
  const std::string file = Scratch("interrupted.msh"), spool = Scratch("spool");
  std::filesystem::create_directory(spool);
  const std::vector<std::string> words = {"run",  "cube-springs", "--seconds", "3600",    "--fps",
                                          "1000", "--export",     file,        "--spool", spool};
  const pid_t pid = Start("phrenic", words, Scratch("out"), Scratch("err"));
  for (int tries = 0; tries < 600 && !Spools(pid); ++tries) usleep(20'000);
  ASSERT_TRUE(Spools(pid));
  kill(pid, SIGINT);
  EXPECT_EQ(WaitFor(pid), 130);
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
  EXPECT_TRUE(std::filesystem::is_empty(spool));
}

TEST(Run, ASurfaceIsExportedAtTheEndAndNumbersAsRows) {
  const std::string end = Scratch("end.ply"), csv = Scratch("numbers.csv");
  ASSERT_EQ(Phrenic({"run", "cube-tensegrity", "--seconds", "1", "--export", end}).code, 0);
  const Outcome inspected = Phrenic({"inspect", end});
  EXPECT_THAT(inspected.out, HasSubstr("vertices                      8\n"));
  const std::string own = WriteScratch("own.textproto", Scene());
  ASSERT_EQ(Phrenic({"run", own, "--seconds", "0.1", "--every", "5", "--export", csv}).code, 0);
  EXPECT_THAT(ReadAll(csv),
              testing::StartsWith("time [s],corner x [mm],corner y [mm],corner z [mm]\n0,0,1000,0\n0.05,"));
}

}  // namespace
}  // namespace phrenic::client
