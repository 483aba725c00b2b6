// Tables made from messages: each repeated field of flat messages is a table whose columns are the message's fields;
// messages with lists or messages in them are left out.
#ifndef PHRENIC_CLIENT_PRINT_ROWS_H_
#define PHRENIC_CLIENT_PRINT_ROWS_H_

#include <google/protobuf/message.h>

#include <ostream>
#include <string>

namespace phrenic::client {

// Returns a number in four digits, "yes" or "" for a bool, text unchanged, "-" for a field that is not set. Requires:
// the field is not repeated and not a message.
std::string CellOf(const google::protobuf::Message& row, const google::protobuf::FieldDescriptor& field);

// Prints every table of `message` that has rows, under its name. Numbers have four digits.
void PrintTables(const google::protobuf::Message& message, std::ostream& out);
// Prints the same tables as CSV (RFC 4180) with all digits, separated by empty lines, each with a header.
void PrintCsv(const google::protobuf::Message& message, std::ostream& out);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_ROWS_H_
