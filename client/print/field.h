// --field: prints one value of a command's JSON, so that scripts need no JSON tool.
#ifndef PHRENIC_CLIENT_PRINT_FIELD_H_
#define PHRENIC_CLIENT_PRINT_FIELD_H_

#include <functional>
#include <nlohmann/json.hpp>
#include <ostream>
#include <streambuf>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace phrenic::client {

// Returns the value at `path`: names of members, indices of elements (from 0) and `*` for all elements, separated by
// dots: "session.tick", "sessions.0.id", "sessions.*.id". Each value is one line: strings without quotes, objects and
// lists as JSON. INVALID_ARGUMENT names the first step of the path that leads nowhere.
absl::StatusOr<std::string> FieldOf(const nlohmann::json& json, const std::string& path);

// Runs `command` and prints, instead of what it prints on `out`, the field at `path` of it: of each line if
// `by_lines` (JSON Lines), otherwise of the whole. Lines are printed as they come. The first document without the field
// ends the printing. Returns INVALID_ARGUMENT as FieldOf; OK if the command prints nothing. Not thread-safe.
absl::Status PrintField(std::ostream& out, const std::string& path, bool by_lines,
                        const std::function<void()>& command);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_FIELD_H_
