#include "server/study/leaving.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_format.h"

namespace phrenic::study {
namespace {

constexpr double kMoreEnergy = 10;  // of the run at short steps: errors of integration alone stay far below

double FurthestApart(const Points& a, const Points& b) {
  return a.cols() > 0 ? (a - b).colwise().norm().maxCoeff() : 0;
}

}  // namespace

absl::StatusOr<ShortStepRun> RunShortSteps(const Subject& subject, const State& start, double seconds, double dt,
                                           double most_cpu_s, const Progress& progress) {
  auto run = Watch(subject, start, seconds, dt, most_cpu_s, progress);
  if (!run.ok()) return run.status();
  ShortStepRun reference{.start = start,
                         .seconds = run->cut ? run->simulated_s : seconds,
                         .kinetic = std::max(run->largest_kinetic, KineticEnergy(*subject.model, start.v)),
                         .end = std::move(run->last.x),
                         .problem = ""};
  if (!run->status.ok()) {
    reference.problem = absl::StrFormat("%s at %.3g s, %s", absl::IsAborted(run->status) ? "stops" : "diverges",
                                        run->simulated_s, Where(run->divergence));
  }
  return reference;
}

absl::StatusOr<Trial> TryStep(const Subject& subject, const ShortStepRun& short_steps, double dt, double growth,
                              double most_cpu_s, const Progress& progress) {
  const auto run = Watch(subject, short_steps.start, short_steps.seconds, dt, most_cpu_s, progress);
  if (!run.ok()) return run.status();
  const double most =
      std::max(kMoreEnergy * short_steps.kinetic, growth * KineticEnergy(*subject.model, short_steps.start.v));
  if (!run->status.ok() || !(run->largest_kinetic <= most)) return Trial::kLeaves;
  if (run->cut) return Trial::kCut;
  return FurthestApart(run->last.x, short_steps.end) <= subject.model->size ? Trial::kStays : Trial::kLeaves;
}

}  // namespace phrenic::study
