#include "tests/support/server_process.h"

#include <fcntl.h>
#include <grpcpp/create_channel.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"

namespace phrenic {
namespace {

// Returns the text after `word` up to a slash or the end of the line; empty if there is no complete line.
std::string TextAfter(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(word), end = text.find('\n', at);
  if (at == std::string::npos || end == std::string::npos) return "";
  const std::string line = text.substr(at + word.size(), end - at - word.size());
  return line.substr(0, line.find('/'));
}

std::string FirstLine(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

// Runs in the child.
[[noreturn]] void Exec(const std::string& log, std::vector<std::string> words,
                       const std::vector<std::string>& environment) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const std::string& variable : environment) putenv(const_cast<char*>(variable.c_str()));
  const int file = open(log.c_str(), O_CREAT | O_WRONLY, 0600);
  dup2(file, STDOUT_FILENO);
  dup2(file, STDERR_FILENO);
  std::vector<char*> arguments(words.size() + 1, nullptr);
  std::ranges::transform(words, arguments.begin(), [](std::string& word) { return word.data(); });
  const char* other = std::getenv("PHRENIC_SERVER_PROGRAM");  // of benches that compare two builds
  execv(other == nullptr ? PHRENIC_BINARY_DIR "/phrenicd" : other, arguments.data());
  _exit(127);
}

}  // namespace

ServerProcess::ServerProcess(std::string log, std::vector<std::string> flags, std::vector<std::string> environment)
    : log_(std::move(log)), flags_(std::move(flags)), environment_(std::move(environment)) {}

absl::Status ServerProcess::StartOn(const std::string& address, const std::string& web_address) {
  std::vector<std::string> words = {"phrenicd", "--listen", address, "--web", web_address, "--start", "none"};
  words.insert(words.end(), flags_.begin(), flags_.end());
  std::filesystem::remove(log_);
  ended_ = -1;
  address_ = web_address_ = "";
  pid_ = fork();
  if (pid_ < 0) return absl::UnavailableError("fork failed");
  if (pid_ == 0) Exec(log_, words, environment_);
  for (int tries = 0; tries < 12'000 && running(); ++tries) {
    const std::string text = output();
    address_ = TextAfter(text, "gRPC:   ");
    web_address_ = TextAfter(text, "://");
    if (!address_.empty() && !web_address_.empty()) return absl::OkStatus();
    absl::SleepFor(absl::Milliseconds(5));
  }
  return absl::UnavailableError(output());
}

int ServerProcess::Await(double seconds) {
  const absl::Time until = absl::Now() + absl::Seconds(seconds);
  while (ended_ < 0) {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_)
      ended_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (ended_ >= 0 || absl::Now() >= until) break;
    absl::SleepFor(absl::Milliseconds(1));
  }
  return ended_;
}

int ServerProcess::Stop(double seconds) {
  Signal(SIGTERM);
  return Await(seconds);
}

void ServerProcess::Kill() {
  if (!running()) return;
  Signal(SIGKILL);
  Await(60);
}

std::string ServerProcess::output() const {
  std::ifstream in(log_);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::shared_ptr<grpc::Channel> ServerProcess::NewChannel() const {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  arguments.SetMaxReceiveMessageSize(-1);
  arguments.SetMaxSendMessageSize(-1);
  return grpc::CreateCustomChannel(address_, grpc::InsecureChannelCredentials(), arguments);
}

double ServerProcess::Cpu() const {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(pid_, &clock) == 0) clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double ServerProcess::Cpu(const std::string& thread) const {
  double seconds = 0;
  std::error_code error;
  for (const auto& task : std::filesystem::directory_iterator(absl::StrCat("/proc/", pid_, "/task"), error)) {
    if (FirstLine(task.path() / "comm") != thread) continue;
    seconds += 1e-9 * std::strtod(FirstLine(task.path() / "schedstat").c_str(), nullptr);  // run time [ns]
  }
  return seconds;
}

int ServerProcess::PortOf(const std::string& address) {
  int port = 0;
  return absl::SimpleAtoi(address.substr(address.rfind(':') + 1), &port) ? port : 0;
}

std::int64_t ServerProcess::Status(const std::string& name) const {
  std::ifstream in(absl::StrCat("/proc/", pid_, "/status"));
  std::string word;
  while (in >> word && word != name) continue;
  std::int64_t number = 0;
  in >> number;
  return number;
}

std::int64_t ServerProcess::Files() const {
  std::error_code ignored;
  return std::distance(std::filesystem::directory_iterator(absl::StrCat("/proc/", pid_, "/fd"), ignored), {});
}

}  // namespace phrenic
