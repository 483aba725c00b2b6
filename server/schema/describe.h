// What the option messages say, in the words that errors use.
#ifndef PHRENIC_SERVER_SCHEMA_DESCRIBE_H_
#define PHRENIC_SERVER_SCHEMA_DESCRIBE_H_

#include <string>

#include "phrenic/v1/options.pb.h"

namespace phrenic::schema {

// "0 to 20", with the unit where it is not a pure number: "0 to 1e+09 N/m".
std::string Range(const v1::Quantity& quantity);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_DESCRIBE_H_
