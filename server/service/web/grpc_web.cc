#include "server/service/web/grpc_web.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"

namespace phrenic::service {
namespace {

constexpr std::size_t kPrefix = 5;

absl::string_view View(std::string_view text) { return {text.data(), text.size()}; }

std::uint32_t Length(std::string_view frame) {
  std::uint32_t length = 0;
  for (std::size_t i = 1; i < kPrefix; ++i) length = length << 8 | static_cast<unsigned char>(frame[i]);
  return length;
}

// Percent-encodes "%" and all bytes outside printable ASCII, as gRPC does for grpc-message.
std::string PercentEncode(std::string_view text) {
  std::string encoded;
  for (const char c : text) {
    if (c >= 0x20 && c <= 0x7e && c != '%') {
      encoded += c;
    } else {
      absl::StrAppendFormat(&encoded, "%%%02X", static_cast<unsigned char>(c));
    }
  }
  return encoded;
}

}  // namespace

bool IsGrpcWeb(std::string_view content_type) {
  return absl::StartsWithIgnoreCase(View(content_type), "application/grpc-web");
}

bool IsGrpcWebText(std::string_view content_type) {
  return absl::StartsWithIgnoreCase(View(content_type), "application/grpc-web-text");
}

absl::StatusOr<std::string> ParseRequestBody(std::string body, bool text) {
  if (text) {
    std::string bytes;
    if (!absl::Base64Unescape(body, &bytes)) return absl::InvalidArgumentError("the body is not base64");
    body = std::move(bytes);
  }
  if (body.size() < kPrefix) return absl::InvalidArgumentError("the body is shorter than a gRPC-web frame");
  if (body[0] != 0) return absl::InvalidArgumentError("the body is not one uncompressed gRPC-web message");
  if (Length(body) != body.size() - kPrefix) {
    return absl::InvalidArgumentError(
        absl::StrCat("the frame says ", Length(body), " bytes, but ", body.size() - kPrefix, " follow"));
  }
  return body.erase(0, kPrefix);
}

std::array<char, 5> MessagePrefix(std::uint32_t length) {
  return {0, static_cast<char>(length >> 24), static_cast<char>(length >> 16), static_cast<char>(length >> 8),
          static_cast<char>(length)};
}

std::string TrailersFrame(const grpc::Status& status, const std::multimap<std::string, std::string>& metadata) {
  std::string trailers = absl::StrCat("grpc-status: ", static_cast<int>(status.error_code()), "\r\n");
  if (!status.error_message().empty()) {
    absl::StrAppend(&trailers, "grpc-message: ", PercentEncode(status.error_message()), "\r\n");
  }
  for (const auto& [name, value] : metadata) {
    absl::StrAppend(&trailers, name, ": ", absl::EndsWith(name, "-bin") ? absl::Base64Escape(value) : value, "\r\n");
  }
  std::array<char, 5> prefix = MessagePrefix(static_cast<std::uint32_t>(trailers.size()));
  prefix[0] = static_cast<char>(0x80);
  return std::string(prefix.data(), prefix.size()) + trailers;
}

std::optional<std::chrono::nanoseconds> ParseTimeout(std::string_view text) {
  constexpr std::size_t kMaxDigits = 8;
  if (text.size() < 2 || text.size() > kMaxDigits + 1) return std::nullopt;
  std::int64_t count = 0;
  const std::string_view digits = text.substr(0, text.size() - 1);
  if (!std::all_of(digits.begin(), digits.end(), absl::ascii_isdigit)) return std::nullopt;
  if (!absl::SimpleAtoi(View(digits), &count)) return std::nullopt;
  switch (text.back()) {
    case 'H':
      return std::chrono::hours(std::min<std::int64_t>(count, 1'000'000));
    case 'M':
      return std::chrono::minutes(count);
    case 'S':
      return std::chrono::seconds(count);
    case 'm':
      return std::chrono::milliseconds(count);
    case 'u':
      return std::chrono::microseconds(count);
    case 'n':
      return std::chrono::nanoseconds(count);
    default:
      return std::nullopt;
  }
}

}  // namespace phrenic::service
