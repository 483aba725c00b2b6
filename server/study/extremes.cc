#include "server/study/extremes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/compile.h"
#include "server/schema/schema.h"
#include "server/study/energy_balance.h"
#include "server/study/reference.h"
#include "server/study/subject.h"
#include "server/study/watched_run.h"

namespace phrenic::study {
namespace {

constexpr double kTolerance = 1e-4;      // of guarded runs [m]
constexpr double kMostEnergy = 2;        // over what there is
constexpr double kBaselines = 2;         // errors of the baseline
constexpr double kNegligible = 0.01;     // of the largest way: an error that is none
constexpr double kReferenceErrs = 1e-8;  // [m]
constexpr long kReferenceLooks = 20000;  // of 16 evaluations each, at most, for a reference
constexpr int kMoments = 2;

const v1::Integrator kBaseline = v1::INTEGRATOR_SEMI_IMPLICIT_EULER;

std::vector<v1::Integrator> Chosen(const v1::StabilityStudy& study) {
  if (study.integrators_size() > 0) return IntegratorsFor(study.integrators());
  return {v1::INTEGRATOR_SEMI_IMPLICIT_EULER, v1::INTEGRATOR_VELOCITY_VERLET, v1::INTEGRATOR_RUNGE_KUTTA_4,
          v1::INTEGRATOR_LINEAR_IMPLICIT_EULER, v1::INTEGRATOR_BDF2};
}

absl::StatusOr<Subject> SubjectOf(const ExtremeCase& extreme) {
  absl::StatusOr<v1::Scene> scene = schema::ParseScene(extreme.name, extreme.scene);
  if (!scene.ok()) return scene.status();
  const auto model =
      Compile(*scene, [](const v1::Body&) { return absl::NotFoundError("extreme cases read no files"); });
  if (!model.ok()) return model.status();
  Subject subject{.model = *model, .parameters = (*model)->parameters};
  subject.parameters.set_time_step(extreme.step);
  if (extreme.adjust) extreme.adjust(subject.parameters);
  return subject;
}

State StartOf(const ExtremeCase& extreme, const Subject& subject) {
  State state = subject.model->InitialState();
  if (extreme.disturb) extreme.disturb(*subject.model, state);
  return state;
}

// A run with all that it is judged by.
struct Outcome {
  WatchedRun run;
  double energy_ratio = 0;
  std::vector<State> states;  // at the moments that it reached
};

absl::StatusOr<Outcome> RunCase(const ExtremeCase& extreme, const Subject& subject, double most_cpu_s,
                                const Progress& progress) {
  Outcome outcome;
  EnergyBalance balance(subject);
  const long each = std::lround(extreme.seconds / extreme.step) / kMoments;
  const auto watch = [&](const State& state) {
    balance.Add(state);
    if (state.tick > 0 && state.tick % each == 0) outcome.states.push_back(state);
  };
  auto run = Watch(subject, StartOf(extreme, subject), extreme.seconds, extreme.step, most_cpu_s, progress, watch);
  if (!run.ok()) return run.status();
  outcome.run = *std::move(run);
  outcome.energy_ratio = balance.ratio();
  return outcome;
}

// The independent solution, where there is one that can be had.
std::optional<Trajectory> ReferenceOf(const ExtremeCase& extreme, const Subject& subject) {
  if (!extreme.judged.error) return std::nullopt;
  long looks = 0;
  const Progress enough = [&looks](double, std::string_view) { return ++looks < kReferenceLooks; };
  v1::Reference report;
  auto reference = SolveReferenceFrom(subject, StartOf(extreme, subject), Moments(extreme.seconds, kMoments),
                                      kReferenceErrs, enough, report);
  if (!reference.ok()) return std::nullopt;
  return *std::move(reference);
}

// What errors are held against [m].
struct Bound {
  std::optional<Trajectory> reference;
  double largest_error = 0;
};

double ErrorOf(const Model& model, const Outcome& outcome, const Trajectory& reference) {
  double squares = 0;
  for (size_t i = 0; i < reference.states.size(); ++i) {
    const double apart = RmsApart(model, outcome.states[i].x, reference.states[i].x);
    squares += apart * apart;
  }
  return std::sqrt(squares / static_cast<double>(reference.states.size()));
}

double LargestWay(const Model& model, const Trajectory& reference) {
  double largest = 0;
  for (const State& state : reference.states) {
    largest = std::max(largest, (state.x - model.rest).colwise().norm().maxCoeff());
  }
  return largest;
}

absl::StatusOr<Bound> BoundOf(const ExtremeCase& extreme, const Subject& subject, double most_cpu_s,
                              const Progress& progress) {
  Bound bound{.reference = ReferenceOf(extreme, subject)};
  if (!bound.reference) return bound;
  const auto baseline = RunCase(extreme, With(subject, kBaseline), most_cpu_s, progress);
  if (!baseline.ok()) return baseline.status();
  bound.largest_error = kNegligible * LargestWay(*subject.model, *bound.reference);
  if (baseline->states.size() != bound.reference->states.size()) {
    bound.largest_error = HUGE_VAL;
    return bound;
  }
  const double error = ErrorOf(*subject.model, *baseline, *bound.reference);
  bound.largest_error = std::max(bound.largest_error, kBaselines * error);
  return bound;
}

bool Honest(const v1::Divergence& divergence) {
  return divergence.time() > 0 && !divergence.body().empty() && !divergence.force().empty() &&
         !divergence.remedy().empty();
}

void JudgeStop(const WatchedRun& run, v1::ExtremeRow& row) {
  row.set_verdict(Honest(run.divergence) ? "stopped" : "FAILED");
  row.set_note(absl::StrFormat("%s at %.4g s, %s: %s", absl::IsAborted(run.status) ? "stopped" : "diverged",
                               run.divergence.time(), Where(run.divergence), run.divergence.remedy()));
}

void Judge(const ExtremeCase& extreme, const Model& model, const Outcome& outcome, const Bound& bound,
           v1::ExtremeRow& row) {
  row.set_finite(outcome.run.last.x.allFinite() && outcome.run.last.v.allFinite());
  if (!outcome.run.status.ok()) return JudgeStop(outcome.run, row);
  std::string fault;
  if (outcome.run.cut) fault = absl::StrFormat("out of time at %.4g s; ", outcome.run.simulated_s);
  if (!row.finite()) absl::StrAppend(&fault, "not finite, and no word of it; ");
  if (extreme.judged.energy && outcome.energy_ratio > 0) row.set_energy_ratio(outcome.energy_ratio);
  if (!(row.energy_ratio() <= kMostEnergy)) absl::StrAppend(&fault, "more energy than there is; ");
  if (bound.reference && outcome.states.size() == bound.reference->states.size()) {
    const double error = ErrorOf(model, outcome, *bound.reference);
    row.set_error_rms_mm(1e3 * error);
    if (!(error <= bound.largest_error)) {
      absl::StrAppend(&fault, absl::StrFormat("errs by more than %.3g mm; ", 1e3 * bound.largest_error));
    }
  }
  row.set_verdict(fault.empty() ? "pass" : "FAILED");
  row.set_note(fault.substr(0, fault.empty() ? 0 : fault.size() - 2));
}

absl::Status AddRow(const ExtremeCase& extreme, const Subject& subject, const Bound& bound, double most_cpu_s,
                    const Progress& progress, v1::StabilityTable& table) {
  const auto outcome = RunCase(extreme, subject, most_cpu_s, progress);
  if (!outcome.ok()) return outcome.status();
  v1::ExtremeRow& row = *table.add_extremes();
  row.set_case_(extreme.name);
  row.set_integrator(NameOf(subject.parameters.integrator()));
  if (subject.parameters.step_tolerance() > 0) row.mutable_integrator()->append(", guarded");
  Judge(extreme, *subject.model, *outcome, bound, row);
  return absl::OkStatus();
}

void AddRefusal(const ExtremeCase& extreme, const absl::Status& why, v1::StabilityTable& table) {
  v1::ExtremeRow& row = *table.add_extremes();
  row.set_case_(extreme.name);
  row.set_integrator("any");
  row.set_finite(true);
  row.set_verdict(absl::IsInvalidArgument(why) ? "stopped" : "FAILED");
  row.set_note(absl::StrCat("refused: ", std::string(why.message())));
}

}  // namespace

absl::Status AddExtreme(const ExtremeCase& extreme, const v1::StabilityStudy& study, const Progress& progress,
                        v1::StabilityTable& table) {
  const auto subject = SubjectOf(extreme);
  if (!subject.ok()) {
    AddRefusal(extreme, subject.status(), table);
    return absl::OkStatus();
  }
  const auto bound = BoundOf(extreme, *subject, study.most_seconds_a_run(), progress);
  if (!bound.ok()) return bound.status();
  for (const v1::Integrator integrator : Chosen(study)) {
    for (const double tolerance : {0.0, kTolerance}) {
      Subject part = With(*subject, integrator);
      part.parameters.set_step_tolerance(tolerance);
      absl::Status status = AddRow(extreme, part, *bound, study.most_seconds_a_run(), progress, table);
      if (!status.ok()) return status;
    }
  }
  return absl::OkStatus();
}

absl::Status AddExtremes(const v1::StabilityStudy& study, const Progress& progress, v1::StabilityTable& table) {
  const std::vector<ExtremeCase> cases = ExtremeCases();
  const auto all = static_cast<double>(cases.size());
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto at = static_cast<double>(i);
    const Progress part = Part(progress, at / all, (at + 1) / all);
    const auto labelled = [&](double done, std::string_view) { return part(done, cases[i].name); };
    if (absl::Status status = AddExtreme(cases[i], study, labelled, table); !status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace phrenic::study
