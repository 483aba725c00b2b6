// A command fails and names its output if that cannot be written: standard output, and each file that a command writes.
// /dev/full behaves as a full disk.
#include <gmock/gmock.h>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

// True if the system has the device that refuses every byte.
bool HasFullDevice() { return std::filesystem::is_character_file("/dev/full"); }

// Runs `phrenic` with its standard output on a device.
Outcome PhrenicTo(const std::string& device, const Words& words) {
  Outcome outcome;
  outcome.code = WaitFor(Start("phrenic", words, device, Scratch("err")));
  outcome.err = ReadAll(Scratch("err"));
  return outcome;
}

std::string Cube() {
  static const std::string& file = *new std::string(Scratch("full-cube.stl"));
  if (!std::filesystem::exists(file)) {
    EXPECT_EQ(Phrenic({"run", "cube-springs", "--seconds", "0.01", "--export", file}).code, 0);
  }
  return file;
}

// Commands that need no server, short and long outputs, in each format.
std::vector<Words> PrintingCommands() {
  return {{"--help"},
          {"--version"},
          {"man"},
          {"run", "--help"},
          {"completion", "bash"},
          {"__complete", "phrenic "},
          {"run", "cube-springs", "--seconds", "0.01"},
          {"run", "cube-springs", "--seconds", "0.01", "-o", "json"},
          {"run", "cube-springs", "--seconds", "0.01", "--field", "session.tick"},
          {"run", "cube-springs", "--dry-run"},
          {"describe", "cube-springs"},
          {"describe", "thorax", "--resolution", "20", "-o", "json"},
          {"study", "error", "cube-springs", "--seconds", "0.1", "--levels", "2", "-o", "csv"},
          {"inspect", Cube()},
          {"compare", Cube(), Cube()},
          {"compare", Cube(), Cube(), "-o", "csv"},
          {"convert", Cube(), Scratch("full.ply")}};
}

TEST(FullDisk, AsStandardOutputFailsEveryCommand) {
  if (!HasFullDevice()) GTEST_SKIP() << "no /dev/full";
  for (const Words& words : PrintingCommands()) {
    const Outcome kept = PhrenicTo("/dev/null", words);
    EXPECT_EQ(kept.code, 0) << testing::PrintToString(words) << kept.err;
    const Outcome lost = PhrenicTo("/dev/full", words);
    EXPECT_EQ(lost.code, 1) << testing::PrintToString(words);
    EXPECT_THAT(lost.err, HasSubstr("phrenic: standard output: No space left on device"))
        << testing::PrintToString(words);
  }
}

// A watch would go on for as long as the session plays.
TEST(FullDisk, EndsAWatch) {
  if (!HasFullDevice()) GTEST_SKIP() << "no /dev/full";
  RunningServer server;
  ASSERT_NE(server.port(), 0) << server.output();
  ASSERT_EQ(Phrenic({"create", "cube-springs", "--id", "class", "--play", "--server", server.address()}).code, 0);
  for (const Words& more : {Words{"-o", "csv"}, {"-o", "jsonl"}, {"-o", "csv", "--every", "0.05"}}) {
    Words words = {"watch", "class", "--server", server.address()};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome watched = PhrenicTo("/dev/full", words);
    EXPECT_EQ(watched.code, 1) << testing::PrintToString(words);
    EXPECT_THAT(watched.err, HasSubstr("standard output: No space left on device"));
  }
}

TEST(FullDisk, KeepsTheExitCodeOfACommandThatFailsAnyway) {
  if (!HasFullDevice()) GTEST_SKIP() << "no /dev/full";
  const Outcome missed = PhrenicTo("/dev/full", {"compare", Cube(), Cube(), "--check", "area_a=0"});
  EXPECT_EQ(missed.code, 4) << missed.err;
  EXPECT_THAT(missed.err, HasSubstr("standard output"));
  EXPECT_EQ(PhrenicTo("/dev/full", {"run", "no-such-scene"}).code, 1);
}

