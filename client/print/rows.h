// Tables made from messages: a repeated field of flat messages is a table, its fields are the columns.
#ifndef PHRENIC_CLIENT_PRINT_ROWS_H_
#define PHRENIC_CLIENT_PRINT_ROWS_H_

#include <google/protobuf/message.h>

#include <ostream>
#include <string>

namespace phrenic::client {

// A number in four digits, "yes" or nothing, text as it is, "-" where nothing is set.
std::string CellOf(const google::protobuf::Message& row, const google::protobuf::FieldDescriptor& field);

// Every table of `message` that has rows, each under its name, for people.
void PrintTables(const google::protobuf::Message& message, std::ostream& out);
// The same as CSV (RFC 4180), every digit; an empty line and a header before each table after the first.
void PrintCsv(const google::protobuf::Message& message, std::ostream& out);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_ROWS_H_
