#include "server/study/error_rows.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/study/subject.h"

namespace phrenic::study {
namespace {

constexpr double kFirstStep = 1.0 / 30;  // largest step without a stability limit [s]
constexpr double kErrorFloor = 3;        // in errors of the reference: smaller errors are not significant
constexpr double kMinTime = 0.02;        // runs are repeated until they take this long in total [s]
constexpr size_t kMaxRuns = 9;
constexpr const char* kOk = "ok";
constexpr const char* kLate = "out of time";

// Runs the subject, repeatedly if a run is too short to time; the CPU time is the median.
absl::StatusOr<Trajectory> Timed(const Subject& subject, const std::vector<double>& moments, double dt,
                                 double most_cpu_s, const Progress& progress) {
  auto run = Simulate(subject, moments, dt, most_cpu_s, progress);
  if (!run.ok() || !run->problem.empty()) return run;
  std::vector<double> times = {run->cpu_s};
  for (double spent = run->cpu_s; spent < kMinTime && times.size() < kMaxRuns; spent += times.back()) {
    auto again = Simulate(subject, moments, dt, most_cpu_s, progress);
    if (!again.ok()) return again;
    times.push_back(again->cpu_s);
  }
  std::nth_element(times.begin(), times.begin() + static_cast<long>(times.size() / 2), times.end());
  run->cpu_s = times[times.size() / 2];
  return run;
}

double FirstStep(const Subject& subject) { return std::min(0.95 * PredictedStep(subject), kFirstStep); }

void Judge(const Subject& subject, const ReferenceSolution& solution, const Trajectory& run, v1::ErrorRow& row) {
  if (run.simulated_s > 0) row.set_cpu_per_second(run.cpu_s / run.simulated_s);
  if (!run.problem.empty()) {
    row.set_verdict(run.problem);
    return;
  }
  row.set_real_time(row.cpu_per_second() < 1);
  const Distance distance = DistanceBetween(subject, run, solution.trajectory);
  if (distance.rms < kErrorFloor * solution.error_rms || distance.largest < kErrorFloor * solution.error_max) {
    row.set_verdict("below the reference's error");
    return;
  }
  row.set_error_max_mm(1e3 * distance.largest);
  row.set_error_rms_mm(1e3 * distance.rms);
  if (!subject.model->probes.empty()) row.set_error_probe_mm(1e3 * distance.probes);
  row.set_error_energy_j(distance.energy);
  row.set_verdict(kOk);
}

// Sets the observed order of each row: log(e1/e2) / log(h1/h2) with the next, finer row.
void SetOrders(int first, v1::ErrorTable& table) {
  for (int i = first; i + 1 < table.rows_size(); ++i) {
    v1::ErrorRow& row = *table.mutable_rows(i);
    const v1::ErrorRow& finer = table.rows(i + 1);
    if (!row.has_error_rms_mm() || !finer.has_error_rms_mm()) continue;
    row.set_order(std::log(row.error_rms_mm() / finer.error_rms_mm()) /
                  std::log(row.time_step_s() / finer.time_step_s()));
  }
}

bool Dominates(const v1::ErrorRow& a, const v1::ErrorRow& b) {
  return a.verdict() == kOk && a.error_rms_mm() <= b.error_rms_mm() && a.cpu_per_second() <= b.cpu_per_second() &&
         (a.error_rms_mm() < b.error_rms_mm() || a.cpu_per_second() < b.cpu_per_second());
}

// At least three digits, without an exponent.
std::string PaceText(double pace) { return pace < 100 ? absl::StrFormat("%.3g", pace) : absl::StrFormat("%.0f", pace); }

std::string Pace(double cpu_per_second) {
  return cpu_per_second < 1 ? absl::StrCat(PaceText(1 / cpu_per_second), " times faster than real time")
                            : absl::StrFormat("%.3g times slower than real time", cpu_per_second);
}

}  // namespace

absl::Status AddIntegrator(const Subject& subject, const v1::ErrorStudy& study, const ReferenceSolution& solution,
                           const Progress& progress, v1::ErrorTable& table) {
  const std::string name = NameOf(subject.parameters.integrator());
  const int first = table.rows_size();
  double dt = FirstStep(subject);
  if (!(dt > 0)) {
    v1::ErrorRow& row = *table.add_rows();
    row.set_integrator(name);
    row.set_verdict("no step is stable here: it adds energy");
    return absl::OkStatus();
  }
  // The cost of level n is proportional to 2^n.
  const double all = std::exp2(study.levels()) - 1;
  bool late = false;
  for (int level = 0; level < study.levels(); ++level, dt /= 2) {
    v1::ErrorRow& row = *table.add_rows();
    row.set_integrator(name);
    row.set_time_step_s(DividingStep(solution.moments, dt));
    if (late) {
      row.set_verdict(kLate);
      continue;
    }
    const Progress part = Part(progress, (std::exp2(level) - 1) / all, (std::exp2(level + 1) - 1) / all);
    const auto labelled = [&](double done, std::string_view) {
      return part(done, absl::StrFormat("%s at %.3g ms", name, 1e3 * dt));
    };
    const auto run = Timed(subject, solution.moments, dt, study.most_seconds_a_run(), labelled);
    if (!run.ok()) return run.status();
    Judge(subject, solution, *run, row);
    late = absl::StartsWith(run->problem, kLate);
  }
  SetOrders(first, table);
  return absl::OkStatus();
}

void MarkPareto(v1::ErrorTable& table) {
  for (v1::ErrorRow& row : *table.mutable_rows()) {
    bool dominated = row.verdict() != kOk;
    for (const v1::ErrorRow& other : table.rows()) dominated = dominated || Dominates(other, row);
    row.set_pareto(!dominated);
  }
}

std::string Advice(const v1::ErrorTable& table, double target) {
  const v1::ErrorRow* best = nullptr;
  const v1::ErrorRow* nearest = nullptr;
  for (const v1::ErrorRow& row : table.rows()) {
    if (row.verdict() != kOk) continue;
    if (nearest == nullptr || row.error_max_mm() < nearest->error_max_mm()) nearest = &row;
    if (row.error_max_mm() > 1e3 * target) continue;
    if (best == nullptr || row.cpu_per_second() < best->cpu_per_second()) best = &row;
  }
  if (best != nullptr) {
    return absl::StrFormat(
        "For an error of %g mm at any vertex use %s at %.3g ms: its error is %.2g mm and it runs %s.", 1e3 * target,
        best->integrator(), 1e3 * best->time_step_s(), best->error_max_mm(), Pace(best->cpu_per_second()));
  }
  std::string missed =
      absl::StrFormat("No run has an error of %g mm or less: raise levels or the target.", 1e3 * target);
  if (nearest == nullptr) return missed;
  return absl::StrFormat("%s The smallest error is that of %s at %.3g ms: %.2g mm.", missed, nearest->integrator(),
                         1e3 * nearest->time_step_s(), nearest->error_max_mm());
}

}  // namespace phrenic::study
