// A command that waits for a job outlives the server's end, as the job does.
#include <gmock/gmock.h>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;

TEST(RideOut, AnExportGoesOnWhenTheServerIsBackAndIsTheSameFile) {
  RunningServer server(Scratch("ride_out_store"));
  const std::vector<std::string> at = {"--server", server.address()};
  const auto with = [&at](std::vector<std::string> words) {
    words.insert(words.end(), at.begin(), at.end());
    return words;
  };
  ASSERT_EQ(Phrenic(with({"create", "sheet-2d", "--id", "class", "--set", "time_step=1e-5"})).code, 0);
  const std::string whole = Scratch("whole.csv"), torn = Scratch("torn.csv"), said = Scratch("torn.err");
  ASSERT_EQ(Phrenic(with({"export", "class", whole, "--seconds", "30", "--fps", "2"})).code, 0);
  const pid_t client =
      Start("phrenic", with({"export", "class", torn, "--seconds", "30", "--fps", "2"}), "/dev/null", said);
  usleep(700'000);
  server.Kill();
  usleep(300'000);
  const absl::Status back = server.Restart();
  ASSERT_TRUE(back.ok()) << back;
  EXPECT_EQ(WaitFor(client), 0) << ReadAll(said);
  EXPECT_THAT(ReadAll(said), HasSubstr("is gone; waiting for it"));
  EXPECT_EQ(ReadAll(torn), ReadAll(whole));
}

TEST(RideOut, AServerThatNeverWasIsNotWaitedFor) {
  EXPECT_EQ(Phrenic({"exports", "get", "class", "--server", "127.0.0.1:1"}).code, 3);
}

}  // namespace
}  // namespace phrenic::client
