// --field prints one value of a command's JSON.
#include "client/print/field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using testing::HasSubstr;

const nlohmann::json& Document() {
  static const auto document = nlohmann::json::parse(
      R"({"session": {"id": "a b", "tick": 7, "live": true},
          "sessions": [{"id": "x", "sizes": [1, 2]}, {"id": "y", "sizes": []}]})");
  return document;
}

std::string Found(const std::string& path) { return FieldOf(Document(), path).value_or("error"); }

TEST(Field, FollowsNamesIndicesAndAllElements) {
  EXPECT_EQ(Found("session.tick"), "7\n");
  EXPECT_EQ(Found("session.id"), "a b\n") << "strings have no quotes";
  EXPECT_EQ(Found("sessions.1.id"), "y\n");
  EXPECT_EQ(Found("sessions.*.id"), "x\ny\n");
  EXPECT_EQ(Found("sessions.*.sizes.*"), "1\n2\n");
  EXPECT_EQ(Found("sessions.0.sizes"), "[1,2]\n");
}

TEST(Field, AStepThatLeadsNowhereIsNamed) {
  const std::pair<std::string, std::string> cases[] = {
      {"session.tik", "session has no member tik; did you mean tick?"},
      {"sesion", "the output has no member sesion; did you mean session?"},
      {"session.tick.more", "session.tick is a single value"},
      {"sessions.2", "sessions is a list of 2"},
      {"sessions.-1", "sessions is a list of 2"},
      {"", "the output has no member"},
      {"session..tick", "session has no member"},
  };
  for (const auto& [path, fault] : cases) {
    EXPECT_THAT(std::string(FieldOf(Document(), path).status().message()), HasSubstr(fault)) << path;
  }
}

TEST(Field, LinesAreReadAsTheyCome) {
  std::ostringstream out;
  const absl::Status good = PrintField(out, "a", true, [&] {
    out << R"({"a": 1})"
        << "\n"
        << R"({"a":)";
    EXPECT_EQ(out.rdbuf()->pubseekoff(0, std::ios::cur), -1) << "nothing is printed on the stream itself";
    out << " 2}\n";
  });
  EXPECT_TRUE(good.ok()) << good;
  EXPECT_EQ(out.str(), "1\n2\n");
}

TEST(Field, OutputThatIsNotJsonIsAnError) {
  std::ostringstream out;
  EXPECT_FALSE(PrintField(out, "a", false, [&] { out << "plain words"; }).ok());
  EXPECT_EQ(out.str(), "");
}

TEST(Field, CommandsPrintIt) {
  const Outcome steps = Phrenic({"run", "cube-springs", "--seconds", "0.01", "--dry-run", "--field", "report.scene"});
  EXPECT_EQ(steps.code, 0) << steps.err;
  EXPECT_EQ(steps.out, "cube-springs\n");
  const Outcome wrong = Phrenic({"run", "cube-springs", "--dry-run", "--field", "report.scen"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean scene?"));
  const Outcome csv = Phrenic({"sessions", "-o", "csv", "--field", "sessions"});
  EXPECT_EQ(csv.code, 2);
  EXPECT_THAT(csv.err, HasSubstr("--field reads JSON"));
}

}  // namespace
}  // namespace phrenic::client
