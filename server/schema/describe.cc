#include "server/schema/describe.h"

#include "absl/strings/str_cat.h"

namespace phrenic::schema {

std::string Range(const v1::Quantity& quantity) {
  const bool pure = quantity.unit().empty() || quantity.unit() == "1";
  return absl::StrCat(quantity.minimum(), " to ", quantity.maximum(), pure ? "" : " ", pure ? "" : quantity.unit());
}

}  // namespace phrenic::schema
