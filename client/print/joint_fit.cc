#include "client/print/joint_fit.h"

#include <cmath>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/print/motion_fit.h"
#include "client/print/table.h"

namespace phrenic::client {
namespace {

using JointJson = nlohmann::json;

// Six digits behind the point; null if it is not finite.
JointJson RoundedNumber(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(1e6 * value) / 1e6;
}

std::string Shown(double value) { return std::isfinite(value) ? absl::StrFormat("%.3g", value) : "-"; }

JointJson QuantityJson(const fit::FittedQuantity& each) {
  const double unit = each.number.per_unit;
  JointJson made = {{"name", each.number.name},
                    {"what", each.number.what},
                    {"unit", each.number.unit},
                    {"value", RoundedNumber(each.value / unit)},
                    {"standard_error", RoundedNumber(each.standard_error / unit)},
                    {"prior", RoundedNumber(each.number.mean / unit)},
                    {"prior_sd", RoundedNumber(each.number.sd / unit)},
                    {"determined", each.determined}};
  if (!std::isfinite(each.number.low)) return made;
  made["low"] = RoundedNumber(each.number.low / unit);
  made["high"] = RoundedNumber(each.number.high / unit);
  made["at_bound"] = each.at_bound;
  return made;
}

JointJson QuantitiesJson(const std::vector<fit::FittedQuantity>& quantities) {
  JointJson list = JointJson::array();
  for (const fit::FittedQuantity& each : quantities) list.push_back(QuantityJson(each));
  return list;
}

JointJson KindsJson(const std::vector<fit::KindReport>& kinds) {
  JointJson list = JointJson::array();
  for (const fit::KindReport& each : kinds) {
    const double unit = each.kind.per_unit;
    JointJson kind = {{"kind", each.kind.kind},
                      {"source", each.kind.source},
                      {"unit", each.kind.unit},
                      {"error", RoundedNumber(each.kind.sd / unit)},
                      {"data", each.fitting},
                      {"rms_still", RoundedNumber(each.still / unit)},
                      {"rms_before", RoundedNumber(each.before / unit)},
                      {"rms_after", RoundedNumber(each.after / unit)},
                      {"held_out", each.held_out}};
    if (each.held_out > 0) {
      kind["held_out_rms_still"] = RoundedNumber(each.held_out_still / unit);
      kind["held_out_rms"] = RoundedNumber(each.held_out_after / unit);
    }
    list.push_back(kind);
  }
  return list;
}

Table QuantityTable(const std::vector<fit::FittedQuantity>& quantities) {
  Table table({"number", "value", "unit", "standard error", "before", "its sd", "determined", "what"});
  for (const fit::FittedQuantity& each : quantities) {
    const double unit = each.number.per_unit;
    table.Add({each.number.name, Shown(each.value / unit), each.number.unit, Shown(each.standard_error / unit),
               Shown(each.number.mean / unit), Shown(each.number.sd / unit),
               each.at_bound     ? "AT ITS BOUND"
               : each.determined ? "yes"
                                 : "NO",
               each.number.what});
  }
  return table;
}

Table KindTable(const std::vector<fit::KindReport>& kinds) {
  Table table({"kind", "file", "data", "error", "unit", "rms at rest", "rms before", "rms after", "held out",
               "their rms at rest", "their rms"});
  for (const fit::KindReport& each : kinds) {
    const double unit = each.kind.per_unit;
    table.Add({each.kind.kind, each.kind.source, absl::StrCat(each.fitting), Shown(each.kind.sd / unit), each.kind.unit,
               Shown(each.still / unit), Shown(each.before / unit), Shown(each.after / unit),
               each.held_out > 0 ? absl::StrCat(each.held_out) : "-", Shown(each.held_out_still / unit),
               Shown(each.held_out_after / unit)});
  }
  return table;
}

void AddRows(const char* kind, const std::vector<fit::FittedQuantity>& quantities, Table& rows) {
  for (const fit::FittedQuantity& each : quantities) {
    const double unit = each.number.per_unit;
    rows.Add({kind, each.number.name, each.number.unit, "", Shown(each.value / unit), Shown(each.standard_error / unit),
              Shown(each.number.mean / unit), Shown(each.number.sd / unit), "", "", "", ""});
  }
}

}  // namespace

nlohmann::json FittedJson(const std::vector<fit::FittedQuantity>& numbers,
                          const std::vector<fit::FittedQuantity>& derived, const std::vector<fit::KindReport>& kinds) {
  return {{"fitted", QuantitiesJson(numbers)}, {"derived", QuantitiesJson(derived)}, {"kinds", KindsJson(kinds)}};
}

void PrintFitted(const std::vector<fit::FittedQuantity>& numbers, const std::vector<fit::FittedQuantity>& derived,
                 const std::vector<fit::KindReport>& kinds) {
  QuantityTable(numbers).Print(std::cout);
  std::cout << "\nwhat follows from them:\n";
  QuantityTable(derived).Print(std::cout);
  std::cout << "\nhow well the data are met, root mean squares:\n";
  KindTable(kinds).Print(std::cout);
}

nlohmann::json JointFitJson(const fit::JointFit& fit, const fit::FitOptions& options) {
  JointJson result = FitJson(fit.motion, options);
  for (const char* name : {"held_out_mean_mm", "held_out_p95_mm", "fitting_mean_mm"}) {
    if (result[name].is_number() && !std::isfinite(result[name].get<double>())) result[name] = nullptr;
  }
  result.update(FittedJson(fit.numbers, fit.derived, fit.kinds));
  result["own_lungs"] = fit.own_lungs;
  return result;
}

void PrintJointFit(const fit::JointFit& fit, const fit::FitOptions& options) {
  if (fit.own_lungs) PrintRegistration(fit.motion.registered);
  PrintFitted(fit.numbers, fit.derived, fit.kinds);
  if (fit.motion.baselines.empty()) return;
  std::cout << "\nlandmarks at end inhale that were not fitted:\n";
  PrintErrors(fit.motion);
  std::cout << absl::StrFormat("held out: %d of %d landmarks (split %d)\n", fit.motion.halves.held_out.size(),
                               fit.motion.exhale.cols(), options.split);
}

void PrintFittedCsv(const std::vector<fit::FittedQuantity>& numbers, const std::vector<fit::FittedQuantity>& derived,
                    const std::vector<fit::KindReport>& kinds, const std::vector<fit::Baseline>& baselines) {
  Table rows({"kind", "name", "unit", "data", "value", "standard_error", "prior", "prior_sd", "still", "before",
              "after", "held_out"});
  AddRows("fitted", numbers, rows);
  AddRows("derived", derived, rows);
  for (const fit::KindReport& each : kinds) {
    const double unit = each.kind.per_unit;
    rows.Add({"data", each.kind.kind, each.kind.unit, absl::StrCat(each.fitting), "", Shown(each.kind.sd / unit), "",
              "", Shown(each.still / unit), Shown(each.before / unit), Shown(each.after / unit),
              Shown(each.held_out_after / unit)});
  }
  for (const fit::Baseline& each : baselines) {
    rows.Add({"baseline", each.name, "mm", "", "", "", "", "", "", "", "", Shown(1000 * each.held_out.mean)});
  }
  rows.PrintCsv(std::cout);
}

void PrintJointFitCsv(const fit::JointFit& fit) {
  PrintFittedCsv(fit.numbers, fit.derived, fit.kinds, fit.motion.baselines);
}

}  // namespace phrenic::client
