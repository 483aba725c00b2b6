#include "tests/cluster/trial/deployment.h"

#include <fcntl.h>
#include <grpcpp/create_channel.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/time/clock.h"
#include "tests/support/free_ports.h"

namespace phrenic::cluster {
namespace {

// Returns a file's text; empty if it cannot be read, as files in /proc disappear with their process.
std::string TextOf(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return std::move(text).str();
}

[[noreturn]] void Exec(const std::vector<std::string>& words, const std::string& log) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // ends with this process, also after a crash
  const int file = open(log.c_str(), O_CREAT | O_APPEND | O_WRONLY, 0600);
  dup2(file, 1);
  dup2(file, 2);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

bool Runs(pid_t pid) {
  const std::string state = TextOf(absl::StrCat("/proc/", pid, "/stat"));
  return kill(pid, 0) == 0 && !state.empty() && !absl::StrContains(state, ") Z ");
}

// Returns the standard output of a command.
std::string OutputOf(const std::string& command) {
  std::string text;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  char block[4096];
  for (std::size_t got = 0; (got = fread(block, 1, sizeof block, pipe)) > 0;) text.append(block, got);
  pclose(pipe);
  return text;
}

}  // namespace

bool HasTools() {
  for (const char* tool : {"nginx", "redis-server", "openssl"}) {
    if (std::system(absl::StrCat("PATH=$PATH:/usr/sbin command -v ", tool, " > /dev/null").c_str()) == 0) continue;
    std::printf("skipped: %s is not installed (deploy/packages.txt)\n", tool);
    return false;
  }
  return true;
}

std::string Deployment::Output() const { return TextOf(folder_ + "/said"); }

absl::Status Deployment::Start(int servers, const std::vector<std::string>& flags) {
  std::string name = std::filesystem::temp_directory_path() / "phrenic-cluster-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) return absl::UnavailableError("the temporary folder could not be created");
  folder_ = name;
  std::filesystem::permissions(folder_, static_cast<std::filesystem::perms>(0755));
  base_ = FreePorts(2 * servers + 2);
  port_ = base_ + 2 * servers + 1;
  script_ = fork();
  if (script_ == 0) {
    std::vector<std::string> words = {PHRENIC_SOURCE_DIR "/deploy/cluster",
                                      std::to_string(servers),
                                      "--no-build",
                                      "--dir",
                                      folder_,
                                      "--base",
                                      std::to_string(base_),
                                      "--port",
                                      std::to_string(port_),
                                      "--start",
                                      "none"};
    words.insert(words.end(), flags.begin(), flags.end());
    Exec(words, folder_ + "/said");
  }
  for (int tries = 0; tries < 600 && !absl::StrContains(Output(), "Ctrl-C"); ++tries) {
    absl::SleepFor(absl::Milliseconds(100));
    if (!Runs(script_)) break;
  }
  if (!absl::StrContains(Output(), "Ctrl-C")) return absl::UnavailableError(Output());
  trust_ = TextOf(folder_ + "/phrenic/cert.pem");
  std::vector<std::string> names = {"redis"};
  for (int i = 1; i <= servers; ++i) names.push_back(absl::StrCat("server-", i));
  for (const std::string& each : names) {
    const pid_t pid = std::atoi(TextOf(absl::StrCat(folder_, "/", each, ".pid")).c_str());
    std::vector<std::string> words =
        absl::StrSplit(TextOf(absl::StrCat("/proc/", pid, "/cmdline")), '\0', absl::SkipEmpty());
    // Redis replaces its command line with its name and address.
    if (each == "redis") {
      words = {"redis-server", "--bind", "127.0.0.1", "--port", std::to_string(base_), "--dir", folder_,
               "--appendonly", "yes",    "--save",    ""};
    }
    programs_.push_back({each, pid, std::move(words)});
  }
  return absl::OkStatus();
}

Deployment::~Deployment() {
  for (const Program& program : programs_) {
    if (program.ours && program.pid > 0) {
      kill(program.pid, SIGKILL);
      waitpid(program.pid, nullptr, 0);
    }
  }
  if (script_ > 0) {
    kill(script_, SIGTERM);
    waitpid(script_, nullptr, 0);
  }
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

std::shared_ptr<grpc::Channel> Deployment::NewChannel() const {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetMaxReceiveMessageSize(-1);
  return grpc::CreateCustomChannel(
      absl::StrCat("localhost:", port_),
      grpc::SslCredentials({.pem_root_certs = trust_, .pem_private_key = "", .pem_cert_chain = ""}), arguments);
}

std::shared_ptr<grpc::Channel> Deployment::NewChannelTo(int server) const {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  arguments.SetMaxReceiveMessageSize(-1);
  return grpc::CreateCustomChannel(absl::StrCat("127.0.0.1:", base_ + 2 * server - 1),
                                   grpc::InsecureChannelCredentials(), arguments);
}

double Deployment::Metric(int server, const std::string& name) const {
  const std::string all = OutputOf(absl::StrCat("curl -sf http://127.0.0.1:", base_ + 2 * server, "/metrics"));
  for (const absl::string_view line : absl::StrSplit(all, '\n')) {
    if (absl::StartsWith(line, absl::StrCat(name, " ")))
      return std::atof(std::string(line.substr(name.size())).c_str());
  }
  return 0;
}

double Deployment::Cpu(const std::string& name) const {
  const std::string pid = std::to_string(std::atoi(TextOf(absl::StrCat(folder_, "/", name, ".pid")).c_str()));
  double ticks = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    if (std::atoi(entry.path().filename().c_str()) == 0) continue;  // not a process
    const std::string stat = TextOf(entry.path() / "stat");
    const std::vector<std::string> words =
        absl::StrSplit(stat.substr(std::min(stat.size(), stat.rfind(')') + 1)), ' ', absl::SkipEmpty());
    constexpr std::size_t kParent = 1, kUser = 11, kSystem = 12;  // after the name (proc(5))
    if (words.size() <= kSystem || (entry.path().filename() != pid && words[kParent] != pid)) continue;
    ticks += std::atof(words[kUser].c_str()) + std::atof(words[kSystem].c_str());
  }
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

Deployment::Program& Deployment::Find(const std::string& name) {
  for (Program& program : programs_) {
    if (program.name == name) return program;
  }
  return programs_.front();
}

void Deployment::Signal(const std::string& name, int signal) { kill(Find(name).pid, signal); }

void Deployment::End(const std::string& name, int signal) {
  Program& program = Find(name);
  kill(program.pid, signal);
  if (program.ours) waitpid(program.pid, nullptr, 0);
  while (!program.ours && Runs(program.pid)) absl::SleepFor(absl::Milliseconds(2));
  program.pid = -1;
}

void Deployment::StartAgain(const std::string& name) {
  Program& program = Find(name);
  program.ours = true;
  program.pid = fork();
  if (program.pid == 0) Exec(program.words, absl::StrCat(folder_, "/", name, ".log"));
}

}  // namespace phrenic::cluster
