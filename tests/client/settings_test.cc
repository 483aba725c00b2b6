// The precedence of settings: command line, environment, settings file, default. `phrenic doctor` and `phrenic man`.
#include <gmock/gmock.h>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Sets an environment variable during the object's lifetime.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

std::string SettingsWith(const std::string& text) { return WriteScratch("config.toml", text); }

TEST(Settings, FollowThePrecedence) {
  const Variable file("PHRENIC_CONFIG", SettingsWith("# mine\nserver = \"127.0.0.1:3\"\n"));
  EXPECT_THAT(Phrenic({"sessions"}).err, HasSubstr("no server at 127.0.0.1:3"));
  const Variable variable("PHRENIC_SERVER", "127.0.0.1:2");
  EXPECT_THAT(Phrenic({"sessions"}).err, HasSubstr("no server at 127.0.0.1:2"));
  EXPECT_THAT(Phrenic({"sessions", "--server", "127.0.0.1:1"}).err, HasSubstr("no server at 127.0.0.1:1"));
}

TEST(Settings, ATokenThatGrpcForbidsIsAnErrorThatNamesIt) {
  const Variable token("PHRENIC_TOKEN", "\xe9");
  const Outcome refused = Phrenic({"sessions", "--server", "127.0.0.1:1"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("PHRENIC_TOKEN: the text is not a token"));
}

TEST(Settings, AreShownWithTheirOrigin) {
  const std::string path = SettingsWith("output = \"json\"\n");
  const Variable file("PHRENIC_CONFIG", path);
  const Variable variable("PHRENIC_SERVER", "127.0.0.1:2");
  const auto found = Phrenic({"doctor"}).json()["findings"];
  ASSERT_TRUE(found.is_array());
  EXPECT_EQ(found[0]["found"], "127.0.0.1:2, by PHRENIC_SERVER");
  EXPECT_EQ(found[1]["found"], "json, by " + path);
  const Outcome table = Phrenic({"doctor", "-o", "table", "--server=127.0.0.1:1"});
  EXPECT_THAT(table.out, HasSubstr("127.0.0.1:1, by --server"));
  EXPECT_THAT(table.out, HasSubstr("table, by --output"));
  EXPECT_THAT(table.out, HasSubstr("none, by default"));
}

TEST(Settings, OfOneCommandAreBelowItsName) {
  const Variable file("PHRENIC_CONFIG", SettingsWith("[run]\nseconds = 0.5\n"));
  EXPECT_THAT(Phrenic({"run", "cube-springs"}).out, HasSubstr("0.500 s simulated"));
  EXPECT_THAT(Phrenic({"run", "cube-springs", "--seconds", "0.25"}).out, HasSubstr("0.250 s simulated"));
}

TEST(Settings, ErrorsNameFileAndLine) {
  const struct {
    const char *text, *words;
  } cases[] = {
      {"\nservr = \"x\"\n", "config.toml:2: there is no setting \"servr\"; did you mean server?"},
      {"output = \"xml\"\n", "config.toml:1: --output: there is no \"xml\""},
      {"[runn]\nseconds = 1\n", "config.toml:1: there is no command [runn]"},
      {"[run]\n\nseconds = \"long\"\n", "config.toml:3: "},
      {"[run]\nset = \"breath_force=2\"\n", "config.toml:2: set takes several values"},
  };
  for (const auto& one : cases) {
    const Variable file("PHRENIC_CONFIG", SettingsWith(one.text));
    const Outcome outcome = Phrenic({"scenes"});
    EXPECT_EQ(outcome.code, 2) << one.text;
    EXPECT_THAT(outcome.err, HasSubstr(one.words));
  }
  const Variable gone("PHRENIC_CONFIG", Scratch("nowhere.toml"));
  EXPECT_THAT(Phrenic({"scenes"}).err, HasSubstr("PHRENIC_CONFIG: there is no file"));
}

TEST(Settings, AnUnsupportedOutputIsIgnoredUnlessItIsTyped) {
  const Variable variable("PHRENIC_OUTPUT", "csv");
  EXPECT_EQ(Phrenic({"run", "cube-springs", "--seconds", "0.1"}).code, 0);
  EXPECT_EQ(Phrenic({"run", "cube-springs", "--seconds", "0.1", "-o", "csv"}).code, 2);
  const Variable wrong("PHRENIC_OUTPUT", "xml");
  EXPECT_THAT(Phrenic({"scenes"}).err, HasSubstr("(from PHRENIC_OUTPUT)"));
}

TEST(Doctor, HasARemedyForEachProblem) {
  const Outcome alone = Phrenic({"doctor", "--server", "127.0.0.1:1", "-o", "json"});
  EXPECT_EQ(alone.code, 3);
  const auto answer = alone.json();
  for (const auto& finding : answer["findings"]) {
    EXPECT_NE(finding["verdict"] == "good", !finding["remedy"].get<std::string>().empty()) << finding;
  }
  RunningServer server;
  ASSERT_NE(server.port(), 0) << server.output();
  const Outcome table = Phrenic({"doctor", "--server", server.address()});
  EXPECT_THAT(table.out, HasSubstr("server: answers at " + server.address()));
  EXPECT_THAT(table.out, HasSubstr("versions: both "));
  EXPECT_THAT(table.out, HasSubstr("phrenicd --data DIR"));
  const Outcome other = Phrenic({"doctor", "--server", "127.0.0.1:" + std::to_string(server.web_port())});
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.out, HasSubstr("if it is the viewer's port"));
}

TEST(Manual, RendersWithoutAWarning) {
  const Outcome manual = Phrenic({"man"});
  ASSERT_EQ(manual.code, 0);
  for (const char* words : {".SH NAME", "phrenic exports get", "PHRENIC_SERVER", "breath_force"}) {
    EXPECT_THAT(manual.out, HasSubstr(words));
  }
  if (system("mandoc -h >/dev/null 2>&1; test $? -ne 127") != 0) GTEST_SKIP() << "mandoc is not installed";
  const std::string page = WriteScratch("phrenic.1", manual.out), said = Scratch("lint");
  EXPECT_EQ(system(("mandoc -Tlint -W warning " + page + " >" + said + " 2>&1").c_str()), 0) << ReadAll(said);
}

}  // namespace
}  // namespace phrenic::client
