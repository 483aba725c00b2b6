#include "server/study/uncertainty/runs.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::study {
namespace {

constexpr absl::Duration kReportEvery = absl::Milliseconds(100);

// The runs that threads take one after the other. Thread-safe.
class RunQueue {
 public:
  RunQueue(const Outputs& outputs, std::span<const v1::Parameters> parameters)
      : outputs_(outputs), parameters_(parameters), runs_{std::vector<RunOutputs>(parameters.size())} {}

  // Takes runs until none is left, one fails to run at all, or Cancel was called.
  void Work() {
    for (size_t i = next_++; i < parameters_.size() && !cancelled_; i = next_++) {
      auto run = outputs_.Run(parameters_[i], [this] { return cancelled_.load(); });
      const absl::MutexLock lock(&mutex_);
      if (!run.ok()) {
        status_.Update(run.status());
        cancelled_ = true;
        return;
      }
      runs_.each[i] = *std::move(run);
      ++done_;
    }
  }

  void Cancel() { cancelled_ = true; }

  // Waits a moment for the end. Returns the number of runs done; all of them also if a run could not be made.
  size_t Wait() {
    const absl::MutexLock lock(&mutex_);
    mutex_.AwaitWithTimeout(absl::Condition(this, &RunQueue::Ended), kReportEvery);
    return Ended() ? parameters_.size() : done_;
  }

  // Requires: no thread works any more.
  absl::StatusOr<RunSet> Take() {
    const absl::MutexLock lock(&mutex_);
    if (!status_.ok()) return status_;
    return std::move(runs_);
  }

 private:
  bool Ended() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return done_ == parameters_.size() || !status_.ok(); }

  const Outputs& outputs_;
  const std::span<const v1::Parameters> parameters_;
  std::atomic<size_t> next_ = 0;
  std::atomic<bool> cancelled_ = false;
  absl::Mutex mutex_;
  RunSet runs_ ABSL_GUARDED_BY(mutex_);
  size_t done_ ABSL_GUARDED_BY(mutex_) = 0;
  absl::Status status_ ABSL_GUARDED_BY(mutex_);
};

size_t ThreadsFor(int wanted, size_t runs) {
  const size_t cores = std::max(1U, std::thread::hardware_concurrency());
  return std::min({wanted > 0 ? static_cast<size_t>(wanted) : cores, cores, runs});
}

}  // namespace

absl::Status CheckRuns(double runs, size_t numbers_per_run) {
  if (runs > static_cast<double>(kMostRuns)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("samples: these are %.4g runs, more than %d: lower them", runs, kMostRuns));
  }
  const double numbers = runs * static_cast<double>(numbers_per_run);
  if (numbers <= kMostNumbers) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("samples: %.4g runs give %.4g numbers, more than %.4g: lower them, or name fewer outputs", runs,
                      numbers, kMostNumbers));
}

std::vector<double> RunSet::ValuesOf(size_t output) const {
  std::vector<double> values;
  values.reserve(each.size());
  for (const RunOutputs& run : each) values.push_back(run.values[output]);
  return values;
}

long RunSet::CountFailed() const {
  return std::count_if(each.begin(), each.end(), [](const RunOutputs& run) { return !run.problem.empty(); });
}

std::string RunSet::FirstProblem() const {
  const auto failed =
      std::find_if(each.begin(), each.end(), [](const RunOutputs& run) { return !run.problem.empty(); });
  return failed == each.end() ? "" : failed->problem;
}

absl::StatusOr<RunSet> RunAll(const Outputs& outputs, std::span<const v1::Parameters> parameters, int threads,
                              const std::string& doing, const Progress& progress) {
  RunQueue queue(outputs, parameters);
  bool cancelled = false;
  {
    std::vector<std::jthread> workers;
    for (size_t i = 0; i < ThreadsFor(threads, parameters.size()); ++i)
      workers.emplace_back([&queue] { queue.Work(); });
    for (size_t done = 0; done < parameters.size() && !cancelled;) {
      done = queue.Wait();
      const std::string words =
          absl::StrFormat("%s: run %d of %d", doing, std::min(done + 1, parameters.size()), parameters.size());
      cancelled = !progress(static_cast<double>(done) / static_cast<double>(parameters.size()), words);
    }
    if (cancelled) queue.Cancel();
  }
  if (cancelled) return Cancelled();
  return queue.Take();
}

absl::StatusOr<RunSet> RunAt(const Outputs& outputs, const std::vector<Input>& inputs, const v1::Parameters& nominal,
                             const UnitPoints& points, int threads, const std::string& doing,
                             const Progress& progress) {
  std::vector<v1::Parameters> parameters(static_cast<size_t>(points.rows()), nominal);
  for (size_t j = 0; j < parameters.size(); ++j) {
    const auto row = points.row(static_cast<Eigen::Index>(j));
    SetInputs(inputs, {row.data(), inputs.size()}, parameters[j]);
  }
  return RunAll(outputs, parameters, threads, doing, progress);
}

}  // namespace phrenic::study
