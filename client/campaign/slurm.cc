#include "client/campaign/slurm.h"

#include <unistd.h>

#include <array>
#include <cstdio>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "absl/time/clock.h"
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

std::string SlurmCommand(const SlurmJobs& jobs, const std::string& log_folder) {
  std::string work = ShellWord(ThisProgram());
  for (const std::string& argument : jobs.arguments) absl::StrAppend(&work, " ", ShellWord(argument));
  absl::StrAppend(&work, " --share $SLURM_ARRAY_TASK_ID/", jobs.shares);
  return absl::StrCat("sbatch --parsable --job-name=phrenic --array=0-", jobs.shares - 1, "%", jobs.concurrent,
                      " --output=", ShellWord(log_folder + "/slurm-%A-%a.log"), " --wrap ", ShellWord(work));
}

}  // namespace

absl::Status RunOnSlurm(const SlurmJobs& jobs, const std::string& log_folder, const std::function<bool()>& wait) {
  const auto job = RunShell(SlurmCommand(jobs, log_folder));
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
