#include "server/study/uncertainty/uncertainty.h"

#include <cmath>

#include "server/study/uncertainty/percentiles.h"
#include "server/study/uncertainty/runs.h"
#include "server/study/uncertainty/step_choice.h"

namespace phrenic::study {
namespace {

std::vector<double> FiniteOf(std::vector<double> values) {
  std::erase_if(values, [](double each) { return !std::isfinite(each); });
  return values;
}

void FillBand(const std::vector<double>& values, v1::BandRow& row) {
  if (values.empty()) return;
  double sum = 0;
  for (const double each : values) sum += each;
  row.set_mean(sum / static_cast<double>(values.size()));
  row.set_deviation(DeviationOf(values));
  row.set_p025(Percentile(values, 2.5));
  row.set_p5(Percentile(values, 5));
  row.set_p25(Percentile(values, 25));
  row.set_p50(Percentile(values, 50));
  row.set_p75(Percentile(values, 75));
  row.set_p95(Percentile(values, 95));
  row.set_p975(Percentile(values, 97.5));
}

void AddBand(const Output& output, double nominal, std::vector<double> values, v1::UncertaintyTable& table) {
  values = FiniteOf(std::move(values));
  v1::BandRow& row = *table.add_bands();
  row.set_output(output.name);
  row.set_unit(output.unit);
  if (std::isfinite(nominal)) row.set_nominal(nominal);
  FillBand(values, row);
  v1::SampledOutput& sample = *table.add_samples();
  sample.set_output(output.name);
  sample.set_unit(output.unit);
  sample.mutable_values()->Add(values.begin(), values.end());
}

void AddBandCurve(const Measure& measure, size_t index, const RunSet& runs, v1::UncertaintyTable& table) {
  v1::BandCurve& curve = *table.add_curves();
  curve.set_measure(measure.name());
  curve.set_unit(measure.unit());
  for (int k = 0; k < kPhases; ++k) {
    std::vector<double> values;
    for (const RunOutputs& run : runs.each) {
      if (!run.curves.empty()) values.push_back(run.curves[index][static_cast<size_t>(k)]);
    }
    values = FiniteOf(std::move(values));
    if (values.empty()) continue;
    curve.add_phase(static_cast<double>(k) / (kPhases - 1));
    curve.add_p5(Percentile(values, 5));
    curve.add_p50(Percentile(values, 50));
    curve.add_p95(Percentile(values, 95));
  }
}

}  // namespace

absl::StatusOr<v1::UncertaintyTable> StudyUncertainty(const v1::CreateStudyRequest& request, const Subject& subject,
                                                      const Progress& progress) {
  const v1::UncertaintyStudy& study = request.uncertainty();
  const auto inputs = MakeInputs(study.inputs());
  if (!inputs.ok()) return inputs.status();
  const auto outputs =
      Outputs::Make(*subject.model, study.outputs(),
                    study.has_seconds() ? std::optional(study.seconds()) : std::nullopt, ChoosesStep(request, subject));
  if (!outputs.ok()) return outputs.status();
  if (absl::Status size = CheckRuns(study.samples(), (*outputs)->NumbersPerRun()); !size.ok()) return size;
  const double nominal_part = 1.0 / (study.samples() + 1);
  const auto nominal = RunAll(**outputs, {&subject.parameters, 1}, 1, "nominal", Part(progress, 0, nominal_part));
  if (!nominal.ok()) return nominal.status();
  const UnitPoints points =
      SobolPoints(study.samples(), static_cast<Eigen::Index>(inputs->size()), static_cast<std::uint64_t>(study.seed()));
  const auto runs = RunAt(**outputs, *inputs, subject.parameters, points, study.threads(), "sampling",
                          Part(progress, nominal_part, 1));
  if (!runs.ok()) return runs.status();
  v1::UncertaintyTable table;
  *table.mutable_inputs() = InputRows(*inputs, subject.parameters);
  for (size_t k = 0; k < (*outputs)->outputs().size(); ++k) {
    AddBand((*outputs)->outputs()[k], nominal->each.front().values[k], runs->ValuesOf(k), table);
  }
  for (size_t i = 0; i < subject.model->measures.size(); ++i) {
    AddBandCurve(*subject.model->measures[i], i, *runs, table);
  }
  table.set_runs(points.rows() + 1);
  table.set_failed(runs->CountFailed() + nominal->CountFailed());
  table.set_problem(runs->FirstProblem().empty() ? nominal->FirstProblem() : runs->FirstProblem());
  return table;
}

}  // namespace phrenic::study
