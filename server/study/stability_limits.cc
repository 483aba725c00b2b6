#include "server/study/stability_limits.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/str_format.h"
#include "server/mechanics/integrators/catalogue.h"
#include "server/mechanics/step/step.h"
#include "server/schema/thread_cpu.h"
#include "server/study/watched_run.h"

namespace phrenic::study {
namespace {

constexpr double kPerturbation = 1e-8;    // amplitude v/omega of the perturbation, in sizes of the scene
constexpr long kSteps = 400;              // of a trial
constexpr long kMaxSteps = 20000;         // of a trial: limits that need more are not measured
constexpr double kDampings = 60;          // damping times of a trial of explicit Euler with friction
constexpr double kGrowth = 30;            // ratio of energies of the last and the second quarter
constexpr double kSlowGrowth = 2;         // the same for explicit Euler
constexpr double kRunaway = 1e12;         // growth of the energy from its first value that ends a trial
constexpr double kLimitTolerance = 0.01;  // relative, of the measured limit
constexpr double kFirstFactor = 1.03;     // first ratio to the prediction in the search
constexpr double kMaxFactor = 4;          // largest ratio to the prediction in the search

// The result of a trial; kCut if it ran out of CPU time.
enum class Trial { kBounded, kGrows, kCut };

// The largest kinetic energy of the difference in each quarter of a trial [J].
struct Quarters {
  std::array<double, 4> largest = {};
  double first = 0;

  void Add(long step, long steps, double energy) {
    if (step == 0) first = energy;
    double& quarter = largest.at(static_cast<size_t>(4 * step / steps));
    quarter = std::max(quarter, energy);
  }
  bool Runaway(double energy) const { return !(energy <= kRunaway * first); }
  double Growth() const { return largest[3] / largest[1]; }
};

// Number of steps of a trial. Explicit Euler grows per step by the small difference of the energy that it adds and the
// energy that friction dissipates.
double StepsToSeeGrowth(const Subject& subject, const FastestMode& fastest, double dt) {
  if (subject.parameters.integrator() != v1::INTEGRATOR_EXPLICIT_EULER) return kSteps;
  const double damped = fastest.spectrum.least_damping_rate * dt;
  return damped > 0 ? std::max<double>(kSteps, kDampings / damped) : kSteps;
}

// An unperturbed and a perturbed run.
class Pair {
 public:
  Pair(const Subject& subject, const FastestMode& fastest)
      : subject_(subject),
        plain_(subject.model->InitialState()),
        perturbed_(Perturbed(subject, fastest)),
        plain_work_(subject.model->MakeWorkspace()),
        perturbed_work_(subject.model->MakeWorkspace()) {}

  bool Advance(double dt) {
    return Step(*subject_.model, subject_.parameters, dt, plain_, plain_work_).ok() &&
           Step(*subject_.model, subject_.parameters, dt, perturbed_, perturbed_work_).ok();
  }
  // Kinetic energy of the difference [J].
  double Difference() const { return KineticEnergy(*subject_.model, perturbed_.v - plain_.v); }

 private:
  const Subject& subject_;
  State plain_, perturbed_;
  Workspace plain_work_, perturbed_work_;
};

// Finds the step at which trials change from bounded to growing.
class Bisection {
 public:
  Bisection(const Subject& subject, const FastestMode& fastest, double most_cpu_s, const Progress& progress)
      : subject_(subject), fastest_(fastest), most_cpu_s_(most_cpu_s), progress_(progress) {
    subject_.parameters.set_step_tolerance(0);
    subject_.parameters.set_breath_force(0);
    subject_.parameters.set_rib_motion(0);
    subject_.parameters.set_apply_muscles(false);
  }

  // Runs a trial with the step dt.
  absl::StatusOr<Trial> Try(double dt) {
    subject_.parameters.set_time_step(dt);
    Pair pair(subject_, fastest_);
    Quarters quarters;
    const long steps = std::lround(StepsToSeeGrowth(subject_, fastest_, dt));
    const double began = ThreadCpuSeconds();
    for (long step = 0; step < steps; ++step) {
      if (step % kCheckInterval == 0) {
        if (!progress_(0.5, absl::StrFormat("measuring the limit at %.3g ms", 1e3 * dt))) return Cancelled();
        if (ThreadCpuSeconds() - began > most_cpu_s_) return Trial::kCut;
      }
      if (!pair.Advance(dt)) return Trial::kGrows;
      const double difference = pair.Difference();
      quarters.Add(step, steps, difference);
      if (quarters.Runaway(difference)) return Trial::kGrows;
    }
    const bool slow = subject_.parameters.integrator() == v1::INTEGRATOR_EXPLICIT_EULER;
    return quarters.Growth() > (slow ? kSlowGrowth : kGrowth) ? Trial::kGrows : Trial::kBounded;
  }

