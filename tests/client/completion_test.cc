// Completion, also in real shells: keys typed into bash and zsh on a terminal, and fish's own query.
#include "client/cli/completion.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "absl/strings/str_cat.h"
#include "tests/client/programs.h"
#include "tests/client/pseudo_terminal.h"

namespace phrenic::client {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(SplitLine, RemovesQuotesAndBackslashes) {
  EXPECT_THAT(SplitLine("phrenic run th"), ElementsAre("phrenic", "run", "th"));
  EXPECT_THAT(SplitLine("phrenic  run "), ElementsAre("phrenic", "run", ""));
  EXPECT_THAT(SplitLine("phrenic inspect 'my lung"), ElementsAre("phrenic", "inspect", "my lung"));
  EXPECT_THAT(SplitLine("phrenic inspect my\\ lung.st"), ElementsAre("phrenic", "inspect", "my lung.st"));
  EXPECT_THAT(SplitLine(""), ElementsAre(""));
}

std::string Completed(const std::string& line) { return Phrenic({"__complete", line}).out; }

TEST(Complete, KnowsWhichArgumentFollows) {
  EXPECT_THAT(Completed("phrenic ru"), HasSubstr("run\tSimulate a scene"));
  EXPECT_THAT(Completed("phrenic study "), HasSubstr("stability\t"));
  EXPECT_EQ(Completed("phrenic run thorax --sec"), "--seconds\tsimulated time [s]\n:nothing\n");
  EXPECT_THAT(Completed("phrenic run thorax --serv"), HasSubstr("--server\t")) << "options of every command";
  EXPECT_EQ(Completed("phrenic scenes --output j"), "json\njsonl\n:nothing\n");
  EXPECT_EQ(Completed("phrenic scenes --output=j"), "--output=json\n--output=jsonl\n:nothing\n");
  EXPECT_EQ(Completed("phrenic scenes -o c"), "csv\n:nothing\n");
  EXPECT_EQ(Completed("phrenic phantom --body t"), "tall\n:nothing\n");
  EXPECT_EQ(Completed("phrenic inspect "), ":files\n");
  EXPECT_EQ(Completed("phrenic run thorax --data "), ":folders\n");
  EXPECT_EQ(Completed("phrenic run thorax --seconds "), ":nothing\n");
  EXPECT_EQ(Completed("phrenic run thorax extra "), ":nothing\n");
}

TEST(Complete, KnowsParametersTheirValuesAndPresets) {
  EXPECT_EQ(Completed("phrenic run thorax --set breath_f"), "breath_force=\t0 to 20\n:nospace\n");
  EXPECT_EQ(Completed("phrenic run thorax --set apply_links="), "apply_links=on\napply_links=off\n:nothing\n");
  EXPECT_THAT(Completed("phrenic run thorax --set integrator=b"), HasSubstr("integrator=bdf2\n"));
  EXPECT_EQ(Completed("phrenic run thorax --physique ag"), "age=\t20 to 90 years\n:nospace\n");
  EXPECT_EQ(Completed("phrenic phantom --physique sex="), "sex=female\nsex=male\n:nothing\n");
  EXPECT_EQ(Completed("phrenic set class breath_force=2 breath_l"), "breath_length=\t0.5 to 30 s\n:nospace\n");
  EXPECT_THAT(Completed("phrenic run thorax --server 127.0.0.1:1 --preset de"), testing::StartsWith("deep\t"));
}

TEST(Scripts, OfBashAreCleanForShellcheck) {
  if (system("shellcheck --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "shellcheck is not installed";
  const std::string script = WriteScratch("completion.bash", Phrenic({"completion", "bash"}).out),
                    said = Scratch("said");
  EXPECT_EQ(system(("shellcheck -s bash " + script + " >" + said).c_str()), 0) << ReadAll(said);
}

// A typed line and the text that the tab key adds.
struct Typed {
  std::string line, added;
};

class Shells : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_NE(server_.port(), 0) << server_.output();
    ASSERT_EQ(Phrenic({"create", "cube-springs", "--id", "lesson-one", "--server", server_.address()}).code, 0);
    const std::string file = WriteScratch("surface_file.stl", "");
    cases_.push_back({"phrenic inspect " + file.substr(0, file.size() - 8), "file.stl"});
  }

  std::map<std::string, std::string> Environment() const {
    return {{"PATH", absl::StrCat(PHRENIC_BINARY_DIR, ":", std::getenv("PATH"))},
            {"PHRENIC_SERVER", server_.address()},
            {"PS1", "ready> "},
            {"TERM", "dumb"}};
  }

  // Ctrl-U clears the line before the next one.
  void ExpectEach(PseudoTerminal& shell) {
    for (const Typed& typed : cases_) {
      shell.Type(typed.line + "\t");
      EXPECT_THAT(shell.ReadUntil(typed.added), HasSubstr(typed.added)) << typed.line;
      shell.Type("\x15");
    }
  }

  RunningServer server_;
  std::vector<Typed> cases_ = {
      {"phrenic phys", "iology"},
      {"phrenic study stab", "ility"},
      {"phrenic run fem-l", "iver-diaphragm"},
      {"phrenic run thorax --reso", "lution"},
      {"phrenic run thorax --preset diaphr", "agmatic"},
      {"phrenic run thorax --set breath_fo", "rce="},
      {"phrenic run thorax --set integrator=velo", "city_verlet"},
      {"phrenic watch less", "on-one"},
  };
};

TEST_F(Shells, BashCompletes) {
  PseudoTerminal bash({"bash", "--norc", "--noprofile", "-i"}, 200, Environment());
  bash.Type("source <(phrenic completion bash); bind 'set bell-style none'; echo lo''aded\n");
  bash.ReadUntil("loaded");
  ExpectEach(bash);
}

TEST_F(Shells, ZshCompletes) {
  if (system("zsh -c true 2>/dev/null") != 0) GTEST_SKIP() << "zsh is not installed";
  PseudoTerminal zsh({"zsh", "-f", "-i"}, 200, Environment());
  zsh.Type("autoload -U compinit; compinit -D -u; source <(phrenic completion zsh); echo lo''aded\n");
  zsh.ReadUntil("loaded");
  ExpectEach(zsh);
}

TEST_F(Shells, FishCompletes) {
  if (system("fish -c true 2>/dev/null") != 0) GTEST_SKIP() << "fish is not installed";
  for (const Typed& typed : cases_) {
    PseudoTerminal fish(
        {"fish", "--no-config", "-c", "phrenic completion fish | source; complete -C '" + typed.line + "'; echo over"},
        200, Environment());
    const std::string word = typed.line.substr(typed.line.rfind(' ') + 1);
    EXPECT_THAT(fish.ReadUntil("over"), HasSubstr(word + typed.added));
  }
}

}  // namespace
}  // namespace phrenic::client
