// The error of a scene field.
#ifndef PHRENIC_SERVER_MECHANICS_FIELD_ERROR_H_
#define PHRENIC_SERVER_MECHANICS_FIELD_ERROR_H_

#include <string_view>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace phrenic {

// Returns INVALID_ARGUMENT "path: what". `path` names the scene field, such as "forces[2].springs.bodies".
inline absl::Status FieldError(std::string_view path, std::string_view what) {
  return absl::InvalidArgumentError(
      absl::StrCat(absl::string_view(path.data(), path.size()), ": ", absl::string_view(what.data(), what.size())));
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FIELD_ERROR_H_
