#include "client/print/output.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>

#include <iostream>

namespace phrenic::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

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

std::string Json(const Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string text;
  (void)google::protobuf::util::MessageToJsonString(message, &text, options);
  return text;
}

void PrintJson(const nlohmann::json& json) {
  std::cout << json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
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
