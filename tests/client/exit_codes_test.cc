// Exit codes follow one rule for every command: 2 if what the user wrote is wrong (the command line, or a file that it
// names), 1 if what was asked for could not be done. Each row has its counterpart: the same command without the fault
// ends with another code.
#include <gmock/gmock.h>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using Words = std::vector<std::string>;

struct Case {
  Words words;
  int code;
};

void ExpectCodes(const std::vector<Case>& cases) {
  for (const Case& one : cases) {
    const Outcome outcome = Phrenic(one.words);
    EXPECT_EQ(outcome.code, one.code) << testing::PrintToString(one.words) << outcome.err;
    EXPECT_EQ(outcome.err.empty(), one.code == 0) << testing::PrintToString(one.words) << outcome.err;
  }
}

Words With(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::string Triangle() {
  return WriteScratch("codes.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
}

TEST(ExitCodes, OfWrongOptionsAreTwo) {
  const std::string surface = Triangle();
  const Words run = {"run", "cube-springs", "--seconds", "0.01"};
  ExpectCodes({{With(run, {"--set", "breath_force=2"}), 0},
               {With(run, {"--set", "breth_force=2"}), 2},
               {With(run, {"--set", "breath_force=1e9"}), 2},
               {With(run, {"--preset", "dep"}), 2},
               {With(run, {"--check", "residual_mm=1"}), 0},
               {With(run, {"--check", "residual=1"}), 2},
               {With(run, {"--export", Scratch("codes.foo")}), 2},
               {With(run, {"--resolution", "-1"}), 2},
               {{"run", "cube-springs", "--seconds", "-1"}, 2},
               {{"compare", surface, surface, "--check", "assd=1"}, 0},
               {{"compare", surface, surface, "--check", "asd=1"}, 2},
               {{"convert", surface, Scratch("codes.stl")}, 0},
               {{"convert", surface, Scratch("codes.foo")}, 2},
               {{"export", "class", Scratch("codes.foo"), "--server", "127.0.0.1:1"}, 2},
               {{"fluoroscopy", "thorax", "--out", Scratch("codes.foo")}, 2},
               {{"lungs", "thorax", "--preset", "dep"}, 2},
               {{"sessions", "--tls-cert", surface}, 2},
               {{"watch", "class", "--measure", "x"}, 2}});
}

TEST(ExitCodes, OfFaultyFilesAreTwoAndOfMissingOnesOne) {
  const Words study = {"study", "error", "cube-springs", "--seconds", "0.1", "--levels", "2"};
  const std::string faulty = WriteScratch("codes-faulty.textproto", "no field: 1"), missing = Scratch("codes-none.obj");
  ExpectCodes({{With(study, {"--check", faulty}), 2},
               {With(study, {"--check", missing}), 1},
               {{"run", faulty}, 2},
               {{"run", missing + ".textproto"}, 1},
               {{"campaign", "report", faulty, "--out", Scratch("codes-campaign")}, 2},
               {{"campaign", "report", missing, "--out", Scratch("codes-campaign")}, 1},
               {{"inspect", WriteScratch("codes-faulty.obj", "f 1 2 3\n")}, 2},
               {{"inspect", missing}, 1},
               {{"compare", missing, missing}, 1},
               {{"convert", missing, Scratch("codes.stl")}, 1}});
}

TEST(ExitCodes, OfWhatCannotBeDoneAreOne) {
  const std::string surface = Triangle();
  ExpectCodes({{{"run", "no-such-scene"}, 1},
               {{"describe", "no-such-scene"}, 1},
               {{"study", "error", "no-such-scene"}, 1},
               {{"convert", surface, Scratch("no-such-folder/codes.stl")}, 1},
               {{"run", "cube-springs", "--seconds", "0.01", "--export", Scratch("no-such-folder/codes.stl")}, 1},
               {{"sessions", "--server", "127.0.0.1:1"}, 3}});
}

TEST(ExitCodes, OfAServersAnswersFollowTheSameRule) {
  RunningServer server;
  ASSERT_NE(server.port(), 0) << server.output();
  const Words at = {"--server", server.address()};
  ASSERT_EQ(Phrenic(With({"create", "cube-springs", "--id", "codes"}, at)).code, 0);
  ExpectCodes({{With({"step", "codes", "0"}, at), 2},
               {With({"step", "none", "1"}, at), 1},
               {With({"set", "codes", "breath_force=1e9"}, at), 2},
               {With({"set", "codes", "breth_force=1"}, at), 2},
               {With({"create", "cube-springs", "--id", "a/b"}, at), 2},
               {With({"create", "cube-springs", "--id", "codes"}, at), 1},
               {With({"create", "no-such-scene"}, at), 1},
               {With({"create", "cube-springs", "--preset", "dep"}, at), 2},
               {With({"export", "codes", Scratch("codes.foo")}, at), 2},
               {With({"export", "codes", Scratch("codes.stl"), "--body", "none"}, at), 2},
               {With({"delete", "none"}, at), 1}});
}

}  // namespace
}  // namespace phrenic::client
