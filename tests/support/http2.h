// The bytes of HTTP/2 (RFC 9113) and HPACK (RFC 7541), for calls and attacks that no gRPC library makes.
#ifndef PHRENIC_TESTS_SUPPORT_HTTP2_H_
#define PHRENIC_TESTS_SUPPORT_HTTP2_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace phrenic::http2 {

using Headers = std::vector<std::pair<std::string, std::string>>;

// What a client sends first; a SETTINGS frame follows.
inline constexpr std::string_view kPreface = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";

enum class FrameType : std::uint8_t {
  kData,
  kHeaders,
  kPriority,
  kReset,
  kSettings,
  kPush,
  kPing,
  kGoAway,
  kWindow,
  kContinuation
};
inline constexpr std::uint8_t kEndStream = 1, kAck = 1, kEndHeaders = 4;
inline constexpr std::size_t kFrameHead = 9;  // [bytes]

inline void AppendBigEndian(std::string& bytes, std::uint32_t number, int width) {
  for (int k = width - 1; k >= 0; --k) bytes.push_back(static_cast<char>(number >> (8 * k)));
}

// Returns the number of the first four bytes.
inline std::uint32_t BigEndian(std::string_view bytes) {
  std::uint32_t number = 0;
  for (const char byte : bytes.substr(0, 4)) number = number << 8 | static_cast<std::uint8_t>(byte);
  return number;
}

// Returns a frame: length, type, flags, stream, payload.
inline std::string Frame(FrameType type, std::uint8_t flags, std::uint32_t stream, std::string_view payload) {
  std::string bytes;
  AppendBigEndian(bytes, static_cast<std::uint32_t>(payload.size()), 3);
  bytes.push_back(static_cast<char>(type));
  bytes.push_back(static_cast<char>(flags));
  AppendBigEndian(bytes, stream, 4);
  return bytes.append(payload);
}

// The first bytes of a frame. Requires: kFrameHead bytes.
struct FrameHead {
  explicit FrameHead(std::string_view bytes)
      : length(BigEndian(bytes) >> 8),
        type(static_cast<FrameType>(bytes[3])),
        flags(static_cast<std::uint8_t>(bytes[4])),
        stream(BigEndian(bytes.substr(5)) & 0x7fffffff) {}
  // True if the server sends nothing more on the frame's stream.
  bool EndsStream() const {
    return type == FrameType::kReset ||
           ((type == FrameType::kData || type == FrameType::kHeaders) && (flags & kEndStream) != 0);
  }

  std::size_t length;  // of the payload
  FrameType type;
  std::uint8_t flags;
  std::uint32_t stream;
};

// Appends a text with its length (RFC 7541, section 5).
inline void AppendText(std::string& block, std::string_view text) {
  constexpr std::size_t kPrefix = 127;
  if (text.size() < kPrefix) {
    block.push_back(static_cast<char>(text.size()));
  } else {
    block.push_back(static_cast<char>(kPrefix));
    std::size_t rest = text.size() - kPrefix;
    for (; rest >= 128; rest /= 128) block.push_back(static_cast<char>(rest % 128 + 128));
    block.push_back(static_cast<char>(rest));
  }
  block.append(text);
}

// Returns header fields, of any bytes, as literals without indexing or compression (RFC 7541, section 6.2.2).
inline std::string HeaderBlock(const Headers& headers) {
  std::string block;
  for (const auto& [name, value] : headers) {
    block.push_back(0);
    AppendText(block, name);
    AppendText(block, value);
  }
  return block;
}

// Returns the header fields of a call of a method, such as "/phrenic.v1.ServerService/GetServer", and `more`.
inline Headers CallHeaders(const std::string& path, const Headers& more = {}) {
  Headers headers = {{":method", "POST"},
                     {":scheme", "http"},
                     {":path", path},
                     {":authority", "localhost"},
                     {"content-type", "application/grpc"},
                     {"te", "trailers"}};
  headers.insert(headers.end(), more.begin(), more.end());
  return headers;
}

// Returns the prefix of a gRPC message of so many bytes.
inline std::string GrpcPrefix(std::size_t length) {
  std::string bytes(1, '\0');
  AppendBigEndian(bytes, static_cast<std::uint32_t>(length), 4);
  return bytes;
}

}  // namespace phrenic::http2

#endif  // PHRENIC_TESTS_SUPPORT_HTTP2_H_
