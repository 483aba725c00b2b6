// phrenicd as a program: its output and its exit codes.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "absl/strings/ascii.h"
#include "absl/strings/str_split.h"
#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;

struct Outcome {
  int code = -1;
  std::string words;  // standard output and standard error
};

// Runs phrenicd and sends SIGTERM once after three seconds.
Outcome RunPhrenicd(const std::string& arguments, const std::string& store = "none") {
  Outcome outcome;
  const std::string command = absl::StrCat("timeout --foreground --preserve-status -k 10 3 ", PHRENIC_BINARY_DIR,
                                           "/phrenicd --store ", store, " ", arguments, " 2>&1");
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> piece{};
  while (std::fgets(piece.data(), piece.size(), pipe) != nullptr) outcome.words += piece.data();
  outcome.code = WEXITSTATUS(pclose(pipe));
  return outcome;
}

TEST(Phrenicd, PrintsItsAddressesAndStopsOnASignal) {
  const Outcome outcome = RunPhrenicd("--listen 127.0.0.1:0 --web 127.0.0.1:0 --start cube-springs");
  EXPECT_EQ(outcome.code, 0) << outcome.words;
  EXPECT_THAT(outcome.words, HasSubstr("Viewer: http://127.0.0.1:"));
  EXPECT_THAT(outcome.words, HasSubstr("gRPC:   127.0.0.1:"));
  EXPECT_EQ(outcome.words.find("127.0.0.1:0"), std::string::npos) << "the actual ports are not printed";
}

// A changed surface stands for a new version of Phrenic that generates other meshes.
TEST(Phrenicd, StartsANewSessionBesideOneThatCannotBeRestored) {
  const std::string folder = testing::TempDir() + "phrenic_anew_" + std::to_string(getpid());
  std::filesystem::create_directories(folder + "/scenes");
  std::ofstream(folder + "/scenes/patch.textproto")
      << "name: 'patch' bodies { name: 'patch' role: ROLE_DEFORMABLE mass: 1 file { path: 'patch.obj' } }";
  const auto run = [&](const std::string& height) {
    std::ofstream(folder + "/patch.obj") << "v 0 0 0\nv 100 0 0\nv 0 " << height << " 0\nf 1 2 3\n";
    const std::string flags = "--listen 127.0.0.1:0 --web 127.0.0.1:0 --start patch --data " + folder;
    return RunPhrenicd(flags, folder + "/store").words;
  };
  EXPECT_THAT(run("100"), HasSubstr("first scene: session patch\n"));
  EXPECT_THAT(run("100"), HasSubstr("first scene: session patch\n"));
  const std::string anew = run("400");
  EXPECT_THAT(anew, HasSubstr("patch could not be restored and stays in the store until it is deleted: "));
  EXPECT_THAT(anew, HasSubstr("first scene: session patch-2\n"));
  EXPECT_THAT(run("400"), HasSubstr("first scene: session patch-2\n"));
  std::filesystem::remove_all(folder);
}

TEST(Phrenicd, ExitsWithTwoOnWrongUsage) {
  for (const char* arguments : {"--nonsense", "--max-sessions 0", "--max-viewers many"}) {
    EXPECT_EQ(RunPhrenicd(arguments).code, 2) << arguments;
  }
  EXPECT_EQ(RunPhrenicd("--help").code, 0);
}

TEST(Phrenicd, ExitsWithOneAndTheReasonIfItCannotServe) {
  const std::string free_ports = "--listen 127.0.0.1:0 --web 127.0.0.1:0 ";
  const Outcome scene = RunPhrenicd(free_ports + "--start thorux");
  EXPECT_EQ(scene.code, 1);
  EXPECT_THAT(scene.words, HasSubstr("there is no scene \"thorux\"; did you mean thorax? There are"));
  const Outcome data = RunPhrenicd(free_ports + "--data /nowhere");
  EXPECT_EQ(data.code, 1);
  EXPECT_THAT(data.words, HasSubstr("--data: there is no folder /nowhere"));
  EXPECT_EQ(RunPhrenicd("--listen here --start none").code, 1);
}

class PhrenicdBesideAnother : public ServerFixture {};

TEST_F(PhrenicdBesideAnother, ExitsWithOneAndNamesAPortInUse) {
  const std::string grpc = absl::StrCat("127.0.0.1:", server_->port());
  const Outcome first = RunPhrenicd(absl::StrCat("--start none --web 127.0.0.1:0 --listen ", grpc));
  EXPECT_EQ(first.code, 1);
  EXPECT_THAT(first.words, HasSubstr("cannot listen on " + grpc));
  const std::string web = absl::StrCat("127.0.0.1:", server_->web_port());
  const Outcome second = RunPhrenicd(absl::StrCat("--start none --listen 127.0.0.1:0 --web ", web));
  EXPECT_EQ(second.code, 1);
  EXPECT_THAT(second.words, HasSubstr("cannot listen on " + web));
}

TEST(Phrenicd, ListensToOtherMachinesWithoutTlsOnlyOnRequest) {
  const std::string reachable = "--start none --listen 127.0.0.1:0 --web 0.0.0.0:0 ";
  const Outcome refused = RunPhrenicd(reachable);
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.words, HasSubstr("--web: 0.0.0.0:0 is reachable from other machines"));
  EXPECT_THAT(refused.words, HasSubstr("--tls-cert"));
  const Outcome told = RunPhrenicd(reachable + "--insecure-listen");
  EXPECT_EQ(told.code, 0);
  EXPECT_THAT(told.words, HasSubstr("can be read and modified on the network"));
  EXPECT_THAT(told.words, HasSubstr("--tokens"));
}

