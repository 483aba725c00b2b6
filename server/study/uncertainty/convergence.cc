#include "server/study/uncertainty/convergence.h"

#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/schema/fields.h"
#include "server/study/subject.h"
#include "server/study/uncertainty/runs.h"

namespace phrenic::study {
namespace {

constexpr int kMostResolutions = 16;

struct ConvergenceVariant {
  std::string varied, to;
  v1::Parameters parameters;
};

// INVALID_ARGUMENT if an integrator or a resolution is named twice, or for more than kMostResolutions.
absl::Status CheckVariants(const v1::ConvergenceStudy& study) {
  const std::set<int> integrators(study.integrators().begin(), study.integrators().end());
  if (static_cast<int>(integrators.size()) < study.integrators_size()) {
    return absl::InvalidArgumentError("integrators: one is named twice");
  }
  const std::set<double> resolutions(study.resolutions_mm().begin(), study.resolutions_mm().end());
  if (static_cast<int>(resolutions.size()) < study.resolutions_mm_size()) {
    return absl::InvalidArgumentError("resolutions_mm: one is named twice");
  }
  if (study.resolutions_mm_size() <= kMostResolutions) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("resolutions_mm: at most ", kMostResolutions));
}

std::vector<ConvergenceVariant> VariantsOf(const v1::ConvergenceStudy& study, const Subject& subject) {
  std::vector<ConvergenceVariant> variants = {{"as it is", "", subject.parameters}};
  for (int i = 1; i <= study.halvings(); ++i) {
    v1::Parameters parameters = subject.parameters;
    parameters.set_time_step(std::ldexp(subject.parameters.time_step(), -i));
    variants.push_back({"time step", absl::StrFormat("%.4g ms", 1e3 * parameters.time_step()), parameters});
  }
  for (const int kind : study.integrators()) {
    const auto integrator = static_cast<v1::Integrator>(kind);
    variants.push_back({"integrator", NameOf(integrator), With(subject, integrator).parameters});
  }
  return variants;
}

// Adds one row per output. `base` has the values of the scene as it is.
void AddConvergenceRows(const ConvergenceVariant& variant, const Outputs& outputs, const RunOutputs& run,
                        const RunOutputs& base, v1::ConvergenceTable& table) {
  for (size_t k = 0; k < outputs.outputs().size(); ++k) {
    v1::ConvergenceRow& row = *table.add_rows();
    row.set_varied(variant.varied);
    row.set_to(variant.to);
    row.set_output(outputs.outputs()[k].name);
    row.set_unit(outputs.outputs()[k].unit);
    if (!std::isfinite(run.values[k])) continue;
    row.set_value(run.values[k]);
    if (!std::isfinite(base.values[k]) || base.values[k] == 0) continue;
    row.set_change_percent(100 * (run.values[k] - base.values[k]) / std::abs(base.values[k]));
  }
}

void CountConvergenceRun(const RunOutputs& run, v1::ConvergenceTable& table) {
  table.set_runs(table.runs() + 1);
  if (run.problem.empty()) return;
  table.set_failed(table.failed() + 1);
  if (table.problem().empty()) table.set_problem(run.problem);
}

// Sets the order of the last time step from the last three. Requires: the runs of the steps come first.
void SetStepOrders(const RunSet& runs, int halvings, v1::ConvergenceTable& table) {
  if (halvings < 2) return;
  const auto last = static_cast<size_t>(halvings);
  const size_t outputs = runs.each.front().values.size();
  for (size_t k = 0; k < outputs; ++k) {
    const double fine = runs.each[last].values[k], middle = runs.each[last - 1].values[k];
    const double order = std::log2(std::abs((middle - runs.each[last - 2].values[k]) / (fine - middle)));
    if (std::isfinite(order)) table.mutable_rows(static_cast<int>(last * outputs + k))->set_order(order);
  }
}

std::optional<double> SecondsOf(const v1::ConvergenceStudy& study) {
  return study.has_seconds() ? std::optional(study.seconds()) : std::nullopt;
}

// Runs the scene with generated bodies of another resolution.
absl::Status AddResolution(const v1::CreateStudyRequest& request, double resolution_mm, const Compiler& compile,
                           const RunOutputs& base, const Progress& progress, v1::ConvergenceTable& table) {
  const ConvergenceVariant variant{"mesh", absl::StrCat(schema::FormatNumber(resolution_mm), " mm"), {}};
  if (!progress(0, "compiling at " + variant.to)) return Cancelled();
  v1::SceneSource source = request.source();
  source.set_resolution_mm(resolution_mm);
  const auto subject = MakeSubject(source, request.preset(), request.parameters(), compile);
  if (!subject.ok()) return subject.status();
  const auto outputs =
      Outputs::Make(*subject->model, request.convergence().outputs(), SecondsOf(request.convergence()), false);
  if (!outputs.ok()) return outputs.status();
  const auto runs = RunAll(**outputs, {&subject->parameters, 1}, 1, "at " + variant.to, progress);
  if (!runs.ok()) return runs.status();
  AddConvergenceRows(variant, **outputs, runs->each.front(), base, table);
  CountConvergenceRun(runs->each.front(), table);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<v1::ConvergenceTable> StudyConvergence(const v1::CreateStudyRequest& request, const Subject& subject,
                                                      const Compiler& compile, const Progress& progress) {
  const v1::ConvergenceStudy& study = request.convergence();
  if (absl::Status status = CheckVariants(study); !status.ok()) return status;
  const auto outputs = Outputs::Make(*subject.model, study.outputs(), SecondsOf(study), false);
  if (!outputs.ok()) return outputs.status();
  const std::vector<ConvergenceVariant> variants = VariantsOf(study, subject);
  std::vector<v1::Parameters> parameters;
  parameters.reserve(variants.size());
  for (const ConvergenceVariant& variant : variants) parameters.push_back(variant.parameters);
  const auto meshes = static_cast<double>(study.resolutions_mm_size()), of = static_cast<double>(variants.size());
  const auto runs =
      RunAll(**outputs, parameters, study.threads(), "steps and integrators", Part(progress, 0, of / (of + meshes)));
  if (!runs.ok()) return runs.status();
  v1::ConvergenceTable table;
  for (size_t i = 0; i < variants.size(); ++i) {
    AddConvergenceRows(variants[i], **outputs, runs->each[i], runs->each.front(), table);
    CountConvergenceRun(runs->each[i], table);
  }
  SetStepOrders(*runs, study.halvings(), table);
  for (int i = 0; i < study.resolutions_mm_size(); ++i) {
    const Progress part = Part(progress, (of + i) / (of + meshes), (of + i + 1) / (of + meshes));
    absl::Status status = AddResolution(request, study.resolutions_mm(i), compile, runs->each.front(), part, table);
    if (absl::IsCancelled(status)) return status;
    if (!status.ok()) CountConvergenceRun({{}, {}, std::string(status.message())}, table);
  }
  return table;
}

}  // namespace phrenic::study
