#include "server/study/uncertainty/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "server/schema/fields.h"
#include "server/study/uncertainty/chaos.h"
#include "server/study/uncertainty/runs.h"
#include "server/study/uncertainty/step_choice.h"

namespace phrenic::study {
namespace {

// One sensitivity study while it runs.
class Sensitivity {
 public:
  Sensitivity(const v1::SensitivityStudy& study, const Subject& subject, std::vector<Input> inputs,
              const Outputs& outputs, const Progress& progress)
      : study_(study), subject_(subject), inputs_(std::move(inputs)), outputs_(outputs), progress_(progress) {}

  absl::StatusOr<v1::SensitivityTable> Run() {
    if (absl::Status status = CheckSize(); !status.ok()) return status;
    *table_.mutable_inputs() = InputRows(inputs_, subject_.parameters);
    for (const auto& part : {&Sensitivity::Screen, &Sensitivity::Expand, &Sensitivity::Sample}) {
      if (absl::Status status = (this->*part)(); !status.ok()) return status;
    }
    table_.set_advice(Advice());
    return std::move(table_);
  }

 private:
  int Inputs() const { return static_cast<int>(inputs_.size()); }
  int InputsKept() const {
    return study_.kept() > 0 && study_.trajectories() > 0 ? std::min(study_.kept(), Inputs()) : Inputs();
  }
  double ScreeningRuns() const { return static_cast<double>(study_.trajectories()) * (Inputs() + 1); }
  double ChaosRuns() const {
    return study_.degree() > 0 ? std::ceil(study_.oversampling() * CountTerms(InputsKept(), study_.degree())) + 1 : 0;
  }
  double SaltelliRuns() const { return static_cast<double>(study_.samples()) * (InputsKept() + 2); }
  double AllRuns() const { return ScreeningRuns() + ChaosRuns() + SaltelliRuns(); }

