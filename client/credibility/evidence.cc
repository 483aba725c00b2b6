#include "client/credibility/evidence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/integrators/catalogue.h"
#include "server/physiology/rows.h"
#include "server/schema/fields.h"

namespace phrenic::client {
namespace {

constexpr double kOrderSlack = 0.2;
constexpr size_t kMostExactCases = 100'000;

// Collects numbers of one source and command.
class NumberList {
 public:
  explicit NumberList(std::vector<v1::NumberRow>& rows) : rows_(rows) {}

  void Begin(std::string source, std::string command) { source_ = std::move(source), command_ = std::move(command); }
  void Add(const std::string& name, std::optional<double> value, const std::string& unit, const std::string& what) {
    v1::NumberRow& row = rows_.emplace_back();
    row.set_name(name);
    if (value && std::isfinite(*value)) row.set_value(*value);
    row.set_unit(unit);
    row.set_what(what);
    row.set_source(source_);
    row.set_command(command_);
  }

 private:
  std::vector<v1::NumberRow>& rows_;
  std::string source_, command_;
};

std::optional<double> PercentOf(double part, double whole) {
  return whole > 0 ? std::optional(100 * part / whole) : std::nullopt;
}

template <typename Rows>
void AddPassed(const std::string& kind, const std::string& count, const Rows& rows, NumberList& list) {
  double judged = 0, passed = 0;
  for (const auto& row : rows) {
    judged += row.verdict() == "pass" || row.verdict() == "FAILED" ? 1 : 0;
    passed += row.verdict() == "pass" ? 1 : 0;
  }
  list.Add(absl::StrCat(kind, ".", count), judged, "1", "judged");
  list.Add(absl::StrCat(kind, ".passed_percent"), PercentOf(passed, judged), "%", "of those judged, passed");
}

void AddPhysiology(const v1::PhysiologyTable& table, NumberList& list) {
  std::set<std::pair<std::string, std::string>> changes;
  for (const physiology::Row& row : physiology::RowsOfChanges()) changes.emplace(row.breath, row.what);
  double judged[2] = {0, 0}, inside[2] = {0, 0};
  for (const v1::PhysiologyRow& row : table.rows()) {
    const bool measured = row.verdict() != v1::VERDICT_NOT_MODELLED;
    list.Add(absl::StrCat("physiology.", row.breath(), ": ", row.what()),
             measured ? std::optional(row.value()) : std::nullopt, row.unit(), row.what());
    if (row.verdict() != v1::VERDICT_INSIDE && row.verdict() != v1::VERDICT_OUTSIDE) continue;
    const bool changed = changes.contains({row.breath(), row.what()});
    judged[changed] += 1;
    inside[changed] += row.verdict() == v1::VERDICT_INSIDE ? 1 : 0;
  }
  list.Add("physiology.health.inside_percent", PercentOf(inside[0], judged[0]), "%",
           absl::StrFormat("%g of %g measures of healthy breaths inside their published ranges", inside[0], judged[0]));
  list.Add("physiology.changes.inside_percent", PercentOf(inside[1], judged[1]), "%",
           absl::StrFormat("%g of %g effects of a changed cause inside their ranges", inside[1], judged[1]));
}

// The row of each output at the last variant of a kind: the finest step.
void AddConvergence(const v1::ConvergenceTable& table, NumberList& list) {
  for (const auto& [varied, name] :
       {std::pair{"time step", "time_step"}, {"mesh", "mesh"}, {"integrator", "integrator"}}) {
    std::map<std::string, double> last;
    bool missing = false;
    for (const v1::ConvergenceRow& row : table.rows()) {
      if (row.varied() != varied) continue;
      missing |= !row.has_change_percent();
      if (row.varied() == "time step") {
        last[row.output()] = std::abs(row.change_percent());
      } else {
        last[row.output()] = std::max(last[row.output()], std::abs(row.change_percent()));
      }
    }
    double largest = 0;
    for (const auto& [output, change] : last) largest = std::max(largest, change);
    list.Add(absl::StrCat("convergence.", name, "_percent"),
             last.empty() || missing ? std::nullopt : std::optional(largest), "%",
             absl::StrCat("largest change of an output with another ", varied));
  }
  list.Add("convergence.failed", static_cast<double>(table.failed()), "1", "runs that failed");
}

void AddSensitivity(const v1::SensitivityTable& table, NumberList& list) {
  list.Add("sensitivity.failed", static_cast<double>(table.failed()), "1", "runs that failed");
  double least = 1;
  bool all = table.fits_size() > 0;
  for (const v1::FitRow& row : table.fits()) {
    all &= row.has_predicted_share();
    least = std::min(least, row.predicted_share());
    list.Add(absl::StrCat("sensitivity.", row.output(), ".predicted_percent"),
             row.has_predicted_share() ? std::optional(100 * row.predicted_share()) : std::nullopt, "%",
             "of the variance, predicted of runs that were left out");
  }
  list.Add("sensitivity.least_predicted_percent", all ? std::optional(100 * least) : std::nullopt, "%",
           "the same, of the output that is predicted least");
  for (const v1::IndexRow& row : table.indices()) {
    list.Add(absl::StrCat("sensitivity.", row.output(), ".", row.input(), ".total_percent"),
             row.has_total() ? std::optional(100 * row.total()) : std::nullopt, "%",
             absl::StrCat("total Sobol index by ", row.method()));
  }
}

void AddUncertainty(const v1::UncertaintyTable& table, NumberList& list) {
  list.Add("uncertainty.failed", static_cast<double>(table.failed()), "1", "runs that failed");
  for (const v1::BandRow& row : table.bands()) {
    const std::string name = absl::StrCat("uncertainty.", row.output());
    const auto given = [&](double value) { return row.has_p50() ? std::optional(value) : std::nullopt; };
    list.Add(name + ".p5", given(row.p5()), row.unit(), "5 % of the runs are below");
    list.Add(name + ".p50", given(row.p50()), row.unit(), "median of the runs");
    list.Add(name + ".p95", given(row.p95()), row.unit(), "5 % of the runs are above");
    list.Add(name + ".width_percent", given(100 * (row.p95() - row.p5()) / std::abs(row.p50())), "%",
             "width of the band from 5 to 95 %, of the median");
  }
}

double OrderOf(const std::string& integrator) {
  const auto* value = schema::FindChoice(*v1::Integrator_descriptor(), integrator);
  if (value == nullptr || value->number() == v1::INTEGRATOR_UNSPECIFIED) return 0;
  return FindIntegrator(static_cast<v1::Integrator>(value->number())).order();
}

absl::Status NotResults(const std::string& file) {
  return absl::InvalidArgumentError(
      absl::StrCat(file, " is not the result of a GoogleTest: make it by build/exact_test --gtest_output=json:FILE"));
}

}  // namespace

std::vector<v1::NumberRow> NumbersOf(const Evidence& evidence, const EvidenceCommands& commands) {
  std::vector<v1::NumberRow> rows = evidence.numbers;
  NumberList list(rows);
  if (!evidence.exact_cases.empty()) {
    list.Begin("exact solutions and published benchmarks", commands.exact);
    AddPassed("exact", "cases", evidence.exact_cases, list);
  }
  if (!evidence.orders.empty()) {
    list.Begin("study error", commands.orders);
    AddPassed("orders", "judged", evidence.orders, list);
  }
  list.Begin("physiology", commands.physiology);
  if (evidence.physiology) AddPhysiology(*evidence.physiology, list);
  list.Begin("study convergence", commands.convergence);
  if (evidence.convergence) AddConvergence(*evidence.convergence, list);
  list.Begin("study sensitivity", commands.sensitivity);
  if (evidence.sensitivity) AddSensitivity(*evidence.sensitivity, list);
  list.Begin("study uncertainty", commands.uncertainty);
  if (evidence.uncertainty) AddUncertainty(*evidence.uncertainty, list);
  return rows;
}

absl::StatusOr<std::vector<v1::ExactCaseRow>> ParseExactCases(const std::string& file, const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("testsuites") || !json["testsuites"].is_array()) return NotResults(file);
  std::vector<v1::ExactCaseRow> rows;
  for (const auto& suite : json["testsuites"]) {
    if (!suite.is_object() || !suite.contains("testsuite") || !suite["testsuite"].is_array()) return NotResults(file);
    for (const auto& test : suite["testsuite"]) {
      const auto name = test.is_object() ? test.find("name") : test.end();
      if (!test.is_object() || name == test.end() || !name->is_string()) return NotResults(file);
      if (rows.size() == kMostExactCases) return NotResults(file);
      v1::ExactCaseRow& row = rows.emplace_back();
      if (suite.contains("name") && suite["name"].is_string()) row.set_suite(suite["name"].get<std::string>());
      row.set_case_(name->get<std::string>());
      const bool ran = test.contains("result") && test["result"] == "COMPLETED";  // GoogleTest's word
      row.set_verdict(!ran ? "skipped" : (test.contains("failures") ? "FAILED" : "pass"));
    }
  }
  if (rows.empty()) return NotResults(file);
  return rows;
}

