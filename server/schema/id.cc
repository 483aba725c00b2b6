#include "server/schema/id.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"

namespace phrenic::schema {
namespace {

constexpr std::size_t kLongestId = 64;

bool IsAllowed(char c) { return absl::ascii_islower(c) || absl::ascii_isdigit(c) || c == '-'; }

}  // namespace

absl::Status CheckId(const std::string& field, const std::string& id) {
  if (id.size() <= kLongestId && std::all_of(id.begin(), id.end(), IsAllowed)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(field, ": \"", ShortId(id), "\" is not 1 to 64 characters of a-z, 0-9 and \"-\""));
}

std::string FreeId(const std::string& stem, const std::string& otherwise,
                   const std::function<bool(const std::string&)>& taken) {
  std::string id = absl::AsciiStrToLower(stem).substr(0, kLongestId - 8);
  for (char& c : id) {
    if (!IsAllowed(c)) c = '-';
  }
  if (id.empty()) id = otherwise;
  if (!taken(id)) return id;
  int number = 2;
  while (taken(absl::StrCat(id, "-", number))) ++number;
  return absl::StrCat(id, "-", number);
}

std::string ShortId(const std::string& id) { return id.substr(0, kLongestId); }

}  // namespace phrenic::schema
