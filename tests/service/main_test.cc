// phrenicd as a program: its words and its exit codes.
#include <sys/wait.h>

#include <array>
#include <cstdio>

#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;

struct Outcome {
  int code = -1;
  std::string words;  // of both streams
};

// Runs phrenicd for at most three seconds, then asks it to stop.
Outcome RunPhrenicd(const std::string& arguments) {
  Outcome outcome;
  const std::string command =
      "timeout --preserve-status -k 10 3 " PHRENIC_BINARY_DIR "/phrenicd --store none " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> piece{};
  while (std::fgets(piece.data(), piece.size(), pipe) != nullptr) outcome.words += piece.data();
  outcome.code = WEXITSTATUS(pclose(pipe));
  return outcome;
}

TEST(Phrenicd, SaysWhatItServesAndStopsWhenAsked) {
  const Outcome outcome = RunPhrenicd("--listen 127.0.0.1:0 --web 127.0.0.1:0 --start cube-springs");
  EXPECT_EQ(outcome.code, 0) << outcome.words;
  EXPECT_THAT(outcome.words, HasSubstr("Viewer: http://127.0.0.1:"));
  EXPECT_THAT(outcome.words, HasSubstr("gRPC:   127.0.0.1:"));
  EXPECT_EQ(outcome.words.find("127.0.0.1:0"), std::string::npos) << "the ports that were chosen are not told";
}

TEST(Phrenicd, WrongUsageIsTwo) {
  for (const char* arguments : {"--nonsense", "--max-sessions 0", "--max-viewers many"}) {
    EXPECT_EQ(RunPhrenicd(arguments).code, 2) << arguments;
  }
  EXPECT_EQ(RunPhrenicd("--help").code, 0);
}

TEST(Phrenicd, WhatCannotBeServedIsOneAndSaysWhy) {
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

TEST_F(PhrenicdBesideAnother, APortInUseIsOneAndNamed) {
  const std::string grpc = absl::StrCat("127.0.0.1:", server_->port());
  const Outcome first = RunPhrenicd(absl::StrCat("--start none --web 127.0.0.1:0 --listen ", grpc));
  EXPECT_EQ(first.code, 1);
  EXPECT_THAT(first.words, HasSubstr("cannot listen on " + grpc));
  const std::string web = absl::StrCat("127.0.0.1:", server_->web_port());
  const Outcome second = RunPhrenicd(absl::StrCat("--start none --listen 127.0.0.1:0 --web ", web));
  EXPECT_EQ(second.code, 1);
  EXPECT_THAT(second.words, HasSubstr("cannot listen on " + web));
}

TEST(Phrenicd, WarnsOfAddressesThatOthersCanReach) {
  EXPECT_THAT(RunPhrenicd("--start none --listen 127.0.0.1:0 --web 0.0.0.0:0").words,
              HasSubstr("can be reached from other"));
}

}  // namespace
}  // namespace phrenic::service
