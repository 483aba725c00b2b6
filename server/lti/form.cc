#include "server/lti/form.h"

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"

namespace phrenic::lti {
namespace {

constexpr int kMostFields = 100;

std::string DecodeField(absl::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape =
        text[i] == '%' && i + 2 < text.size() && absl::ascii_isxdigit(text[i + 1]) && absl::ascii_isxdigit(text[i + 2]);
    if (escape) {
      decoded += absl::HexStringToBytes(text.substr(i + 1, 2));
      i += 2;
    } else {
      decoded += text[i] == '+' ? ' ' : text[i];
    }
  }
  return decoded;
}

std::string EncodeField(const std::string& text) {
  std::string encoded;
  for (const char c : text) {
    const bool plain = absl::ascii_isalnum(c) || c == '-' || c == '.' || c == '_' || c == '~';
    if (plain) {
      encoded += c;
    } else {
      absl::StrAppendFormat(&encoded, "%%%02X", static_cast<unsigned char>(c));
    }
  }
  return encoded;
}

}  // namespace

Fields ReadForm(std::string_view text) {
  Fields fields;
  int count = 0;
  for (const absl::string_view pair : absl::StrSplit(absl::string_view(text.data(), text.size()), '&')) {
    if (pair.empty() || ++count > kMostFields) continue;
    const std::pair<absl::string_view, absl::string_view> field = absl::StrSplit(pair, absl::MaxSplits('=', 1));
    fields[DecodeField(field.first)] = DecodeField(field.second);
  }
  return fields;
}

std::string FieldOf(const Fields& fields, std::string_view name) {
  const auto found = fields.find(name);
  return found == fields.end() ? "" : found->second;
}

std::string WriteForm(const std::vector<std::pair<std::string, std::string>>& fields) {
  return absl::StrJoin(fields, "&", [](std::string* out, const auto& field) {
    absl::StrAppend(out, EncodeField(field.first), "=", EncodeField(field.second));
  });
}

std::string CookieOf(std::string_view header, std::string_view name) {
  for (absl::string_view cookie : absl::StrSplit(absl::string_view(header.data(), header.size()), ';')) {
    const std::pair<absl::string_view, absl::string_view> pair = absl::StrSplit(cookie, absl::MaxSplits('=', 1));
    if (absl::StripAsciiWhitespace(pair.first) == absl::string_view(name.data(), name.size())) {
      return std::string(absl::StripAsciiWhitespace(pair.second));
    }
  }
  return "";
}

std::string HtmlText(std::string_view text) {
  return absl::StrReplaceAll({text.data(), text.size()},
                             {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}, {"'", "&#39;"}});
}

}  // namespace phrenic::lti
