// Commands that wait for a job reconnect after a restart of the server.
#include <gmock/gmock.h>

#include <algorithm>

#include "client/connection/errors.h"
#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;

// Simulated time [s] that takes seconds to export.
#ifdef PHRENIC_SANITIZED
constexpr char kLongExport[] = "1.5";
#else
constexpr char kLongExport[] = "20";
#endif

TEST(Reconnect, AnExportResumesAfterARestartAndWritesTheSameFile) {
  RunningServer server(Scratch("reconnect_store"));
  const std::vector<std::string> at = {"--server", server.address()};
  const auto with = [&at](std::vector<std::string> words) {
    words.insert(words.end(), at.begin(), at.end());
    return words;
  };
  ASSERT_EQ(Phrenic(with({"create", "sheet-2d", "--id", "class", "--set", "time_step=1e-5"})).code, 0);
  const std::string whole = Scratch("whole.csv"), interrupted = Scratch("interrupted.csv"),
                    said = Scratch("interrupted.err");
  ASSERT_EQ(Phrenic(with({"export", "class", whole, "--seconds", kLongExport, "--fps", "20"})).code, 0);
  const pid_t client = Start("phrenic", with({"export", "class", interrupted, "--seconds", kLongExport, "--fps", "20"}),
                             "/dev/null", said);
  while (Phrenic(with({"exports", "list", "-o", "json"})).json()["exports"].empty()) usleep(20'000);
  usleep(500'000);  // time to receive progress
  server.Kill();
  usleep(300'000);
  const absl::Status back = server.Restart();
  ASSERT_TRUE(back.ok()) << back;
  EXPECT_EQ(WaitFor(client), 0) << ReadAll(said);
  EXPECT_THAT(ReadAll(said), HasSubstr("does not answer; waiting for it"));
  EXPECT_EQ(ReadAll(interrupted), ReadAll(whole));
}

TEST(Reconnect, AWatchResumesAfterARestartAndReportsIt) {
  RunningServer server(Scratch("reconnect_watch"));
  const auto at = [&server](std::vector<std::string> words) {
    words.insert(words.end(), {"--server", server.address()});
    return words;
  };
  ASSERT_EQ(Phrenic(at({"create", "sheet-2d", "--id", "class", "--play"})).code, 0);
  const std::string lines = Scratch("watched.csv"), said = Scratch("watched.err");
  const pid_t client =
      Start("phrenic", at({"watch", "class", "--count", "40", "--fps", "20", "-o", "csv"}), lines, said);
  while (ReadAll(lines).size() < 500) usleep(20'000);
  server.Kill();
  const absl::Status back = server.Restart();
  ASSERT_TRUE(back.ok()) << back;
  // A restarted server pauses its sessions.
  EXPECT_EQ(Phrenic(at({"play", "class"})).code, 0);
  EXPECT_EQ(WaitFor(client), 0) << ReadAll(said);
  EXPECT_THAT(ReadAll(said), testing::MatchesRegex(
                                 "phrenic: the server at .* does not answer; waiting for it\nphrenic: .* is back\n"));
  const std::string csv = ReadAll(lines);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 41) << "a header and forty frames";
}

// A restarted server has no samples of before.
TEST(Reconnect, AWatchOfSamplesReportsTheGapOfARestart) {
  RunningServer server(Scratch("reconnect_samples"));
  const auto at = [&server](std::vector<std::string> words) {
    words.insert(words.end(), {"--server", server.address()});
    return words;
  };
  ASSERT_EQ(Phrenic(at({"create", "sheet-2d", "--id", "class", "--play"})).code, 0);
  const std::string lines = Scratch("sampled.csv"), said = Scratch("sampled.err");
  const pid_t client =
      Start("phrenic", at({"watch", "class", "--every", "0.02", "--count", "100", "-o", "csv"}), lines, said);
  while (ReadAll(lines).empty()) usleep(20'000);
  server.Kill();
  const absl::Status back = server.Restart();
  ASSERT_TRUE(back.ok()) << back;
  EXPECT_EQ(Phrenic(at({"play", "class"})).code, 0);
  EXPECT_EQ(WaitFor(client), 0) << ReadAll(said);
  EXPECT_THAT(ReadAll(said), HasSubstr("is back\nphrenic: samples are missing here"));
  const std::string csv = ReadAll(lines);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 101) << "a header and a hundred samples";
}

TEST(Reconnect, AServerThatAnswersIsNotReportedAsMissing) {
  RunningServer server;
  Context context;
  context.server = server.address();
  testing::internal::CaptureStderr();
  EXPECT_EQ(Fail(context, {grpc::StatusCode::UNAVAILABLE, "no disk"}), kUnreachable);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::AllOf(HasSubstr("is not available now: no disk"), testing::Not(HasSubstr("no server"))));
}

TEST(Reconnect, AServerThatNeverAnsweredIsNotWaitedFor) {
  EXPECT_EQ(Phrenic({"exports", "get", "class", "--server", "127.0.0.1:1"}).code, 3);
}

}  // namespace
}  // namespace phrenic::client
