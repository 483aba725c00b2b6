#include "client/files/study_limits.h"

#include <google/protobuf/descriptor.h>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/files/whole_file.h"
#include "client/print/rows.h"
#include "server/schema/fields.h"
#include "server/schema/schema.h"

namespace phrenic::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

absl::StatusOr<const FieldDescriptor*> Column(const FieldDescriptor& table, const std::string& name) {
  const FieldDescriptor* field = table.message_type()->FindFieldByName(name);
  if (field != nullptr) return field;
  return absl::InvalidArgumentError(absl::StrCat("table ", table.name(), " has no column \"", name, "\""));
}

// True if the row meets every condition, such as "integrator=velocity_verlet". Numbers are equal if CellOf returns the
// same text.
absl::StatusOr<bool> Fits(const Message& row, const FieldDescriptor& table, const v1::StudyLimit& limit) {
  for (const std::string& condition : limit.where()) {
    const size_t equals = condition.find('=');
    if (equals == std::string::npos) {
      return absl::InvalidArgumentError(absl::StrCat("where: \"", condition, "\" is not of the form column=value"));
    }
    const auto column = Column(table, condition.substr(0, equals));
    if (!column.ok()) return column.status();
    if (CellOf(row, **column) != condition.substr(equals + 1)) return false;
  }
  return true;
}

// Returns how the row exceeds the limit; empty if it does not.
std::string Problem(const Message& row, const FieldDescriptor& column, const v1::StudyLimit& limit) {
  const std::string cell = CellOf(row, column);
  if (!limit.equals().empty()) {
    return cell == limit.equals() ? "" : absl::StrCat("is \"", cell, "\", not \"", limit.equals(), "\"");
  }
  double value = 0;
  if (!absl::SimpleAtod(cell, &value)) return absl::StrCat("is ", cell, ", not a number");
  if (limit.has_at_most() && value > limit.at_most()) {
    return absl::StrCat("is ", cell, ", above ", schema::FormatNumber(limit.at_most()));
  }
  if (limit.has_at_least() && value < limit.at_least()) {
    return absl::StrCat("is ", cell, ", below ", schema::FormatNumber(limit.at_least()));
  }
  return "";
}

absl::Status Check(const v1::StudyLimit& limit, const Message& tables, std::vector<std::string>& exceeded) {
  const FieldDescriptor* table = tables.GetDescriptor()->FindFieldByName(limit.table());
  if (table == nullptr || !table->is_repeated() || table->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
    return absl::InvalidArgumentError(absl::StrCat("the study has no table \"", limit.table(), "\""));
  }
  const auto column = Column(*table, limit.column());
  if (!column.ok()) return column.status();
  bool any = false;
  for (int i = 0; i < tables.GetReflection()->FieldSize(tables, table); ++i) {
    const Message& row = tables.GetReflection()->GetRepeatedMessage(tables, table, i);
    const auto fits = Fits(row, *table, limit);
    if (!fits.ok()) return fits.status();
    if (!*fits) continue;
    any = true;
    const std::string problem = Problem(row, **column, limit);
    if (!problem.empty()) exceeded.push_back(absl::StrCat(LimitText(limit), " (row ", i + 1, ") ", problem));
  }
  if (!any) exceeded.push_back(absl::StrCat(LimitText(limit), ": no row meets these conditions"));
  return absl::OkStatus();
}

}  // namespace

std::string LimitText(const v1::StudyLimit& limit) {
  std::string text = absl::StrCat(limit.table(), ".", limit.column());
  for (const std::string& condition : limit.where()) absl::StrAppend(&text, " where ", condition);
  return text;
}

absl::StatusOr<v1::StudyLimits> ReadStudyLimits(const std::string& file) {
  const absl::StatusOr<std::string> text = ReadWhole(file, "the limits");
  if (!text.ok()) return text.status();
  return ParseStudyLimits(file, *text);
}

absl::StatusOr<v1::StudyLimits> ParseStudyLimits(const std::string& file, const std::string& text) {
  v1::StudyLimits limits;
  absl::Status parsed = schema::ParseText(file, text, &limits);
  if (!parsed.ok()) return parsed;
  return limits;
}

absl::StatusOr<std::vector<std::string>> ExceededLimits(const v1::StudyLimits& limits, const Message& tables) {
  std::vector<std::string> exceeded;
  for (const v1::StudyLimit& limit : limits.limits()) {
    if (absl::Status status = Check(limit, tables, exceeded); !status.ok()) return status;
  }
  return exceeded;
}

}  // namespace phrenic::client
