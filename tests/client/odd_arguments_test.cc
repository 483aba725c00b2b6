// No command ends by a signal or by an assertion, whatever its arguments are: each command of the table with each kind
// of odd value. A new command joins by its row in the table.
#include <gtest/gtest.h>
#include <sanitizer/lsan_interface.h>
#include <sys/resource.h>

#include <cstdio>
#include <deque>
#include <filesystem>
#include <iostream>
#include <iterator>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/command_line.h"
#include "client/commands/commands.h"
#include "tests/client/programs.h"

#pragma weak __lsan_do_leak_check  // null without sanitizers

namespace phrenic::client {
namespace {

using Words = std::vector<std::string>;

constexpr int kAtATime = 4, kMostSeconds = 3;  // processes; each, of CPU time

// Returns a path of a new file with these bytes, whose ending is that of a format.
std::string OddFile(const std::string& name, const std::string& bytes) { return WriteScratch("odd-" + name, bytes); }

std::string Garbage() {
  std::string bytes;
  for (unsigned i = 0, x = 1; i < 3000; ++i, x = x * 1103515245 + 12345) bytes.push_back(static_cast<char>(x >> 16));
  return bytes;
}

// Values for any argument. Paths have the endings of the formats that the commands read.
const Words& OddValues() {
  static const Words& values = *new Words([] {
    Words all = {"",          Scratch("odd-none"),
                 Scratch(""), "/dev/null",
                 "-1",        "0",
                 "nan",       "-inf",
                 "1e308",     "99999999999999999999",
                 "a:b:c",     "=",
                 "\xff\xfe",  "\t",
                 "%s%n",      std::string(5000, 'x'),
                 "session:/", "../.."};
    for (const char* ending : {"msh", "obj", "ply", "stl", "vtk", "vtp", "nii", "nii.gz", "textproto", "json"}) {
      all.push_back(OddFile(absl::StrCat("empty.", ending), ""));
      all.push_back(OddFile(absl::StrCat("garbage.", ending), Garbage()));
    }
    all.push_back(OddFile("numbers.json", R"({"session": 1, "state_hash": "x", "report": {"scene_hash": 7}})"));
    all.push_back(
        OddFile("types.json", R"({"session": {"tick": -1}, "state_hash": "x", "report": {"scene_hash": 7}})"));
    all.push_back(OddFile("nothing.textproto", "name: 'x' scenes: 'cube-springs' seconds: 1"));
    return all;
  }());
  return values;
}

struct Argument {
  std::string name;  // "--seconds"; empty: a position
  Kind kind;
  bool required;
};

struct Subject {
  Words path;
  std::vector<Argument> arguments;
};

void Collect(const CLI::App& app, std::vector<Subject>& subjects) {
  const auto below = app.get_subcommands({});
  for (const CLI::App* command : below) Collect(*command, subjects);
  if (!below.empty() || app.get_parent() == nullptr) return;
  Subject& subject = subjects.emplace_back();
  subject.path = absl::StrSplit(PathOf(app), ' ');
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() == 0) continue;  // a flag
    const bool positional = option->get_positional();
    subject.arguments.push_back({positional ? "" : NameOf(*option), KindOf(app, *option).kind, option->get_required()});
  }
}

std::vector<Subject> Subjects() {
  CLI::App root("", "phrenic");
  CommandFunction chosen;
  AddCommands(Commands(), root, chosen);
  ApplyKinds(root);
  std::vector<Subject> subjects;
  Collect(root, subjects);
  return subjects;
}

// Returns a value that the command accepts and that makes little work.
std::string PlainValue(Kind kind) {
  if (kind == Kind::kScene) return "no-such-scene";
  if (kind == Kind::kFile) return Scratch("odd-empty.msh");
  if (kind == Kind::kFolder) return Scratch("odd-folder");
  return kind == Kind::kSetting ? "breath_force=1" : "class";
}

// Returns the command with `odd` as the argument at `position`, or as each required one if it is -1.
Words Line(const Subject& subject, int position, const std::string& odd) {
  Words words = subject.path, last;
  for (int i = 0; i < static_cast<int>(subject.arguments.size()); ++i) {
    const Argument& argument = subject.arguments[i];
    if (i != position && !argument.required) continue;
    // A value that begins with "-" must not be taken for an option.
    const std::string value = i == position || position < 0 ? odd : PlainValue(argument.kind);
    if (argument.name.empty()) {
      last.push_back(value);
    } else {
      words.push_back(absl::StrCat(argument.name, "=", value));
    }
  }
  words.insert(words.end(), {"--server", "127.0.0.1:1", "--"});
  words.insert(words.end(), last.begin(), last.end());
  return words;
}

// Runs the command line in a copy of this process, which ends as the program would: under ASan the start of the program
// itself takes longer than most commands. Requires: this process has one thread.
pid_t StartCopy(const Words& words, const std::string& err) {
  std::fflush(nullptr);
  const pid_t pid = fork();
  if (pid != 0) return pid;
  SetUpProcess("/dev/null", err);
  Interruption interruption;
  const int code = RunCommandLine(words, Commands(), interruption);
  std::cout.flush();
  std::cerr.flush();
  std::fflush(nullptr);
  if (&__lsan_do_leak_check != nullptr) __lsan_do_leak_check();
  _exit(code);  // without the destructors of the test
}

bool HasOneThread() { return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {}) == 1; }

