#include "server/study/stability_limits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_format.h"
#include "server/mechanics/integrators/catalogue.h"
#include "server/study/leaving.h"

namespace phrenic::study {
namespace {

constexpr double kPerturbation = 1e-8;    // amplitude v/omega of the perturbation, in sizes of the scene
constexpr double kTenth = 0.1;            // step of the run that trials are compared with, over the predicted limit
constexpr long kSteps = 400;              // least number of steps of a trial at the predicted limit
constexpr long kShortestTrial = 30;       // the same if the CPU budget cuts it
constexpr long kMaxSteps = 20000;         // largest number: limits that need more are not measured
constexpr double kDampings = 60;          // damping times of a trial of explicit Euler with friction
constexpr double kGrowth = 1e6;           // of the perturbation's energy: resonance below the limit stays far below it
constexpr double kSlowGrowth = 10;        // the same for explicit Euler, and where no step is stable
constexpr double kLimitTolerance = 0.01;  // relative, of the measured limit
constexpr double kFirstFactor = 1.03;     // first ratio to the prediction in the search
constexpr double kTriedStep = 0.2;        // of a trial where no step is stable, over 1/omega
constexpr double kMaxFactor = 4;          // largest ratio to the prediction in the search

bool GrowsSlowly(const Subject& subject) { return subject.parameters.integrator() == v1::INTEGRATOR_EXPLICIT_EULER; }

// Least number of steps of a trial. Explicit Euler grows per step by the small difference of the energy that it adds
// and the energy that friction dissipates.
double StepsToSeeGrowth(const Subject& subject, const FastestMode& fastest, double dt) {
  if (!GrowsSlowly(subject)) return kSteps;
  const double damped = fastest.spectrum.least_damping_rate * dt;
  return damped > 0 ? std::max<double>(kSteps, kDampings / damped) : kSteps;
}

// Simulated time of the trials [s].
double SimulatedTime(const Subject& subject, const FastestMode& fastest, double seconds, double dt) {
  return std::max(StepsToSeeGrowth(subject, fastest, dt) * dt, std::min(seconds, kMaxSteps * dt));
}

// Finds the step above which the run leaves the run at a tenth of the predicted step.
class Bisection {
 public:
  // A trial leaves if it gains `growth` times the perturbation's energy.
  Bisection(const Subject& subject, const FastestMode& fastest, double growth, double most_cpu_s,
            const Progress& progress)
      : subject_(subject),
        growth_(growth),
        most_cpu_s_(most_cpu_s),
        progress_(progress),
        start_(Perturbed(subject, fastest)) {
    subject_.parameters.set_step_tolerance(0);
  }

  // Makes the run that trials are compared with. `dt` is about the step of the trials [s].
  absl::Status Begin(double seconds, double dt) {
    auto run = RunShortSteps(subject_, start_, seconds, kTenth * dt, most_cpu_s_, Labelled(kTenth * dt));
    if (!run.ok()) return run.status();
    tenth_ = *std::move(run);
    out_of_time_ = tenth_.seconds < std::min(seconds, static_cast<double>(kShortestTrial) * dt) * (1 - 1e-9);
    return absl::OkStatus();
  }

  const ShortStepRun& tenth() const { return tenth_; }
  bool out_of_time() const { return out_of_time_; }

  // Runs a trial with the step dt.
  absl::StatusOr<Trial> Try(double dt) { return TryStep(subject_, tenth_, dt, growth_, most_cpu_s_, Labelled(dt)); }

  // Bisects between a stable step and an unstable one.
  absl::Status Narrow(double low, double high, v1::LimitRow& row) {
    while (high > low * (1 + kLimitTolerance)) {
      const double middle = std::sqrt(low * high);
      const auto trial = Try(middle);
      if (!trial.ok()) return trial.status();
      if (*trial == Trial::kCut) return Cut(row);
      (*trial == Trial::kStays ? low : high) = middle;
    }
    row.set_measured_s(std::sqrt(low * high));
    return absl::OkStatus();
  }