  absl::Status CheckSize() const {
    if (AllRuns() == 0) {
      return absl::InvalidArgumentError("trajectories, degree and samples are 0: one of them must be more");
    }
    if (study_.degree() > 0 && CountTerms(InputsKept(), study_.degree()) > kMostTerms) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "degree: %d of %d inputs are %.4g coefficients, more than %.4g: lower it, or keep fewer inputs",
          study_.degree(), InputsKept(), CountTerms(InputsKept(), study_.degree()), kMostTerms));
    }
    return CheckRuns(AllRuns(), outputs_.NumbersPerRun());
  }

  absl::StatusOr<RunSet> RunPoints(const UnitPoints& points, const std::string& doing) {
    const double from = done_ / AllRuns();
    done_ += static_cast<double>(points.rows());
    auto runs = RunAt(outputs_, inputs_, subject_.parameters, points, study_.threads(), doing,
                      Part(progress_, from, done_ / AllRuns()));
    if (!runs.ok()) return runs.status();
    table_.set_runs(table_.runs() + points.rows());
    table_.set_failed(table_.failed() + runs->CountFailed());
    if (table_.problem().empty()) table_.set_problem(runs->FirstProblem());
    return runs;
  }

  absl::Status Screen() {
    if (study_.trajectories() == 0) return absl::OkStatus();
    const UnitPoints points = MorrisPoints(study_.trajectories(), Inputs(), static_cast<std::uint64_t>(study_.seed()));
    const auto runs = RunPoints(points, "screening");
    if (!runs.ok()) return runs.status();
    std::vector<double> largest(inputs_.size(), 0);  // share of any output
    for (size_t k = 0; k < outputs_.outputs().size(); ++k) {
      AddScreening(outputs_.outputs()[k], ElementaryEffects(points, runs->ValuesOf(k)), largest);
    }
    Keep(largest);
    return absl::OkStatus();
  }

  void AddScreening(const Output& output, const std::vector<Effects>& effects, std::vector<double>& largest) {
    double most = 0;
    for (const Effects& each : effects) most = std::max(most, each.mean_size);
    for (size_t i = 0; i < effects.size(); ++i) {
      v1::ScreeningRow& row = *table_.add_screening();
      row.set_output(output.name);
      row.set_unit(output.unit);
      row.set_input(inputs_[i].varied.field->name());
      if (effects[i].count == 0) continue;
      row.set_mean_effect(effects[i].mean);
      row.set_mean_size(effects[i].mean_size);
      row.set_deviation(effects[i].deviation);
      const double share = most > 0 ? effects[i].mean_size / most : 0;
      row.set_share(share);
      largest[i] = std::max(largest[i], share);
    }
  }

  // Keeps the inputs with the largest shares, in their order; of equal ones the first.
  void Keep(const std::vector<double>& largest) {
    std::vector<size_t> order(inputs_.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return largest[a] > largest[b]; });
    order.resize(static_cast<size_t>(InputsKept()));
    std::sort(order.begin(), order.end());
    std::vector<Input> kept;
    std::set<std::string> names;
    for (const size_t i : order) {
      names.insert(inputs_[i].varied.field->name());
      kept.push_back(inputs_[i]);
    }
    for (v1::ScreeningRow& row : *table_.mutable_screening()) row.set_kept(names.contains(row.input()));
    inputs_ = std::move(kept);
  }

  absl::Status Expand() {
    if (study_.degree() == 0) return absl::OkStatus();
    const UnitPoints points =
        SobolPoints(static_cast<Eigen::Index>(ChaosRuns()), Inputs(), static_cast<std::uint64_t>(study_.seed()));
    const auto runs = RunPoints(points, "polynomial chaos");
    if (!runs.ok()) return runs.status();
    for (size_t k = 0; k < outputs_.outputs().size(); ++k) {
      const ChaosFit fit = FitChaos(points, runs->ValuesOf(k), study_.degree());
      AddFit(outputs_.outputs()[k], fit);
      AddIndices(outputs_.outputs()[k].name, "chaos", fit.indices);
    }
    return absl::OkStatus();
  }

  void AddFit(const Output& output, const ChaosFit& fit) {
    v1::FitRow& row = *table_.add_fits();
    row.set_output(output.name);
    row.set_unit(output.unit);
    row.set_terms(fit.terms);
    row.set_runs(fit.runs);
    if (fit.terms == 0) return;
    row.set_mean(fit.mean);
    row.set_deviation(fit.deviation);
    if (!fit.indices.empty()) row.set_predicted_share(fit.predicted_share);
  }

  absl::Status Sample() {
    if (study_.samples() == 0) return absl::OkStatus();
    const auto seed = static_cast<std::uint64_t>(study_.seed());
    const auto runs = RunPoints(SaltelliPoints(study_.samples(), Inputs(), seed), "Saltelli's sampling");
    if (!runs.ok()) return runs.status();
    for (size_t k = 0; k < outputs_.outputs().size(); ++k) {
      AddIndices(outputs_.outputs()[k].name, "saltelli", SobolIndices(runs->ValuesOf(k), Inputs(), seed));
    }
    return absl::OkStatus();
  }

  void AddIndices(const std::string& output, const char* method, const std::vector<SobolIndex>& indices) {
    for (size_t i = 0; i < inputs_.size(); ++i) {
      v1::IndexRow& row = *table_.add_indices();
      row.set_output(output);
      row.set_input(inputs_[i].varied.field->name());
      row.set_method(method);
      if (indices.empty()) continue;
      row.set_first(indices[i].first);
      row.set_total(indices[i].total);
      if (!indices[i].first_within) continue;
      row.set_first_low(indices[i].first_within->low);
      row.set_first_high(indices[i].first_within->high);
      row.set_total_low(indices[i].total_within->low);
      row.set_total_high(indices[i].total_within->high);
    }
  }

  // The most important input of each output, by total index; by screening if there are no indices.
  std::string Advice() const {
    std::vector<std::string> sentences;
    for (const Output& output : outputs_.outputs()) {
      const v1::IndexRow* most = nullptr;
      for (const v1::IndexRow& row : table_.indices()) {
        if (row.output() != output.name || !row.has_total()) continue;
        if (most == nullptr || row.total() > most->total()) most = &row;
      }
      if (most != nullptr) {
        sentences.push_back(absl::StrFormat("%s: %s takes part in %.0f %% of the variance", output.name, most->input(),
                                            100 * most->total()));
        continue;
      }
      for (const v1::ScreeningRow& row : table_.screening()) {
        if (row.output() != output.name || row.share() < 1) continue;
        sentences.push_back(absl::StrFormat("%s: %s has the largest effect", output.name, row.input()));
        break;
      }
    }
    return sentences.empty() ? "No output depends on an input." : absl::StrCat(absl::StrJoin(sentences, "; "), ".");
  }

  const v1::SensitivityStudy& study_;
  const Subject& subject_;
  std::vector<Input> inputs_;  // after screening: those kept
  const Outputs& outputs_;
  const Progress& progress_;
  v1::SensitivityTable table_;
  double done_ = 0;  // runs
};

}  // namespace

absl::StatusOr<v1::SensitivityTable> StudySensitivity(const v1::CreateStudyRequest& request, const Subject& subject,
                                                      const Progress& progress) {
  const v1::SensitivityStudy& study = request.sensitivity();
  auto inputs = MakeInputs(study.inputs());
  if (!inputs.ok()) return inputs.status();
  const auto outputs =
      Outputs::Make(*subject.model, study.outputs(),
                    study.has_seconds() ? std::optional(study.seconds()) : std::nullopt, ChoosesStep(request, subject));
  if (!outputs.ok()) return outputs.status();
  return Sensitivity(study, subject, *std::move(inputs), **outputs, progress).Run();
}

}  // namespace phrenic::study
