// The ways in which answers are printed, and which command knows which.
#ifndef PHRENIC_CLIENT_PRINT_OUTPUT_H_
#define PHRENIC_CLIENT_PRINT_OUTPUT_H_

#include <google/protobuf/message.h>

#include <string>

#include "client/connection/connection.h"
#include "client/print/table.h"

namespace phrenic::client {

// Of "table", "json", "jsonl" and "csv".
Output OutputOf(const std::string& name);

// Every command knows table and json; jsonl and csv are for lists.
bool Knows(const std::string& command, Output output);

// A list on standard output: `rows` for people and as CSV; the message, or each element of its first repeated field on
// a line, as JSON.
void PrintList(const Context& context, const google::protobuf::Message& message, const Table& rows);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_OUTPUT_H_
