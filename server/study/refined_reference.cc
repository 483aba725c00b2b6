#include "server/study/refined_reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/study/subject.h"

namespace phrenic::study {
namespace {

constexpr double kFirstFraction = 0.25;  // of the largest stable step
constexpr double kMostCpuOfRun = 200;    // of one run [s]
constexpr int kMostRefinements = 14;

// Returns the step of the first run [s].
double FirstReferenceStep(const Subject& subject) {
  return kFirstFraction * std::min(PredictedStep(subject), subject.parameters.time_step());
}

void ReportRefined(const Trajectory& run, double step, const Distance& error, double cpu_s, const Subject& subject,
                   v1::Reference& report) {
  report.set_method(absl::StrFormat("velocity Verlet at %.3g ms, the step halved until runs agree", 1e3 * step));
  report.set_error_max_mm(1e3 * error.largest);
  report.set_error_rms_mm(1e3 * error.rms);
  report.set_evaluations(std::lround(run.simulated_s / step));
  report.set_cpu_s(cpu_s);
  report.set_largest_displacement_mm(1e3 * LargestDisplacement(*subject.model, run));
}

}  // namespace

bool IsSmooth(const Model& model) {
  return std::all_of(model.constraints.begin(), model.constraints.end(),
                     [](const auto& constraint) { return constraint->smooth(); });
}

absl::StatusOr<Trajectory> RefinedReference(const Subject& studied, const std::vector<double>& moments,
                                            double tolerance, const Progress& progress, v1::Reference& report) {
  Subject subject = With(studied, v1::INTEGRATOR_VELOCITY_VERLET);
  subject.parameters.set_step_tolerance(0);
  report.set_tolerance_m(tolerance);
  double step = FirstReferenceStep(subject), cpu_s = 0;
  Trajectory last;
  for (int run = 0; run < kMostRefinements && 2 * last.cpu_s < kMostCpuOfRun; ++run, step /= 2) {
    const auto labelled = [&](double done, std::string_view) {
      return progress((run + done) / kMostRefinements,
                      absl::StrFormat("reference: velocity Verlet at %.3g ms", 1e3 * step));
    };
    auto finer = Simulate(subject, moments, step, kMostCpuOfRun, labelled);
    if (!finer.ok()) return finer.status();
    cpu_s += finer->cpu_s;
    if (!finer->problem.empty()) break;
    const bool comparable = !last.states.empty();
    const Distance error = comparable ? DistanceBetween(subject, last, *finer) : Distance();
    last = *std::move(finer);
    if (!comparable) continue;
    ReportRefined(last, DividingStep(moments, step), error, cpu_s, subject, report);
    if (error.largest < tolerance) break;
  }
  if (report.method().empty()) {
    return absl::AbortedError(
        "there is no reference solution: velocity Verlet did not reach the end at a quarter and an eighth of its "
        "stable "
        "step: shorten the study");
  }
  return last;
}

}  // namespace phrenic::study
