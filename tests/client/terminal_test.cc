// Output on a terminal and into a pipe.
#include <gmock/gmock.h>

#include "tests/client/programs.h"
#include "tests/client/pseudo_terminal.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kProgram = std::string(PHRENIC_BINARY_DIR) + "/phrenic";
constexpr char kEscape[] = "\x1b[";

std::string Seen(std::vector<std::string> words, unsigned short columns,
                 const std::map<std::string, std::string>& environment = {}) {
  words.insert(words.begin(), kProgram);
  return PseudoTerminal(words, columns, environment).ReadAll();
}

TEST(Colours, AreForTerminalsWithColours) {
  EXPECT_THAT(Seen({"--help"}, 100), HasSubstr(kEscape));
  EXPECT_THAT(Seen({"--help"}, 100, {{"NO_COLOR", "1"}}), Not(HasSubstr(kEscape)));
  EXPECT_THAT(Seen({"--help"}, 100, {{"TERM", "dumb"}}), Not(HasSubstr(kEscape)));
  EXPECT_THAT(Seen({"--no-color", "wacth"}, 100), Not(HasSubstr(kEscape)));
  EXPECT_THAT(Phrenic({"--help"}).out, Not(HasSubstr(kEscape)));
  EXPECT_THAT(Phrenic({"wacth"}).err, Not(HasSubstr(kEscape)));
}

TEST(Help, FitsTheTerminal) {
  for (const unsigned short columns : {40, 80}) {
    std::istringstream lines(Seen({"run", "--help"}, columns, {{"NO_COLOR", "1"}}));
    for (std::string line; std::getline(lines, line);) {
      const bool example = line.find("  phrenic ") == 0;  // examples are not wrapped, so that they can be copied
      EXPECT_TRUE(example || line.size() <= columns + 1U) << line;
    }
  }
}

TEST(Progress, ShowsTheRemainingTimeOnATerminal) {
  PseudoTerminal terminal({kProgram, "run", "hanging-sheet", "--seconds", "1800"}, 60);
  EXPECT_THAT(terminal.ReadUntil("s left"), HasSubstr("stepping ["));
}

TEST(Watch, DrawsLiveBarsInATerminal) {
  RunningServer server;
  ASSERT_NE(server.port(), 0) << server.output();
  ASSERT_EQ(Phrenic({"create", "cube-springs", "--id", "seen", "--play", "--server", server.address()}).code, 0);
  const std::vector<std::string> words = {"watch", "seen", "--count", "5", "--fps", "20", "--server", server.address()};
  const std::string drawn = Seen(words, 60, {{"LC_ALL", "C.UTF-8"}});
  EXPECT_THAT(drawn, HasSubstr("breath"));
  EXPECT_THAT(drawn, HasSubstr("A\r")) << "the cursor moves up";
  EXPECT_THAT(drawn, testing::AnyOf(HasSubstr("▁"), HasSubstr("█")));
  EXPECT_THAT(Seen(words, 60, {{"LC_ALL", "C"}}), Not(HasSubstr("▁")));
  EXPECT_THAT(Seen(words, 60, {{"TERM", "dumb"}}), Not(HasSubstr(kEscape)));
}

}  // namespace
}  // namespace phrenic::client
