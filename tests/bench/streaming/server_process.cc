#include "tests/bench/streaming/server_process.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <grpcpp/create_channel.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <vector>

#include "absl/strings/str_cat.h"

namespace phrenic::bench {
namespace {

int FreePort() {
  const int handle = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  bind(handle, reinterpret_cast<sockaddr*>(&address), size);
  getsockname(handle, reinterpret_cast<sockaddr*>(&address), &size);
  close(handle);
  return ntohs(address.sin_port);
}

// Does not return.
void Become(const std::vector<std::string>& words) {
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

std::string FirstLine(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

}  // namespace

absl::StatusOr<std::unique_ptr<ServerProcess>> ServerProcess::Start() {
  const int port = FreePort(), web_port = FreePort();
  const std::vector<std::string> words = {PHRENIC_BINARY_DIR "/phrenicd",
                                          "--listen",
                                          absl::StrCat("127.0.0.1:", port),
                                          "--web",
                                          absl::StrCat("127.0.0.1:", web_port),
                                          "--start",
                                          "none",
                                          "--store",
                                          "none",
                                          "--max-viewers",
                                          "1000"};
  const pid_t pid = fork();
  if (pid < 0) return absl::UnavailableError("no process for the server");
  if (pid == 0) Become(words);
  std::unique_ptr<ServerProcess> server(new ServerProcess(pid, port, web_port));
  const auto channel = grpc::CreateChannel(server->address(), grpc::InsecureChannelCredentials());
  if (channel->WaitForConnected(std::chrono::system_clock::now() + std::chrono::seconds(30))) return server;
  return absl::UnavailableError(absl::StrCat(words[0], " does not answer on port ", port));
}

ServerProcess::~ServerProcess() {
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

std::string ServerProcess::address() const { return absl::StrCat("127.0.0.1:", port_); }

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
    seconds += 1e-9 * std::strtod(FirstLine(task.path() / "schedstat").c_str(), nullptr);  // on the processor [ns]
  }
  return seconds;
}

double ServerProcess::Memory() const {
  const std::string line = FirstLine(absl::StrCat("/proc/", pid_, "/statm"));
  const double pages = std::strtod(line.c_str() + std::min(line.size(), line.find(' ')), nullptr);
  return 1e-6 * pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace phrenic::bench