// Each option that names a file to write, and each argument.
TEST(FullDisk, AsAFileFailsEveryCommand) {
  if (!HasFullDevice()) GTEST_SKIP() << "no /dev/full";
  const std::string sweep = WriteScratch("full-sweep.textproto", "name: 'n' scenes: 'cube-springs' seconds: 0.01");
  const Words study = {"study", "error", "cube-springs", "--seconds", "0.1", "--levels", "2"};
  const std::string limits =
      WriteScratch("full-limits.textproto", R"(limits { table: "rows" column: "error_max_mm" at_most: 1e9 })");
  const auto with = [](Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  std::vector<Words> lines = {with(study, {"--check", limits, "--junit", "/dev/full"}),
                              {"campaign", "run", sweep, "--out", Scratch("full-campaign"), "--page", "/dev/full"},
                              {"compare", Cube(), Cube(), "--check", "assd=1", "--junit", "/dev/full"}};
  const bool has_viewer = std::filesystem::exists(PHRENIC_SOURCE_DIR "/web/dist/report.html");
  if (has_viewer) lines.push_back(with(study, {"--page", "/dev/full"}));
  for (const Words& words : lines) {
    const Outcome outcome = Phrenic(words);
    EXPECT_EQ(outcome.code, 1) << testing::PrintToString(words) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("cannot write /dev/full")) << testing::PrintToString(words);
  }
}

// The formats follow from the endings, so that the device needs a name with an ending.
TEST(FullDisk, AsAFileWithAnEndingFailsEveryCommand) {
  if (!HasFullDevice()) GTEST_SKIP() << "no /dev/full";
  const auto full = [](const std::string& ending) {
    std::error_code error;
    std::filesystem::create_symlink("/dev/full", Scratch("full-device." + ending), error);
    return Scratch("full-device." + ending);
  };
  const std::string run[] = {"run", "cube-springs", "--seconds", "0.01", "--export"};
  std::vector<Words> lines = {{"convert", Cube(), full("ply")},
                              {"compare", Cube(), Cube(), "--map", full("vtp")},
                              {"phantom", "--voxel", "10", "--out", full("nii.gz")}};
  for (const char* ending : {"stl", "msh", "csv", "glb"}) {
    lines.emplace_back(std::begin(run), std::end(run)).push_back(full(ending));
  }
  for (const Words& words : lines) {
    const Outcome outcome = Phrenic(words);
    EXPECT_EQ(outcome.code, 1) << testing::PrintToString(words) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("cannot write " + words.back())) << testing::PrintToString(words);
  }
}

// Runs `phrenic` with a pipe as standard output that nothing reads. `ignored`: SIGPIPE is ignored, as Python's
// subprocess and some supervisors leave it.
Outcome PhrenicToClosedPipe(const char* command, bool ignored) {
  int ends[2] = {};
  EXPECT_EQ(pipe(ends), 0);
  close(ends[0]);
  const pid_t pid = fork();
  if (pid == 0) {
    SetUpProcess("/dev/null", Scratch("err"));
    dup2(ends[1], STDOUT_FILENO);
    signal(SIGPIPE, ignored ? SIG_IGN : SIG_DFL);
    const std::string path = std::string(PHRENIC_BINARY_DIR) + "/phrenic";
    execl(path.c_str(), path.c_str(), command, nullptr);
    _exit(127);
  }
  close(ends[1]);
  Outcome outcome;
  outcome.code = WaitFor(pid);
  outcome.err = ReadAll(Scratch("err"));
  return outcome;
}

TEST(ClosedPipe, IsNoError) {
  for (const bool ignored : {true, false}) {
    const Outcome outcome = PhrenicToClosedPipe("man", ignored);
    EXPECT_EQ(outcome.code, ignored ? 0 : 128 + SIGPIPE);
    EXPECT_EQ(outcome.err, "");
  }
}

}  // namespace
}  // namespace phrenic::client
