// phrenicd as a process of its own, on free ports.
#ifndef PHRENIC_TESTS_SERVICE_RUNNING_SERVER_H_
#define PHRENIC_TESTS_SERVICE_RUNNING_SERVER_H_

#include <fcntl.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/time/clock.h"

namespace phrenic::service {

// Not thread-safe. What it says is in FOLDER/said; killed with the object.
class RunningServer {
 public:
  // `flags` beside the addresses and "--start none".
  RunningServer(std::string folder, std::vector<std::string> flags)
      : folder_(std::move(folder)), flags_(std::move(flags)) {
    Start();
  }
  ~RunningServer() { Kill(); }
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;

  // Until it serves.
  void Start() {
    std::filesystem::remove(folder_ + "/said");
    pid_ = fork();
    if (pid_ == 0) Become();
    for (int tries = 0; tries < 1000 && Said().find("Viewer:") == std::string::npos; ++tries) {
      absl::SleepFor(absl::Milliseconds(10));
    }
    ASSERT_NE(Said().find("Viewer:"), std::string::npos) << Said();
  }
  void Kill() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
  // Asks it to stop: its exit code, or -1 where it has not ended within the time.
  int Stop(absl::Duration within) {
    kill(pid_, SIGTERM);
    for (const absl::Time end = absl::Now() + within; absl::Now() < end; absl::SleepFor(absl::Milliseconds(5))) {
      int status = 0;
      if (waitpid(pid_, &status, WNOHANG) != pid_) continue;
      pid_ = -1;
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    return -1;
  }

  std::string Said() const {
    std::ifstream in(folder_ + "/said");
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string address() const { return After("gRPC:   "); }
  int port() const { return PortOf(address()); }
  int web_port() const { return PortOf(After("://")); }
  std::shared_ptr<grpc::Channel> NewChannel() const {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    arguments.SetMaxReceiveMessageSize(-1);
    arguments.SetMaxSendMessageSize(-1);
    return grpc::CreateCustomChannel(address(), grpc::InsecureChannelCredentials(), arguments);
  }
  // The most memory that it has had [bytes].
  std::int64_t PeakMemory() const {
    std::ifstream in("/proc/" + std::to_string(pid_) + "/status");
    std::string word;
    while (in >> word && word != "VmHWM:") continue;
    std::int64_t kilobytes = 0;
    in >> kilobytes;
    return kilobytes << 10;
  }

 private:
  [[noreturn]] void Become() {
    const int file = open((folder_ + "/said").c_str(), O_CREAT | O_WRONLY, 0600);
    dup2(file, 1);
    dup2(file, 2);
    std::vector<std::string> words = {"phrenicd", "--listen", "127.0.0.1:0", "--web", "127.0.0.1:0", "--start", "none"};
    words.insert(words.end(), flags_.begin(), flags_.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(PHRENIC_BINARY_DIR "/phrenicd", arguments.data());
    _exit(127);
  }
  std::string After(const std::string& mark) const {
    const std::string said = Said();
    const std::size_t at = said.find(mark) + mark.size();
    return said.substr(at, said.find_first_of("/\n", at) - at);
  }
  static int PortOf(const std::string& address) {
    int port = 0;
    EXPECT_TRUE(absl::SimpleAtoi(address.substr(address.rfind(':') + 1), &port)) << address;
    return port;
  }

  const std::string folder_;
  const std::vector<std::string> flags_;
  pid_t pid_ = -1;
};

}  // namespace phrenic::service

#endif  // PHRENIC_TESTS_SERVICE_RUNNING_SERVER_H_