std::vector<v1::OrderRow> OrdersOf(const v1::ErrorTable& table) {
  std::vector<v1::OrderRow> orders;
  std::map<std::string, size_t> place;
  for (const v1::ErrorRow& row : table.rows()) {
    if (OrderOf(row.integrator()) == 0) continue;  // skips integrators without a convergence order
    const auto [at, added] = place.emplace(row.integrator(), orders.size());
    if (added) {
      orders.emplace_back().set_integrator(row.integrator());
      orders.back().set_expected(OrderOf(row.integrator()));
      orders.back().set_verdict("not measured");
    }
    if (row.verdict() != "ok" || !row.has_order()) continue;
    v1::OrderRow& order = orders[at->second];
    order.set_measured(row.order());
    order.set_verdict(row.order() >= order.expected() - kOrderSlack ? "pass" : "FAILED");
  }
  return orders;
}

absl::StatusOr<double> NumberInJson(const std::string& file, const std::string& text, const std::string& pointer) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) return absl::InvalidArgumentError(absl::StrCat(file, " is not JSON"));
  if (pointer.empty() || pointer[0] != '/') {
    return absl::InvalidArgumentError(absl::StrCat("pointer: \"", pointer, "\" does not begin with \"/\": /mean_mm"));
  }
  try {
    const nlohmann::json& value = json.at(nlohmann::json::json_pointer(pointer));
    if (value.is_number() && std::isfinite(value.get<double>())) return value.get<double>();
  } catch (const nlohmann::json::exception&) {
    // The pointer is malformed, or names no value.
  }
  return absl::InvalidArgumentError(absl::StrCat(file, " has no number at ", pointer));
}

}  // namespace phrenic::client
