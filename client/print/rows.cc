#include "client/print/rows.h"

#include <google/protobuf/descriptor.h>

#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/print/table.h"
#include "server/schema/fields.h"

namespace phrenic::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::string Text(const Message& row, const FieldDescriptor& field, bool every_digit) {
  const auto& reflection = *row.GetReflection();
  if (field.has_presence() && !reflection.HasField(row, &field)) return every_digit ? "" : "-";
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE: {
      const double value = reflection.GetDouble(row, &field);
      return every_digit ? schema::FormatNumber(value) : absl::StrFormat("%.4g", value);
    }
    case FieldDescriptor::CPPTYPE_INT64:
      return absl::StrCat(reflection.GetInt64(row, &field));
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection.GetBool(row, &field) ? "yes" : (every_digit ? "no" : "");
    case FieldDescriptor::CPPTYPE_ENUM:
      return reflection.GetEnum(row, &field)->name();
    default:
      return reflection.GetString(row, &field);
  }
}

// True if a row has a cell for each field.
bool IsFlat(const google::protobuf::Descriptor& row) {
  for (int f = 0; f < row.field_count(); ++f) {
    if (row.field(f)->is_repeated() || row.field(f)->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) return false;
  }
  return true;
}

std::vector<const FieldDescriptor*> TablesOf(const Message& message) {
  std::vector<const FieldDescriptor*> tables;
  const auto& type = *message.GetDescriptor();
  for (int f = 0; f < type.field_count(); ++f) {
    const FieldDescriptor* field = type.field(f);
    if (!field->is_repeated() || field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
    if (!IsFlat(*field->message_type())) continue;
    if (message.GetReflection()->FieldSize(message, field) > 0) tables.push_back(field);
  }
  return tables;
}

std::vector<std::string> Header(const FieldDescriptor& table) {
  std::vector<std::string> names;
  const auto& type = *table.message_type();
  names.reserve(static_cast<size_t>(type.field_count()));
  for (int f = 0; f < type.field_count(); ++f) names.push_back(type.field(f)->name());
  return names;
}

std::vector<std::string> CellsOf(const Message& row, bool every_digit) {
  std::vector<std::string> cells;
  const auto& type = *row.GetDescriptor();
  cells.reserve(static_cast<size_t>(type.field_count()));
  for (int f = 0; f < type.field_count(); ++f) cells.push_back(Text(row, *type.field(f), every_digit));
  return cells;
}

}  // namespace

std::string CellOf(const Message& row, const FieldDescriptor& field) { return Text(row, field, false); }

void PrintTables(const Message& message, std::ostream& out) {
  const auto& reflection = *message.GetReflection();
  for (const FieldDescriptor* field : TablesOf(message)) {
    Table table(Header(*field));
    for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
      table.Add(CellsOf(reflection.GetRepeatedMessage(message, field, i), false));
    }
    out << "\n" << field->name() << "\n";
    table.Print(out);
  }
}

void PrintCsv(const Message& message, std::ostream& out) {
  const auto& reflection = *message.GetReflection();
  bool first = true;
  for (const FieldDescriptor* field : TablesOf(message)) {
    if (!first) out << "\n";
    first = false;
    PrintCsvLine(Header(*field), out);
    for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
      PrintCsvLine(CellsOf(reflection.GetRepeatedMessage(message, field, i), true), out);
    }
  }
}

}  // namespace phrenic::client
