#include "client/cli/parameter_rows.h"

#include <google/protobuf/descriptor.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "phrenic/v1/geometry.pb.h"
#include "phrenic/v1/parameters.pb.h"
#include "server/schema/fields.h"

namespace phrenic::client {
namespace {

using google::protobuf::FieldDescriptor;

ParameterRow RowOf(const FieldDescriptor& field) {
  if (const v1::Toggle* toggle = schema::ToggleOf(field)) {
    return {schema::GroupOf(field), field.name(), "", "on, off", toggle->default_value() ? "on" : "off",
            toggle->help()};
  }
  if (const v1::Choice* choice = schema::ChoiceOf(field)) {
    const google::protobuf::EnumDescriptor& type = *field.enum_type();
    // The names are in the last column, because they are too long for the others.
    return {schema::GroupOf(field),
            field.name(),
            "",
            "a name",
            schema::ChoiceName(*type.FindValueByNumber(choice->default_value())),
            absl::StrCat(choice->help(), " One of ", schema::ChoiceNames(type), ".")};
  }
  const v1::Quantity& quantity = field.options().GetExtension(v1::quantity);
  return {schema::GroupOf(field),
          field.name(),
          quantity.unit() == "1" ? "" : quantity.unit(),
          absl::StrFormat("%g to %g", quantity.minimum(), quantity.maximum()),
          quantity.automatic() ? "automatic" : absl::StrFormat("%g", quantity.default_value()),
          quantity.help()};
}

std::vector<ParameterRow> RowsOf(const google::protobuf::Descriptor& type) {
  std::vector<ParameterRow> rows;
  rows.reserve(static_cast<std::size_t>(type.field_count()));
  for (int f = 0; f < type.field_count(); ++f) rows.push_back(RowOf(*type.field(f)));
  return rows;
}

}  // namespace

std::vector<ParameterRow> ParameterRows() { return RowsOf(*v1::Parameters::descriptor()); }

std::vector<ParameterRow> PhysiqueRows() { return RowsOf(*v1::Physique::descriptor()); }

}  // namespace phrenic::client