  // Bisects between a stable step and an unstable one.
  absl::Status Narrow(double low, double high, v1::LimitRow& row) {
    while (high > low * (1 + kLimitTolerance)) {
      const double middle = std::sqrt(low * high);
      const auto trial = Try(middle);
      if (!trial.ok()) return trial.status();
      if (*trial == Trial::kCut) return Cut(row);
      (*trial == Trial::kBounded ? low : high) = middle;
    }
    row.set_measured_s(std::sqrt(low * high));
    return absl::OkStatus();
  }

  // Brackets the limit by steps away from the prediction, then bisects.
  absl::Status Search(double predicted, v1::LimitRow& row) {
    const auto at = Try(predicted);
    if (!at.ok()) return at.status();
    if (*at == Trial::kCut) return Cut(row);
    const bool up = *at == Trial::kBounded;
    double last = predicted;
    for (double factor = kFirstFactor; factor < kMaxFactor * kFirstFactor; factor *= factor) {
      const double next = up ? predicted * factor : predicted / factor;
      const auto trial = Try(next);
      if (!trial.ok()) return trial.status();
      if (*trial == Trial::kCut) return Cut(row);
      if ((*trial == Trial::kBounded) != up) return Narrow(std::min(last, next), std::max(last, next), row);
      last = next;
    }
    row.set_note(absl::StrFormat("still %s at %.3g s", up ? "stable" : "unstable", last));
    return absl::OkStatus();
  }

 private:
  static absl::Status Cut(v1::LimitRow& row) {
    row.set_note("out of time: raise most_seconds_a_run");
    return absl::OkStatus();
  }

  Subject subject_;
  const FastestMode& fastest_;
  double most_cpu_s_;
  const Progress& progress_;
};

const char* InWords(Trial trial) {
  switch (trial) {
    case Trial::kBounded:
      return "stable";
    case Trial::kGrows:
      return "unstable";
    case Trial::kCut:
      break;
  }
  return "out of time";
}

// Checks by one trial that theory is right if it predicts no limit or no stable step.
absl::Status TryOne(Bisection& bisection, double predicted, double dt, v1::LimitRow& row) {
  const auto trial = bisection.Try(dt);
  if (!trial.ok()) return trial.status();
  const char* const theory = predicted > 0 ? "stable at any step" : "stable at no step";
  row.set_note(absl::StrFormat("by theory %s; measured at %.3g s: %s", theory, dt, InWords(*trial)));
  return absl::OkStatus();
}

}  // namespace

Subject Stiffened(const Subject& subject, double factor) {
  Subject stiffer = subject;
  stiffer.parameters.set_elasticity(factor * subject.parameters.elasticity());
  return stiffer;
}

FastestMode ModeOf(const Subject& subject) {
  return FindFastestMode(*subject.model, subject.parameters, subject.model->InitialState());
}

double TheoreticalStep(const Subject& subject, const FastestMode& fastest) {
  return FindIntegrator(subject.parameters.integrator()).MaxStep(fastest.spectrum);
}

State Perturbed(const Subject& subject, const FastestMode& fastest) {
  State state = subject.model->InitialState();
  if (fastest.vertex < 0) return state;
  state.v += kPerturbation * subject.model->size * fastest.spectrum.omega_max * fastest.mode;
  return state;
}

absl::Status MeasureLimit(const Subject& subject, double most_cpu_s, const Progress& progress, v1::LimitRow& row) {
  const FastestMode fastest = ModeOf(subject);
  if (fastest.vertex < 0) {
    row.set_note("nothing in the scene vibrates");
    return absl::OkStatus();
  }
  const double predicted = TheoreticalStep(subject, fastest);
  Bisection bisection(subject, fastest, most_cpu_s, progress);
  if (predicted == 0) return TryOne(bisection, predicted, 0.2 / fastest.spectrum.omega_max, row);
  if (std::isinf(predicted)) return TryOne(bisection, predicted, kLongestStep, row);
  row.set_predicted_s(predicted);
  if (StepsToSeeGrowth(subject, fastest, predicted) > kMaxSteps) {
    row.set_note(
        absl::StrFormat("not measured: with friction this weak, growth needs more than %d steps to show", kMaxSteps));
    return absl::OkStatus();
  }
  if (absl::Status status = bisection.Search(predicted, row); !status.ok()) return status;
  if (row.has_measured_s()) row.set_ratio(row.measured_s() / predicted);
  return absl::OkStatus();
}

}  // namespace phrenic::study
