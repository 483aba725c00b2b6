#include "server/study/extremes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "server/mechanics/compile/compile.h"
#include "server/schema/schema.h"
#include "server/study/energy_balance.h"
#include "server/study/reference.h"
#include "server/study/subject.h"
#include "server/study/watched_run.h"

namespace phrenic::study {
namespace {

constexpr double kStepTolerance = 1e-6;       // of guarded runs [m]
constexpr double kMaxEnergyRatio = 1.1;       // kinetic energy over its sources
constexpr double kMaxBaselineErrors = 2;      // tolerated error, in errors of the baseline
constexpr double kNegligible = 0.05;          // tolerated error, in largest displacements
constexpr double kMinDisplacement = 1e-4;     // over the size of the scene: smaller displacements count as this
constexpr double kReferenceTolerance = 1e-8;  // [m]
constexpr long kMaxReferenceChecks = 20000;   // of Progress, one per 16 evaluations, for a reference solution
constexpr int kMoments = 5;

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

// A run with the quantities that it is judged by.
struct Outcome {
  WatchedRun run;
  double energy_ratio = 0;
  std::vector<State> states;  // at the moments that the run reached
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

// The reference solution; nullopt if the case does not use one or it costs too much.
std::optional<Trajectory> ReferenceOf(const ExtremeCase& extreme, const Subject& subject) {
  if (!extreme.criteria.error) return std::nullopt;
  long checks = 0;
  const Progress enough = [&checks](double, std::string_view) { return ++checks < kMaxReferenceChecks; };
  v1::Reference report;
  auto reference = SolveReferenceFrom(subject, StartOf(extreme, subject), Moments(extreme.seconds, kMoments),
                                      kReferenceTolerance, enough, report);
  if (!reference.ok()) return std::nullopt;
  return *std::move(reference);
}

double ErrorOf(const Model& model, const Outcome& outcome, const Trajectory& reference) {
  double squares = 0;
  for (size_t i = 0; i < reference.states.size(); ++i) {
    const double error = RmsDistance(model, outcome.states[i].x, reference.states[i].x);
    squares += error * error;
  }
  return std::sqrt(squares / static_cast<double>(reference.states.size()));
}

// RMS error over the largest displacement of the reference, which is bounded from below by the scene's size.
double RelativeError(const Model& model, const Outcome& outcome, const Trajectory& reference) {
  const double displacement =
      std::max(LargestDisplacement(model, reference), kMinDisplacement / kNegligible * model.size);
  return ErrorOf(model, outcome, reference) / displacement;
}

std::string RunName(const Subject& subject) {
  const std::string name = NameOf(subject.parameters.integrator());
  return subject.parameters.step_tolerance() > 0 ? absl::StrCat(name, ", guarded") : name;
}

// The subject with each integrator, without and with error control.
std::vector<Subject> Runs(const Subject& subject, const v1::StabilityStudy& study) {
  std::vector<Subject> runs;
  for (const v1::Integrator integrator : Chosen(study)) {
    for (const double tolerance : {0.0, kStepTolerance}) {
      runs.push_back(With(subject, integrator));
      runs.back().parameters.set_step_tolerance(tolerance);
    }
  }
  return runs;
}

// True if the error names time, vertex, force and remedy.
bool IsDiagnosed(const v1::Divergence& divergence) {
  return divergence.time() > 0 && !divergence.body().empty() && !divergence.force().empty() &&
         !divergence.remedy().empty();
}

void JudgeStop(const WatchedRun& run, v1::ExtremeRow& row) {
  row.set_verdict(IsDiagnosed(run.divergence) ? "stopped" : "FAILED");
  row.set_note(absl::StrFormat("%s at %.4g s, %s: %s", absl::IsAborted(run.status) ? "stopped" : "diverged",
                               run.divergence.time(), Where(run.divergence), run.divergence.remedy()));
}

// The criteria that a completed run violates.
std::vector<std::string> Faults(const std::optional<double>& error, double allowed, const v1::ExtremeRow& row) {
  std::vector<std::string> faults;
  if (!row.finite()) faults.emplace_back("not finite, without an error");
  if (!(row.energy_ratio() <= kMaxEnergyRatio)) faults.emplace_back("gains energy without a source");
  if (error && !(*error <= allowed)) {
    faults.push_back(absl::StrFormat("error of %.2g of the largest displacement, above %.2g", *error, allowed));
  }
  return faults;
}

void Judge(const ExtremeCase& extreme, const Model& model, const Outcome& outcome,
           const std::optional<Trajectory>& reference, double allowed, v1::ExtremeRow& row) {
  row.set_finite(outcome.run.last.x.allFinite() && outcome.run.last.v.allFinite());
  if (!outcome.run.status.ok()) {
    JudgeStop(outcome.run, row);
    return;
  }
  if (extreme.criteria.energy && outcome.energy_ratio > 0) row.set_energy_ratio(outcome.energy_ratio);
  std::optional<double> error;
  if (reference && outcome.states.size() == reference->states.size()) {
    error = RelativeError(model, outcome, *reference);
    row.set_error_rms_mm(1e3 * ErrorOf(model, outcome, *reference));
  }
  const std::vector<std::string> faults = Faults(error, allowed, row);
  row.set_verdict(faults.empty() ? "pass" : "FAILED");
  row.set_note(absl::StrJoin(faults, "; "));
  if (!outcome.run.cut || !faults.empty()) return;
  row.set_verdict("stopped");
  row.set_note(absl::StrFormat("out of time at %.4g s: raise most_seconds_a_run", outcome.run.simulated_s));
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

absl::StatusOr<Baselines> BaselineErrors(const v1::StabilityStudy& study, const Progress& progress) {
  const ExtremeCase usual = ExtremeCases().front();
  const auto subject = SubjectOf(usual);
  if (!subject.ok()) return subject.status();
  const auto reference = ReferenceOf(usual, *subject);
  if (!reference) return absl::InternalError("the baseline of the extreme cases has no reference solution");
  Baselines baselines;
  for (const Subject& part : Runs(*subject, study)) {
    const auto outcome = RunCase(usual, part, study.most_seconds_a_run(), progress);
    if (!outcome.ok()) return outcome.status();
    if (outcome->states.size() != reference->states.size()) continue;
    baselines[RunName(part)] = RelativeError(*subject->model, *outcome, *reference);
  }
  return baselines;
}

absl::Status AddExtreme(const ExtremeCase& extreme, const Baselines& baselines, const v1::StabilityStudy& study,
                        const Progress& progress, v1::StabilityTable& table) {
  const auto subject = SubjectOf(extreme);
  if (!subject.ok()) {
    AddRefusal(extreme, subject.status(), table);
    return absl::OkStatus();
  }
  const auto reference = ReferenceOf(extreme, *subject);
  for (const Subject& part : Runs(*subject, study)) {
    const auto outcome = RunCase(extreme, part, study.most_seconds_a_run(), progress);
    if (!outcome.ok()) return outcome.status();
    v1::ExtremeRow& row = *table.add_extremes();
    row.set_case_(extreme.name);
    row.set_integrator(RunName(part));
    const auto baseline = baselines.find(row.integrator());
    const double usual = baseline == baselines.end() ? 0 : baseline->second;
    Judge(extreme, *subject->model, *outcome, reference, std::max(kNegligible, kMaxBaselineErrors * usual), row);
  }
  return absl::OkStatus();
}

absl::Status AddExtremes(const v1::StabilityStudy& study, const Progress& progress, v1::StabilityTable& table) {
  const std::vector<ExtremeCase> cases = ExtremeCases();
  const auto baselines = BaselineErrors(study, Part(progress, 0, 0));
  if (!baselines.ok()) return baselines.status();
  const auto all = static_cast<double>(cases.size());
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto at = static_cast<double>(i);
    const Progress part = Part(progress, at / all, (at + 1) / all);
    const auto labelled = [&](double done, std::string_view) { return part(done, cases[i].name); };
    if (absl::Status status = AddExtreme(cases[i], *baselines, study, labelled, table); !status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace phrenic::study
