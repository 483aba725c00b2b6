#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "absl/time/clock.h"
#include "client/campaign/worker.h"
#include "client/cli/shell_word.h"

namespace phrenic::client {
namespace {

constexpr absl::Duration kPollPeriod = absl::Milliseconds(100);
constexpr absl::Duration kSlurmPeriod = absl::Seconds(2);

std::string ThisProgram() {
  std::array<char, 4096> path{};
  const ssize_t length = readlink("/proc/self/exe", path.data(), path.size());
  return length > 0 ? std::string(path.data(), static_cast<size_t>(length)) : "phrenic";
}

std::string ShareText(int number, int shares) { return absl::StrCat(number, "/", shares); }

absl::StatusOr<pid_t> Spawn(const Workers& workers, const std::string& share) {
  std::vector<std::string> words = {ThisProgram()};
  words.insert(words.end(), workers.arguments.begin(), workers.arguments.end());
  words.insert(words.end(), {"--share", share});
  std::vector<char*> argv(words.size() + 1, nullptr);
  std::ranges::transform(words, argv.begin(), [](std::string& word) { return word.data(); });
  pid_t pid = 0;
  const int error = posix_spawn(&pid, words[0].c_str(), nullptr, nullptr, argv.data(), environ);
  if (error != 0) return absl::InternalError(absl::StrCat("cannot start ", words[0], ": error ", error));
  return pid;
}

// The processes of a campaign on this machine. The destructor ends those that still run.
class ProcessPool {
 public:
  ProcessPool(const Workers& workers, int shares) : workers_(workers), shares_(shares) {}
  ~ProcessPool() {
    for (const pid_t pid : running_) kill(pid, SIGTERM);
    for (const pid_t pid : running_) waitpid(pid, nullptr, 0);
  }
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;

  bool busy() const { return next_ < shares_ || !running_.empty(); }
  // Starts processes up to the limit and collects those that have ended. INTERNAL if one failed.
  absl::Status Poll() {
    while (next_ < shares_ && static_cast<int>(running_.size()) < workers_.concurrent) {
      const auto pid = Spawn(workers_, ShareText(next_, shares_));
      if (!pid.ok()) return pid.status();
      running_.insert(*pid);
      ++next_;
    }
    const std::set<pid_t> before = running_;
    for (const pid_t pid : before) {
      int status = 0;
      if (waitpid(pid, &status, WNOHANG) != pid) continue;
      running_.erase(pid);
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;
      return absl::InternalError(
          "a process ended before its runs were finished: finished runs are kept; start the campaign again to "
          "continue");
    }
    return absl::OkStatus();
  }

 private:
  const Workers& workers_;
  const int shares_;
  int next_ = 0;
  std::set<pid_t> running_;
};

// Returns the output of a shell command. INTERNAL with its output if it fails.
absl::StatusOr<std::string> RunShell(const std::string& command) {
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return absl::InternalError(absl::StrCat("cannot run ", command));
  std::string output;
  std::array<char, 512> part{};
  while (fgets(part.data(), part.size(), pipe) != nullptr) output += part.data();
  const int status = pclose(pipe);
  const std::string text(absl::StripAsciiWhitespace(output));
  if (status == 0) return text;
  return absl::InternalError(absl::StrCat(command.substr(0, command.find(' ')), ": ", text));
}

std::string SlurmCommand(const Workers& workers, int shares, const std::string& log_folder) {
  std::string work = ShellWord(ThisProgram());
  for (const std::string& argument : workers.arguments) absl::StrAppend(&work, " ", ShellWord(argument));
  absl::StrAppend(&work, " --share $SLURM_ARRAY_TASK_ID/", shares);
  return absl::StrCat("sbatch --parsable --job-name=phrenic --array=0-", shares - 1, "%", workers.concurrent,
                      " --output=", ShellWord(log_folder + "/slurm-%A-%a.log"), " --wrap ", ShellWord(work));
}

}  // namespace

absl::Status RunHere(const Workers& workers, int shares, const std::function<bool()>& wait) {
  ProcessPool pool(workers, shares);
  while (pool.busy()) {
    if (absl::Status status = pool.Poll(); !status.ok()) return status;
    if (!wait()) return absl::CancelledError("interrupted");
    absl::SleepFor(kPollPeriod);
  }
  return absl::OkStatus();
}

absl::Status RunOnSlurm(const Workers& workers, int shares, const std::string& log_folder,
                        const std::function<bool()>& wait) {
  const auto job = RunShell(SlurmCommand(workers, shares, log_folder));
  if (!job.ok()) return job.status();
  absl::Time polled = absl::Now();
  for (bool queued = true; queued;) {
    if (!wait()) {
      RunShell(absl::StrCat("scancel ", *job)).status().IgnoreError();
      return absl::CancelledError(absl::StrCat("interrupted: Slurm job ", *job, " was cancelled"));
    }
    absl::SleepFor(kPollPeriod);
    if (absl::Now() - polled < kSlurmPeriod) continue;
    polled = absl::Now();
    const auto left = RunShell(absl::StrCat("squeue --noheader --jobs ", *job));
    queued = left.ok() && !left->empty();
  }
  return absl::OkStatus();
}

}  // namespace phrenic::client
