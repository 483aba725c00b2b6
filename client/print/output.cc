#include "client/print/output.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <iostream>

namespace phrenic::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr const char* kLists[] = {"scenes",     "sessions",     "watch",          "exports list",
                                  "study list", "campaign run", "campaign report"};
constexpr const char* kTables[] = {"compare", "study error", "study stability", "study cost", "study watch"};

void PrintLines(const Message& message) {
  const auto& type = *message.GetDescriptor();
  for (int f = 0; f < type.field_count(); ++f) {
    const FieldDescriptor* field = type.field(f);
    if (!field->is_repeated()) continue;
    for (int i = 0; i < message.GetReflection()->FieldSize(message, field); ++i) {
      std::cout << Json(message.GetReflection()->GetRepeatedMessage(message, field, i)) << "\n";
    }
    return;
  }
}

}  // namespace

Output OutputOf(const std::string& name) {
  if (name == "json") return Output::kJson;
  if (name == "jsonl") return Output::kJsonl;
  return name == "csv" ? Output::kCsv : Output::kTable;
}

bool Knows(const std::string& command, Output output) {
  if (output == Output::kTable || output == Output::kJson) return true;
  const auto is = [&](const char* name) { return command == name; };
  return std::ranges::any_of(kLists, is) || (output == Output::kCsv && std::ranges::any_of(kTables, is));
}

void PrintList(const Context& context, const Message& message, const Table& rows) {
  switch (context.output) {
    case Output::kTable:
      return rows.Print(std::cout);
    case Output::kCsv:
      return rows.PrintCsv(std::cout);
    case Output::kJson:
      std::cout << Json(message) << "\n";
      return;
    case Output::kJsonl:
      return PrintLines(message);
  }
}

}  // namespace phrenic::client
