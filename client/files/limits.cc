#include "client/files/limits.h"

#include <google/protobuf/descriptor.h>

#include <fstream>
#include <sstream>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
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

// "integrator=velocity_verlet"; numbers are the same when the table of people shows them alike.
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

// What is wrong with this row, if anything.
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

absl::Status Check(const v1::StudyLimit& limit, const Message& tables, std::vector<std::string>& passed) {
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
    if (!problem.empty()) passed.push_back(absl::StrCat(LimitText(limit), " (row ", i + 1, ") ", problem));
  }
  if (!any) passed.push_back(absl::StrCat(LimitText(limit), ": no row is like that"));
  return absl::OkStatus();
}

}  // namespace

std::string LimitText(const v1::StudyLimit& limit) {
  std::string text = absl::StrCat(limit.table(), ".", limit.column());
  for (const std::string& condition : limit.where()) absl::StrAppend(&text, " where ", condition);
  return text;
}

absl::StatusOr<v1::StudyLimits> ReadStudyLimits(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) return absl::NotFoundError(absl::StrCat("cannot read the limits ", file, ": is the path right?"));
  std::stringstream text;
  text << stream.rdbuf();
  v1::StudyLimits limits;
  absl::Status parsed = schema::ParseText(file, text.str(), &limits);
  if (!parsed.ok()) return parsed;
  return limits;
}

absl::StatusOr<std::vector<std::string>> PassedLimits(const v1::StudyLimits& limits, const Message& tables) {
  std::vector<std::string> passed;
  for (const v1::StudyLimit& limit : limits.limits()) {
    if (absl::Status status = Check(limit, tables, passed); !status.ok()) return status;
  }
  return passed;
}

}  // namespace phrenic::client
