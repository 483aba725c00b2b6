// Runs the built programs as a user does: `phrenic` to its end, `phrenicd` during a test.
#ifndef PHRENIC_TESTS_CLIENT_PROGRAMS_H_
#define PHRENIC_TESTS_CLIENT_PROGRAMS_H_

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/server_process.h"

namespace phrenic::client {

// The result of a program.
struct Outcome {
  int code = -1;  // exit code
  std::string out, err;
  // Returns standard output as JSON; discarded() if it is not JSON.
  nlohmann::json json() const { return nlohmann::json::parse(out, nullptr, false); }
};

inline std::string ReadAll(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// A temporary folder of this process. The destructor removes it.
struct ScratchFolder {
  ScratchFolder() { std::filesystem::create_directories(path); }
  ~ScratchFolder() {
    std::error_code gone;
    std::filesystem::remove_all(path, gone);
  }
  const std::string path = testing::TempDir() + "phrenic_client_" + std::to_string(getpid());
};

// Returns a path in the temporary folder.
inline std::string Scratch(const std::string& name) {
  static const ScratchFolder folder;
  return folder.path + "/" + name;
}

// Writes a file in the temporary folder. Returns its path.
inline std::string WriteScratch(const std::string& name, const std::string& text) {
  std::ofstream(Scratch(name)) << text;
  return Scratch(name);
}

// The user whose commands run. Each user has their own control tokens, in the temporary folder.
inline std::string& User() {
  static std::string user = "anna";
  return user;
}

// In a new process: sends its output to the files, and ends it with the test at the latest.
inline void SetUpProcess(const std::string& out, const std::string& err) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setenv("XDG_CONFIG_HOME", Scratch("config").c_str(), 1);  // independent of the tester's settings
  setenv("XDG_STATE_HOME", Scratch(User()).c_str(), 1);
  dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
  dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
}

// Starts a program of the build with standard output and error in files. The program ends with the test at the latest.
// Returns its process id.
inline pid_t Start(const std::string& program, const std::vector<std::string>& arguments, const std::string& out,
                   const std::string& err) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  SetUpProcess(out, err);
  const std::string path = std::string(PHRENIC_BINARY_DIR) + "/" + program;
  std::vector<char*> argv = {const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(path.c_str(), argv.data());
  _exit(127);
}

// Waits for a process. Returns its exit code, 128 + signal, or -1.
inline int WaitFor(pid_t pid) {
  int status = 0;
  if (waitpid(pid, &status, 0) != pid) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Runs `phrenic` to its end.
inline Outcome Phrenic(const std::vector<std::string>& arguments) {
  const std::string out = Scratch("out"), err = Scratch("err");
  Outcome outcome;
  outcome.code = WaitFor(Start("phrenic", arguments, out, err));
  outcome.out = ReadAll(out);
  outcome.err = ReadAll(err);
  return outcome;
}

// phrenicd on free ports, without sessions. The destructor stops it.
class RunningServer : public ServerProcess {
 public:
  // `store`: the folder of saved sessions, or "none".
  explicit RunningServer(const std::string& store = "none")
      : ServerProcess(Scratch("server"), {"--web-root", std::string(PHRENIC_SOURCE_DIR) + "/web", "--store", store},
                      {"XDG_CONFIG_HOME=" + Scratch("config"), "XDG_STATE_HOME=" + Scratch(User())}) {
    const absl::Status status = Start();
    EXPECT_TRUE(status.ok()) << status;
  }
};

}  // namespace phrenic::client

#endif  // PHRENIC_TESTS_CLIENT_PROGRAMS_H_
