#include "client/print/comparison.h"

#include <cmath>
#include <functional>

#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/print/table.h"
#include "server/schema/fields.h"

namespace phrenic::client {
namespace {

using google::protobuf::FieldDescriptor;

std::vector<const FieldDescriptor*> Fields() {
  const auto* type = v1::SurfaceDistance::descriptor();
  std::vector<const FieldDescriptor*> fields;
  fields.reserve(static_cast<size_t>(type->field_count()));
  for (int i = 0; i < type->field_count(); ++i) fields.push_back(type->field(i));
  return fields;
}

// The fields with a quantity in the schema; the others are counts.
std::vector<const FieldDescriptor*> Measures() {
  std::vector<const FieldDescriptor*> measures = Fields();
  std::erase_if(measures, [](const FieldDescriptor* field) { return schema::QuantityOf(*field) == nullptr; });
  return measures;
}

bool MoreIsBetter(const FieldDescriptor& measure) { return measure.name() == "surface_dice"; }

double Number(const v1::SurfaceDistance& distance, const FieldDescriptor& field) {
  const auto& reflection = *distance.GetReflection();
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) return reflection.GetDouble(distance, &field);
  return static_cast<double>(reflection.GetInt64(distance, &field));
}

std::string Unit(const FieldDescriptor& field) {
  const v1::Quantity* quantity = schema::QuantityOf(field);
  return quantity == nullptr || quantity->unit() == "1" ? "" : quantity->unit();
}

std::string Cell(const v1::SurfaceDistance& distance, const FieldDescriptor& field) {
  const double number = Number(distance, field);
  if (std::isnan(number)) return "NaN";
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) return absl::StrFormat("%.4f", number);
  return absl::StrFormat("%.0f", number);
}

// One row per measure, one column per surface, followed by its baseline if it has one.
void PrintMeasures(const v1::ComparisonTable& comparison, std::ostream& out) {
  std::vector<std::string> header = {"measure", "unit"};
  std::vector<const v1::SurfaceDistance*> columns;
  for (const v1::ComparisonRow& row : comparison.rows()) {
    if (row.has_time()) continue;
    header.push_back(row.region().empty() ? "whole" : row.region());
    columns.push_back(&row.distance());
    if (!row.has_baseline()) continue;
    header.emplace_back("standing still");
    columns.push_back(&row.baseline());
  }
  Table table(header);
  for (const FieldDescriptor* field : Fields()) {
    std::vector<std::string> cells = {field->name(), Unit(*field)};
    for (const v1::SurfaceDistance* column : columns) cells.push_back(Cell(*column, *field));
    table.Add(cells);
  }
  table.Print(out);
}

void PrintTimes(const v1::ComparisonTable& comparison, std::ostream& out) {
  Table table({"time", "region", "hd_max", "hd95_max", "assd", "hd95_max standing still", "assd standing still"});
  for (const v1::ComparisonRow& row : comparison.rows()) {
    if (!row.has_time()) continue;
    std::vector<std::string> cells = {absl::StrFormat("%.3f", row.time()),
                                      row.region().empty() ? "whole" : row.region()};
    for (const double value : {row.distance().hd_max(), row.distance().hd95_max(), row.distance().assd()}) {
      cells.push_back(absl::StrFormat("%.4f", value));
    }
    for (const double value : {row.baseline().hd95_max(), row.baseline().assd()}) {
      cells.push_back(row.has_baseline() ? absl::StrFormat("%.4f", value) : "-");
    }
    table.Add(cells);
  }
  if (table.empty()) return;
  out << "\nat each time [s], in mm\n";
  table.Print(out);
}

void PrintState(const char* which, const v1::ComparedState& state, std::ostream& out) {
  out << absl::StrFormat("%s is %s of session %s at %.9g s, tick %d\n", which, state.body(), state.session_id(),
                         state.time(), state.tick());
}

}  // namespace

