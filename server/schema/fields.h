// What the options of phrenic/v1/options.proto say about one field, and how its numbers are written for people.
#ifndef PHRENIC_SERVER_SCHEMA_FIELDS_H_
#define PHRENIC_SERVER_SCHEMA_FIELDS_H_

#include <google/protobuf/descriptor.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phrenic/v1/options.pb.h"

namespace phrenic::schema {

// The field's Quantity, Toggle or Choice; null where it has none. Lives as long as the field's descriptor.
const v1::Quantity* QuantityOf(const google::protobuf::FieldDescriptor& field);
const v1::Toggle* ToggleOf(const google::protobuf::FieldDescriptor& field);
const v1::Choice* ChoiceOf(const google::protobuf::FieldDescriptor& field);
bool IsRequired(const google::protobuf::FieldDescriptor& field);

// What a person calls a value of an enum: "velocity_verlet" for INTEGRATOR_VELOCITY_VERLET of enum Integrator.
std::string ChoiceName(const google::protobuf::EnumValueDescriptor& value);
// The names of all values but the unspecified one; with commas "semi_implicit_euler, velocity_verlet".
std::vector<std::string> ChoiceNameList(const google::protobuf::EnumDescriptor& type);
std::string ChoiceNames(const google::protobuf::EnumDescriptor& type);
// The value of that name, whatever the case; null where there is none.
const google::protobuf::EnumValueDescriptor* FindChoice(const google::protobuf::EnumDescriptor& type,
                                                        std::string_view name);

// The shortest decimal that reads back as the same number: "0.1", "1e+09".
std::string FormatNumber(double value);

// "0 to 1e+09 N/m"; without the unit where it is "1".
std::string FormatRange(const v1::Quantity& quantity);

// What is wrong with `value`: "-5 is outside 0 to 1e+09 N/m", "nan is not a finite number, ..."; nothing where it is
// right. `quantity` may be null: then only finiteness counts.
std::optional<std::string> NumberProblem(double value, const v1::Quantity* quantity);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_FIELDS_H_