  // Brackets the limit by steps away from the prediction, then bisects.
  absl::Status Search(double predicted, v1::LimitRow& row) {
    const auto at = Try(predicted);
    if (!at.ok()) return at.status();
    if (*at == Trial::kCut) return Cut(row);
    const bool up = *at == Trial::kStays;
    double last = predicted;
    for (double factor = kFirstFactor; factor < kMaxFactor * kFirstFactor; factor *= factor) {
      const double next = up ? predicted * factor : predicted / factor;
      const auto trial = Try(next);
      if (!trial.ok()) return trial.status();
      if (*trial == Trial::kCut) return Cut(row);
      if ((*trial == Trial::kStays) != up) return Narrow(std::min(last, next), std::max(last, next), row);
      last = next;
    }
    row.set_note(absl::StrFormat("still %s at %.3g s", up ? "stable" : "unstable", last));
    return absl::OkStatus();
  }

  static absl::Status Cut(v1::LimitRow& row) {
    row.set_note("out of time: raise most_seconds_a_run");
    return absl::OkStatus();
  }

 private:
  Progress Labelled(double dt) const {
    return [this, dt](double, std::string_view) {
      return progress_(0.5, absl::StrFormat("measuring the limit at %.3g ms", 1e3 * dt));
    };
  }

  Subject subject_;
  const double growth_, most_cpu_s_;
  const Progress& progress_;
  const State start_;
  ShortStepRun tenth_;
  bool out_of_time_ = false;
};

const char* InWords(Trial trial) {
  switch (trial) {
    case Trial::kStays:
      return "stable";
    case Trial::kLeaves:
      return "unstable";
    case Trial::kCut:
      break;
  }
  return "out of time";
}

// Checks by one trial that theory is right if it predicts no limit or no stable step.
absl::Status TryOne(Bisection& bisection, double predicted, double dt, v1::LimitRow& row) {
  const char* const theory = predicted > 0 ? "stable at any step" : "stable at no step";
  Trial trial = Trial::kLeaves;
  if (bisection.tenth().problem.empty()) {
    const auto tried = bisection.Try(dt);
    if (!tried.ok()) return tried.status();
    trial = *tried;
  }
  row.set_note(absl::StrFormat("by theory %s; measured at %.3g s: %s", theory, dt, InWords(trial)));
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

absl::Status MeasureLimit(const Subject& subject, double seconds, double most_cpu_s, const Progress& progress,
                          v1::LimitRow& row) {
  const FastestMode fastest = ModeOf(subject);
  const double omega = fastest.spectrum.omega_max;
  if (fastest.vertex < 0 || !(omega > 0) || std::isinf(omega)) {
    row.set_note("nothing in the scene vibrates");
    return absl::OkStatus();
  }
  const double predicted = TheoreticalStep(subject, fastest);
  const bool has_limit = predicted > 0 && !std::isinf(predicted);
  if (has_limit) row.set_predicted_s(predicted);
  const double dt = has_limit ? predicted : predicted == 0 ? kTriedStep / omega : kLongestStep;
  if (has_limit && StepsToSeeGrowth(subject, fastest, dt) > kMaxSteps) {
    row.set_note(
        absl::StrFormat("not measured: with friction this weak, growth needs more than %d steps to show", kMaxSteps));
    return absl::OkStatus();
  }
  const double growth = predicted == 0 || GrowsSlowly(subject) ? kSlowGrowth : kGrowth;
  Bisection bisection(subject, fastest, growth, most_cpu_s, progress);
  absl::Status status = bisection.Begin(SimulatedTime(subject, fastest, seconds, dt), dt);
  if (!status.ok()) return status;
  row.set_seconds(bisection.tenth().seconds);
  if (bisection.out_of_time()) return Bisection::Cut(row);
  if (!has_limit) return TryOne(bisection, predicted, dt, row);
  if (!bisection.tenth().problem.empty()) {
    row.set_note(
        absl::StrFormat("not measured: at a tenth of the predicted step, the run %s", bisection.tenth().problem));
    return absl::OkStatus();
  }
  if (status = bisection.Search(predicted, row); !status.ok()) return status;
  if (row.has_measured_s()) row.set_ratio(row.measured_s() / predicted);
  return absl::OkStatus();
}

}  // namespace phrenic::study