// Runs the lines, some at a time, in a folder of their own, since values are names of files that commands write.
// Expects an ordinary end of each.
class Runner {
 public:
  Runner() : before_(std::filesystem::current_path()) {
    std::filesystem::create_directories(Scratch("odd-work"));
    std::filesystem::current_path(Scratch("odd-work"));
  }
  ~Runner() {
    while (!running_.empty()) Collect();
    std::filesystem::current_path(before_);
  }
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;
  void Run(const Words& words) {
    if (running_.size() >= kAtATime) Collect();
    const std::string file = Scratch(absl::StrCat("odd-err-", ++started_ % (2 * kAtATime)));
    const pid_t pid = HasOneThread() ? StartCopy(words, file) : Start("phrenic", words, "/dev/null", file);
    const rlimit limit = {kMostSeconds, kMostSeconds};
    prlimit(pid, RLIMIT_CPU, &limit, nullptr);
    running_.push_back({pid, words, file});
  }

 private:
  struct Running {
    pid_t pid;
    Words words;
    std::string err;
  };
  void Collect() {
    const Running ended = running_.front();
    running_.pop_front();
    const int code = WaitFor(ended.pid);
    const std::string err = ReadAll(ended.err);
    const std::string line = absl::StrJoin(ended.words, " ").substr(0, 300);
    const bool only_long = code == 128 + SIGKILL || code == 128 + SIGXCPU;  // ended by the limit above
    EXPECT_TRUE(code <= 130 || only_long) << "phrenic " << line << "\nends with " << code << "\n" << err;
    for (const char* word : {"Sanitizer", "terminate called", "what():", "assertion failed", "API misuse"}) {
      EXPECT_FALSE(absl::StrContains(err, word)) << "phrenic " << line << "\n" << err;
    }
    if (code != 0 && !only_long && ended.words[0] != "doctor") {  // which reports faults on standard output
      EXPECT_FALSE(err.empty()) << "phrenic " << line << "\nfails without a word";
    }
  }
  const std::filesystem::path before_;
  int started_ = 0;
  std::deque<Running> running_;
};

// The values take turns, as each with every command would take too long.
TEST(OddArguments, AsAllThatACommandRequiresEndItWithAnError) {
  constexpr int kValuesACommand = 4;
  Runner runner;
  std::size_t next = 0;
  for (const Subject& subject : Subjects()) {
    runner.Run(subject.path);
    // phantom writes a large file for every value that it accepts.
    const int values = subject.path[0] == "phantom" ? 1 : kValuesACommand;
    for (int k = 0; k < values; ++k) runner.Run(Line(subject, -1, OddValues()[next++ % OddValues().size()]));
  }
}

// Every option in turn.
TEST(OddArguments, AsOneOptionEndTheCommandOrAreAccepted) {
  constexpr int kValuesAnOption = 2;
  Runner runner;
  std::size_t next = 0;
  for (const Subject& subject : Subjects()) {
    if (subject.path[0] == "phantom") continue;
    for (int i = 0; i < static_cast<int>(subject.arguments.size()); ++i) {
      for (int k = 0; k < kValuesAnOption; ++k) runner.Run(Line(subject, i, OddValues()[next++ % OddValues().size()]));
    }
  }
}

// Files that are right, and folders that hold nothing or something else.
TEST(OddArguments, ACampaignWithoutResultsHasAnEmptyReport) {
  const std::string file = WriteScratch("odd-sweep.textproto", "name: 'n' scenes: 'cube-springs' seconds: 0.1");
  for (const char* format : {"table", "csv", "json", "jsonl"}) {
    const Outcome outcome = Phrenic({"campaign", "report", file, "--out", Scratch("odd-campaign"), "--page",
                                     Scratch("odd-page.html"), "-o", format});
    EXPECT_EQ(outcome.code, 1) << format << outcome.err;
    EXPECT_TRUE(absl::StrContains(outcome.err, "0 of 1 runs finished")) << outcome.err;
  }
  const std::string cell = Scratch("odd-campaign/cells");
  ASSERT_EQ(Phrenic({"campaign", "run", file, "--out", Scratch("odd-campaign"), "--jobs", "1"}).code, 0);
  for (const auto& result : std::filesystem::directory_iterator(cell)) {
    for (const char* text : {"", "{", "[]", "{\"rows\":[{\"settings\":\"without equals\"}]}", "\xff"}) {
      std::ofstream(result.path()) << text;
      EXPECT_LE(Phrenic({"campaign", "report", file, "--out", Scratch("odd-campaign")}).code, 4) << text;
    }
  }
}

TEST(OddArguments, OfAVastCampaignAreCountedBeforeTheyAreMade) {
  std::string text = "name: 'n' scenes: 'cube-springs' seconds: 1 ";
  for (int axis = 0; axis < 6; ++axis) {
    absl::StrAppend(&text, "axes { parameter: 'breath_force' ");
    for (int i = 0; i < 1000; ++i) absl::StrAppend(&text, "values: '", i, "' ");
    absl::StrAppend(&text, "} ");
  }
  const Outcome outcome =
      Phrenic({"campaign", "report", WriteScratch("odd-vast.textproto", text), "--out", Scratch("odd-vast")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(absl::StrContains(outcome.err, "more than a million runs")) << outcome.err;
}

TEST(OddArguments, InTheEnvironmentAndTheSettingsFileAreErrors) {
  const std::string token = WriteScratch("odd-token", "caf\xc3\xa9");
  const Outcome outcome = Phrenic({"sessions", "--server", "127.0.0.1:1", "--token-file", token});
  EXPECT_NE(outcome.code, 3) << "the token must be refused before a connection is tried";
  EXPECT_TRUE(absl::StrContains(outcome.err, "--token-file")) << outcome.err;
  EXPECT_LE(Phrenic({"sessions", "--server", "127.0.0.1:1", "--token-file", Scratch("")}).code, 4);
}

}  // namespace
}  // namespace phrenic::client
