// Reads the options of phrenic/v1/options.proto off a field, and formats its values for people. Stateless; thread-safe.
#ifndef PHRENIC_SERVER_SCHEMA_FIELDS_H_
#define PHRENIC_SERVER_SCHEMA_FIELDS_H_

#include <google/protobuf/descriptor.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phrenic/v1/options.pb.h"

namespace phrenic::schema {

// Return the field's Quantity, Toggle or Choice; null if it has none. Valid as long as the field's descriptor.
const v1::Quantity* QuantityOf(const google::protobuf::FieldDescriptor& field);
const v1::Toggle* ToggleOf(const google::protobuf::FieldDescriptor& field);
const v1::Choice* ChoiceOf(const google::protobuf::FieldDescriptor& field);
// Returns the heading under which help and panels list the field; empty if it has none.
std::string GroupOf(const google::protobuf::FieldDescriptor& field);
// True if the field must be set, or must not be empty.
bool IsRequired(const google::protobuf::FieldDescriptor& field);

// Returns an enum value's name for people: "velocity_verlet" for INTEGRATOR_VELOCITY_VERLET of enum Integrator.
std::string ChoiceName(const google::protobuf::EnumValueDescriptor& value);
// Return the names of all values but the unspecified one, as a list or joined: "semi_implicit_euler, velocity_verlet".
// Older names of a value are left out.
std::vector<std::string> ChoiceNameList(const google::protobuf::EnumDescriptor& type);
std::string ChoiceNames(const google::protobuf::EnumDescriptor& type);
// Returns the value of that name, ignoring case; null if there is none.
const google::protobuf::EnumValueDescriptor* FindChoice(const google::protobuf::EnumDescriptor& type,
                                                        std::string_view name);

// Returns the shortest decimal that parses back as the same number: "0.1", "1e+09".
std::string FormatNumber(double value);

// Returns "0 to 1e+09 N/m"; leaves out the unit "1".
std::string FormatRange(const v1::Quantity& quantity);

// Returns the error of a value: "-5 is outside 0 to 1e+09 N/m", "nan is not a finite number; ...". Returns nullopt if
// it is valid. If `quantity` is null, only finiteness is checked.
std::optional<std::string> NumberProblem(double value, const v1::Quantity* quantity);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_FIELDS_H_