absl::StatusOr<std::vector<Limit>> ReadLimits(const std::vector<std::string>& texts) {
  std::vector<Limit> limits;
  for (const std::string& text : texts) {
    const std::vector<std::string> parts = absl::StrSplit(text, absl::MaxSplits('=', 1));
    Limit limit;
    std::vector<std::string> names;
    for (const FieldDescriptor* measure : Measures()) {
      names.push_back(measure->name());
      if (measure->name() == parts[0]) limit.measure = measure;
    }
    if (limit.measure == nullptr) {
      return absl::InvalidArgumentError(absl::StrFormat("--check %s: there is no measure \"%s\"; there are %s", text,
                                                        parts[0], absl::StrJoin(names, ", ")));
    }
    if (parts.size() < 2 || !absl::SimpleAtod(parts[1], &limit.value) || !std::isfinite(limit.value)) {
      return absl::InvalidArgumentError(absl::StrFormat("--check %s: write measure=number, such as hd95_max=2", text));
    }
    limits.push_back(limit);
  }
  return limits;
}

std::vector<std::string> MissedLimits(const v1::ComparisonTable& table, const std::vector<Limit>& limits) {
  std::vector<std::string> missed;
  for (const Limit& limit : limits) {
    const double value = table.rows().empty() ? NAN : Number(table.rows(0).distance(), *limit.measure);
    const bool least = MoreIsBetter(*limit.measure);
    if (least ? value >= limit.value : value <= limit.value) continue;
    missed.push_back(absl::StrFormat("%s is %.4g%s; the limit is at %s %g", limit.measure->name(), value,
                                     Unit(*limit.measure).empty() ? "" : " " + Unit(*limit.measure),
                                     least ? "least" : "most", limit.value));
  }
  return missed;
}

void PrintComparison(const v1::ComparisonTable& table, std::ostream& out) {
  out << table.a() << " (A) and " << table.b() << " (B), " << table.definition()
      << absl::StrFormat(", tolerance %g mm\n", table.tolerance_mm());
  if (table.has_state_a()) PrintState("A", table.state_a(), out);
  if (table.has_state_b()) PrintState("B", table.state_b(), out);
  PrintMeasures(table, out);
  PrintTimes(table, out);
  if (table.times_left_out() > 0) {
    out << absl::StrFormat("%d times of A are outside B's times and were left out\n", table.times_left_out());
  }
}

void PrintComparisonCsv(const v1::ComparisonTable& table, std::ostream& out) {
  bool baselines = false;
  for (const v1::ComparisonRow& row : table.rows()) baselines = baselines || row.has_baseline();
  std::vector<std::string> cells = {"region", "time"};
  for (const FieldDescriptor* field : Fields()) cells.push_back(field->name());
  for (const FieldDescriptor* field : Fields()) {
    if (baselines) cells.push_back("baseline_" + field->name());
  }
  PrintCsvLine(cells, out);
  for (const v1::ComparisonRow& row : table.rows()) {
    cells = {row.region(), row.has_time() ? absl::StrFormat("%.9g", row.time()) : ""};
    for (const FieldDescriptor* field : Fields()) {
      cells.push_back(absl::StrFormat("%.9g", Number(row.distance(), *field)));
    }
    for (const FieldDescriptor* field : Fields()) {
      if (baselines) cells.push_back(absl::StrFormat("%.9g", Number(row.baseline(), *field)));
    }
    PrintCsvLine(cells, out);
  }
}

std::string MeasureHelp() {
  std::string help = "Measures for --check; distances from points to surfaces in mm, weighted by area:\n";
  for (const FieldDescriptor* field : Measures()) {
    const v1::Quantity& quantity = *schema::QuantityOf(*field);
    absl::StrAppendFormat(&help, "  %-14s %s%s%s\n", field->name(), quantity.label(),
                          quantity.help().empty() ? "" : ": ", quantity.help());
  }
  return help;
}

}  // namespace phrenic::client
