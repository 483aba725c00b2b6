#include "server/study/uncertainty/runs.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "absl/strings/str_format.h"
#include "server/study/batch/run_pool.h"

namespace phrenic::study {

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
  using Numbered = std::pair<size_t, RunOutputs>;
  const MakeResult<Numbered> make = [&](size_t run, const std::function<bool()>& ended) -> absl::StatusOr<Numbered> {
    auto result = outputs.Run(parameters[run], ended);
    if (!result.ok()) return result.status();
    return Numbered(run, *std::move(result));
  };
  RunSet runs{std::vector<RunOutputs>(parameters.size())};
  size_t done = 0;
  const auto report = [&] {
    const std::string words =
        absl::StrFormat("%s: run %d of %d", doing, std::min(done + 1, parameters.size()), parameters.size());
    return progress(static_cast<double>(done) / static_cast<double>(parameters.size()), words);
  };
  const auto take = [&](Numbered result) {
    runs.each[result.first] = std::move(result.second);
    ++done;
    return true;
  };
  const absl::Status status = RunOnThreads<Numbered>(parameters.size(), ThreadsFor(threads, parameters.size()), make,
                                                     take, [&report] { return !report(); });
  if (!status.ok()) return status;
  if (!report()) return Cancelled();
  return runs;
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
