#include "server/study/stability_map.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "server/study/stability_limits.h"
#include "server/study/subject.h"
#include "server/study/watched_run.h"

namespace phrenic::study {
namespace {

constexpr double kMargin = 0.05;        // relative distance from the limit of the two steps next to it
constexpr double kSmallStep = 0.25;     // of the reference run, in units of the limit
constexpr double kDamped = 0.01;        // ratio to the energy of the reference run: below, a run is "damped"
constexpr double kGrown = 10;           // the same: above, a run is "grown"
constexpr double kReferenceBudget = 4;  // CPU time of the reference run, in budgets of a run
constexpr double kUnstableStep = 0.1;   // over omega: first step if no step is stable

// The limit around which steps are chosen [s]; infinity if there is none.
double Centre(const Subject& subject, const FastestMode& fastest) {
  const double limit = TheoreticalStep(subject, fastest);
  return limit > 0 ? limit : kUnstableStep / fastest.spectrum.omega_max;
}

// Returns the time steps to try [s], the longest first.
std::vector<double> TimeSteps(double centre, int steps, double seconds) {
  std::vector<double> time_steps;
  const double longest = std::min(kLongestStep, seconds);
  if (std::isinf(centre) || centre > 2 * longest) {
    for (int i = 0; i < 2 * steps; ++i) time_steps.push_back(std::ldexp(longest, -i));
    return time_steps;
  }
  for (int i = steps - 1; i >= 0; --i) time_steps.push_back(std::ldexp((1 + kMargin) * centre, i));
  for (int i = 0; i < steps; ++i) time_steps.push_back(std::ldexp((1 - kMargin) * centre, -i));
  std::erase_if(time_steps, [longest](double dt) { return dt > longest; });
  return time_steps;
}

// One stiffness: the initial state of its runs and the energies of a reference run with a small step.
struct Setting {
  double factor;
  State start;
  bool known = false;                            // true if the reference run was completed
  double largest_kinetic = 0, late_kinetic = 0;  // of the reference run [J]
};

absl::StatusOr<Setting> MakeSetting(const Subject& subject, double factor, const v1::StabilityStudy& study,
                                    const Progress& progress) {
  const Subject exact = With(subject, v1::INTEGRATOR_VELOCITY_VERLET);
  const FastestMode fastest = ModeOf(exact);
  Setting setting{.factor = factor, .start = Perturbed(exact, fastest)};
  const double dt = std::min(kSmallStep * TheoreticalStep(exact, fastest), study.seconds() / 100);
  const auto run =
      Watch(exact, setting.start, study.seconds(), dt, kReferenceBudget * study.most_seconds_a_run(), progress);
  if (!run.ok()) return run.status();
  setting.known = run->status.ok() && !run->cut;
  setting.largest_kinetic = run->largest_kinetic;
  setting.late_kinetic = run->late_kinetic;
  return setting;
}

const char* Verdict(const WatchedRun& run, const Setting& setting) {
  if (run.cut) return "out of time";
  if (absl::IsAborted(run.status)) return "stopped";
  if (!run.status.ok()) return "diverged";
  if (!setting.known || setting.largest_kinetic == 0) return "stable";
  if (run.largest_kinetic >= kGrown * setting.largest_kinetic) return "grown";
  return run.late_kinetic < kDamped * setting.late_kinetic ? "damped" : "stable";
}

void Fill(const WatchedRun& run, const Setting& setting, v1::StabilityRow& row) {
  row.set_verdict(Verdict(run, setting));
  if (!run.status.ok()) {
    row.set_diverged_at_s(run.divergence.time());
    row.set_where(Where(run.divergence));
    return;
  }
  if (!run.cut && setting.known && setting.largest_kinetic > 0) {
    row.set_energy_ratio(run.largest_kinetic / setting.largest_kinetic);
  }
}

// Adds the rows of one integrator at one stiffness. Runs of `most_steps` steps or more are skipped; it is lowered if a
// run exceeds its CPU time.
absl::Status AddIntegrator(const Subject& subject, const Setting& setting, const v1::StabilityStudy& study,
                           const Progress& progress, double& most_steps, v1::StabilityTable& table) {
  const std::string name = NameOf(subject.parameters.integrator());
  const std::vector<double> time_steps = TimeSteps(Centre(subject, ModeOf(subject)), study.steps(), study.seconds());
  for (size_t i = 0; i < time_steps.size(); ++i) {
    v1::StabilityRow& row = *table.add_map();
    row.set_integrator(name);
    row.set_stiffness(setting.factor);
    row.set_time_step_s(time_steps[i]);
    if (study.seconds() / time_steps[i] >= most_steps) {
      row.set_verdict("out of time");
      continue;
    }
    const auto size = static_cast<double>(time_steps.size());
    const Progress part = Part(progress, static_cast<double>(i) / size, static_cast<double>(i + 1) / size);
    const auto labelled = [&](double done, std::string_view) {
      return part(done, absl::StrFormat("%s at %.3g ms, stiffness x %g", name, 1e3 * time_steps[i], setting.factor));
    };
    const auto run =
        Watch(subject, setting.start, study.seconds(), time_steps[i], study.most_seconds_a_run(), labelled);
    if (!run.ok()) return run.status();
    if (run->cut) most_steps = study.seconds() / time_steps[i];
    Fill(*run, setting, row);
  }
  return absl::OkStatus();
}

}  // namespace

std::vector<double> StiffnessFactors(double stiffest) {
  std::vector<double> factors;
  for (double factor = 1; factor <= stiffest * (1 + 1e-9); factor *= 10) factors.push_back(factor);
  return factors;
}

absl::Status AddMap(const Subject& subject, const v1::StabilityStudy& study, const Progress& progress,
                    v1::StabilityTable& table) {
  const std::vector<double> factors = StiffnessFactors(study.stiffest());
  const std::vector<v1::Integrator> integrators = IntegratorsFor(study.integrators());
  std::vector<double> most_steps(integrators.size(), std::numeric_limits<double>::infinity());
  const auto all = static_cast<double>(factors.size() * (integrators.size() + 1));
  double done = 0;
  const auto next = [&] { return Part(progress, done / all, (done + 1) / all); };
  for (const double factor : factors) {
    const Subject stiffer = Stiffened(subject, factor);
    const auto setting = MakeSetting(stiffer, factor, study, next());
    if (!setting.ok()) return setting.status();
    ++done;
    for (size_t k = 0; k < integrators.size(); ++k, ++done) {
      absl::Status status = AddIntegrator(With(stiffer, integrators[k]), *setting, study, next(), most_steps[k], table);
      if (!status.ok()) return status;
    }
  }
  return absl::OkStatus();
}

}  // namespace phrenic::study
