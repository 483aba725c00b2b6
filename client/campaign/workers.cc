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
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "absl/time/clock.h"
#include "client/campaign/worker.h"

namespace phrenic::client {
namespace {

constexpr absl::Duration kLook = absl::Milliseconds(100);
constexpr absl::Duration kAskSlurm = absl::Seconds(2);

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

// The processes of a campaign on this machine; those that still run when it goes are ended.
class Crew {
 public:
  Crew(const Workers& workers, int shares) : workers_(workers), shares_(shares) {}
  ~Crew() {
    for (const pid_t pid : running_) kill(pid, SIGTERM);
    for (const pid_t pid : running_) waitpid(pid, nullptr, 0);
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  bool busy() const { return next_ < shares_ || !running_.empty(); }
  // Starts who is missing and sees who has ended.
  absl::Status Look() {
    while (next_ < shares_ && static_cast<int>(running_.size()) < workers_.at_once) {
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
          "a worker ended before its runs were done: what is finished is kept, so start the campaign again to go on");
    }
    return absl::OkStatus();
  }

 private:
  const Workers& workers_;
  const int shares_;
  int next_ = 0;
  std::set<pid_t> running_;
};

// What a command prints; INTERNAL with what it says where it fails.
absl::StatusOr<std::string> Ask(const std::string& command) {
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return absl::InternalError(absl::StrCat("cannot run ", command));
  std::string said;
  std::array<char, 512> part{};
  while (fgets(part.data(), part.size(), pipe) != nullptr) said += part.data();
  const int status = pclose(pipe);
  const std::string text(absl::StripAsciiWhitespace(said));
  if (status == 0) return text;
  return absl::InternalError(absl::StrCat(command.substr(0, command.find(' ')), ": ", text));
}

std::string Quoted(const std::string& word) {
  return absl::StrCat("'", absl::StrReplaceAll(word, {{"'", "'\\''"}}), "'");
}

std::string SlurmCommand(const Workers& workers, int shares, const std::string& log_folder) {
  std::string work = Quoted(ThisProgram());
  for (const std::string& argument : workers.arguments) absl::StrAppend(&work, " ", Quoted(argument));
  absl::StrAppend(&work, " --share $SLURM_ARRAY_TASK_ID/", shares);
  return absl::StrCat("sbatch --parsable --job-name=phrenic --array=0-", shares - 1, "%", workers.at_once,
                      " --output=", Quoted(log_folder + "/slurm-%A-%a.log"), " --wrap ", Quoted(work));
}

}  // namespace

absl::Status RunHere(const Workers& workers, int shares, const std::function<bool()>& wait) {
  Crew crew(workers, shares);
  while (crew.busy()) {
    if (absl::Status status = crew.Look(); !status.ok()) return status;
    if (!wait()) return absl::CancelledError("interrupted");
    absl::SleepFor(kLook);
  }
  return absl::OkStatus();
}

absl::Status RunOnSlurm(const Workers& workers, int shares, const std::string& log_folder,
                        const std::function<bool()>& wait) {
  const auto job = Ask(SlurmCommand(workers, shares, log_folder));
  if (!job.ok()) return job.status();
  absl::Time asked = absl::Now();
  for (bool queued = true; queued;) {
    if (!wait()) {
      Ask(absl::StrCat("scancel ", *job)).status().IgnoreError();
      return absl::CancelledError(absl::StrCat("interrupted: Slurm job ", *job, " was cancelled"));
    }
    absl::SleepFor(kLook);
    if (absl::Now() - asked < kAskSlurm) continue;
    asked = absl::Now();
    const auto left = Ask(absl::StrCat("squeue --noheader --jobs ", *job));
    queued = left.ok() && !left->empty();
  }
  return absl::OkStatus();
}

}  // namespace phrenic::client
