// The output formats: JSON of any message, and lists in each format.
#ifndef PHRENIC_CLIENT_PRINT_OUTPUT_H_
#define PHRENIC_CLIENT_PRINT_OUTPUT_H_

#include <google/protobuf/message.h>

#include <nlohmann/json.hpp>
#include <string>

#include "client/connection/context.h"
#include "client/print/table.h"

namespace phrenic::client {

// Returns the format called "table", "json", "jsonl" or "csv"; kTable for any other name.
Output OutputOf(const std::string& name);

// Returns the message as one line of JSON with the proto's field names. Fields with default values are included. NaN
// and infinity are strings, 64-bit integers as well (the JSON mapping of protobuf).
std::string Json(const google::protobuf::Message& message);

// Prints JSON on standard output, indented. Bytes that are not UTF-8, as names of files may have, are replaced.
void PrintJson(const nlohmann::json& json);

// Prints a list on standard output in the context's format: `rows` as a table or CSV, the message as JSON, or each
// element of its first repeated field as a line of JSON. Requires: the elements are messages.
void PrintList(const Context& context, const google::protobuf::Message& message, const Table& rows);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_OUTPUT_H_
