// Help, answers and errors are equal to the files in golden/. After an intended change, renew the files and check the
// difference:
//   PHRENIC_RENEW_GOLDEN=1 build/client_test --gtest_filter='Golden*'
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using Words = std::vector<std::string>;

std::string Transcript(const Words& words, const Outcome& outcome) {
  return "$ phrenic " + absl::StrJoin(words, " ") + "\n" + outcome.out +
         (outcome.err.empty() ? "" : "--- standard error\n" + outcome.err) + "--- exit code " +
         std::to_string(outcome.code) + "\n";
}

void ExpectGolden(const std::string& name, const std::string& text) {
  const std::string path = std::string(PHRENIC_SOURCE_DIR) + "/tests/client/golden/" + name + ".txt";
  if (std::getenv("PHRENIC_RENEW_GOLDEN") != nullptr) {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path) << text;
  }
  EXPECT_EQ(text, ReadAll(path)) << "to renew the file after an intended change, see the top of golden_test.cc";
}

// Returns the subcommands that completion offers after `line`.
Words CommandsBelow(const std::string& line) {
  Words names;
  for (const std::string& row : Words(absl::StrSplit(Phrenic({"__complete", line + " "}).out, '\n'))) {
    if (!row.empty() && row[0] != ':') names.push_back(row.substr(0, row.find('\t')));
  }
  return names;
}

void ExpectGoldenHelp(const Words& command) {
  Words words = command;
  words.emplace_back("--help");
  const Outcome outcome = Phrenic(words);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectGolden("help/" + (command.empty() ? "phrenic" : absl::StrJoin(command, "-")), Transcript(words, outcome));
}

TEST(Golden, HelpOfEveryCommand) {
  ExpectGoldenHelp({});
  const Words commands = CommandsBelow("phrenic");
  EXPECT_THAT(commands, testing::IsSupersetOf({"run", "watch", "doctor"}));
  for (const std::string& command : commands) ExpectGoldenHelp({command});
  for (const std::string command : {"study", "exports", "control"}) {
    for (const std::string& below : CommandsBelow("phrenic " + command)) ExpectGoldenHelp({command, below});
  }
}

TEST(Golden, ErrorsOfTheCommandLine) {
  const std::pair<const char*, Words> cases[] = {
      {"misspelt-command", {"wacth"}},
      {"guessed-command", {"ls"}},
      {"unknown-command", {"xyzzy"}},
      {"misspelt-command-below", {"study", "eror"}},
      {"no-command-below", {"exports"}},
      {"no-scene", {"run"}},
      {"misspelt-option", {"run", "cube-springs", "--secnds", "2"}},
      {"misspelt-scene", {"run", "cube-tensegriti"}},
      {"misspelt-parameter", {"run", "cube-springs", "--set", "breth_force=2"}},
      {"misspelt-choice", {"run", "cube-springs", "--set", "integrator=bdf3"}},
      {"misspelt-preset", {"run", "thorax", "--preset", "dep", "--resolution", "20"}},
      {"misspelt-output", {"scenes", "-o", "jsn"}},
      {"output-of-no-list", {"describe", "thorax", "-o", "csv"}},
      {"one-word-too-many", {"scenes", "thorax"}},
      {"no-number", {"run", "cube-springs", "--seconds", "long"}},
      {"no-whole-number", {"step", "class", "1.5"}},
      {"no-server", {"sessions", "--server", "127.0.0.1:1"}},
  };
  for (const auto& [name, words] : cases) {
    ExpectGolden(std::string("errors/") + name, Transcript(words, Phrenic(words)));
  }
}

TEST(Golden, AnswersOfAServer) {
  RunningServer server;
  ASSERT_NE(server.port(), 0) << server.output();
  const std::pair<const char*, Words> cases[] = {
      {"scenes", {"scenes"}},
      {"create", {"create", "cube-springs", "--id", "class"}},
      {"sessions", {"sessions"}},
      {"sessions-csv", {"sessions", "-o", "csv"}},
      {"set", {"set", "class", "breath_force=2"}},
      {"fork", {"fork", "class", "--id", "mine"}},
      {"watch-csv", {"watch", "class", "--count", "1", "-o", "csv"}},
      {"misspelt-session", {"watch", "clas"}},
      {"no-export", {"exports", "get", "class"}},
      {"delete", {"delete", "class"}},
  };
  for (const auto& [name, words] : cases) {
    Words arguments = words;
    arguments.insert(arguments.end(), {"--server", server.address()});
    Outcome outcome = Phrenic(arguments);
    outcome.out = absl::StrReplaceAll(outcome.out, {{std::to_string(server.web_port()), "WEB"}});
    ExpectGolden(std::string("answers/") + name, Transcript(words, outcome));
  }
}

}  // namespace
}  // namespace phrenic::client