// Writes a settings file for each test.
class PhrenicdConfig : public testing::Test {
 protected:
  PhrenicdConfig() : file_(absl::StrCat(testing::TempDir(), "/phrenicd-", getpid(), ".toml")) {}
  ~PhrenicdConfig() override { unlink(file_.c_str()); }
  Outcome Run(const std::string& text, const std::string& before, const std::string& words) const {
    std::ofstream(file_) << text;
    Outcome outcome;
    const std::string command =
        absl::StrCat(before, " " PHRENIC_BINARY_DIR "/phrenicd ", words, " --config ", file_, " 2>&1");
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> piece{};
    while (std::fgets(piece.data(), piece.size(), pipe) != nullptr) outcome.words += piece.data();
    outcome.code = WEXITSTATUS(pclose(pipe));
    return outcome;
  }
  const std::string file_;
};

TEST_F(PhrenicdConfig, FlagsOverrideTheEnvironmentTheFileAndTheDefault) {
  const std::string text = "max-sessions = 3\nmax-viewers = 4\nmax-exports = 5\n";
  const Outcome said = Run(text, "PHRENICD_MAX_SESSIONS=6 PHRENICD_MAX_VIEWERS=7", "config --max-sessions 8");
  EXPECT_EQ(said.code, 0) << said.words;
  EXPECT_THAT(said.words, testing::ContainsRegex("max-sessions = 8 +# --max-sessions\n"));
  EXPECT_THAT(said.words, testing::ContainsRegex("max-viewers = 7 +# PHRENICD_MAX_VIEWERS\n"));
  EXPECT_THAT(said.words, testing::ContainsRegex("max-exports = 5 +# " + file_ + "\n"));
  EXPECT_THAT(said.words, testing::ContainsRegex("max-uploads-mb = 1024 +# default\n"));
}

TEST_F(PhrenicdConfig, ItsOutputIsAValidSettingsFile) {
  const std::string text = "allow-origin = [\"https://a.example\", \"https://b.example\"]\nlisten = \"127.0.0.1:0\"\n";
  const auto without_origins = [](const std::string& words) {
    std::string values;
    for (absl::string_view line : absl::StrSplit(words, '\n')) {
      absl::StrAppend(&values, absl::StripTrailingAsciiWhitespace(line.substr(0, line.find('#'))), "\n");
    }
    return values;
  };
  const Outcome first = Run(text, "", "config");
  ASSERT_EQ(first.code, 0) << first.words;
  EXPECT_THAT(first.words, HasSubstr("https://a.example,https://b.example"));
  EXPECT_EQ(without_origins(Run(first.words, "", "config").words), without_origins(first.words));
}

TEST_F(PhrenicdConfig, ExitsWithTwoAndTheLineOfABadSetting) {
  const Outcome unknown = Run("\nmax-sesions = 3\n", "", "config");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.words, HasSubstr(":2: there is no setting \"max-sesions\"; did you mean max-sessions?"));
  EXPECT_EQ(Run("max-sessions = 0\n", "", "config").code, 2);
  EXPECT_EQ(Run("", "PHRENICD_MAX_SESSIONS=many", "config").code, 2);
}

TEST_F(PhrenicdConfig, TheShippedFileHasEverySettingWithItsMeaningAndDefault) {
  std::ifstream in(PHRENIC_SOURCE_DIR "/deploy/phrenicd.toml");
  const std::string shipped(std::istreambuf_iterator<char>(in), {});
  const Outcome told = Run("", "env -u STATE_DIRECTORY -u XDG_STATE_HOME HOME=/root", "config --template");
  EXPECT_EQ(told.words, shipped) << "build/phrenicd config --template > deploy/phrenicd.toml";
}

TEST(PhrenicdToken, IsShownOnceAndRemoved) {
  const std::string file = absl::StrCat(testing::TempDir(), "/phrenicd-accounts-", getpid());
  const std::string words = " --tokens " + file;
  unlink(file.c_str());
  EXPECT_EQ(RunPhrenicd("token add --name anna --role viewer" + words).code, 0);
  const Outcome listed = RunPhrenicd("token list" + words);
  EXPECT_THAT(listed.words, testing::ContainsRegex("viewer +anna"));
  EXPECT_EQ(RunPhrenicd("token add --name anna" + words).code, 1);
  EXPECT_EQ(RunPhrenicd("token remove --name anna" + words).code, 0);
  EXPECT_EQ(RunPhrenicd("token list" + words).words, "");
  EXPECT_EQ(RunPhrenicd("token add --name anna --role king" + words).code, 2);
  unlink(file.c_str());
}

TEST(Phrenicd, WritesItsLogAsJson) {
  const Outcome outcome =
      RunPhrenicd("--log json --listen 127.0.0.1:0 --web 127.0.0.1:0 --start cube-springs --web-root /");
  std::istringstream lines(outcome.words);
  int read = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("{")) continue;
    const auto entry = nlohmann::json::parse(line);
    EXPECT_EQ(entry["level"], "info");
    EXPECT_FALSE(entry["message"].get<std::string>().empty());
    ++read;
  }
  EXPECT_GE(read, 2) << outcome.words;
}

}  // namespace
}  // namespace phrenic::service
