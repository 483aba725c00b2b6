// One call over raw HTTP/2 (RFC 9113), for headers that gRPC's own client does not send.
#ifndef PHRENIC_TESTS_SERVICE_RAW_GRPC_CALL_H_
#define PHRENIC_TESTS_SERVICE_RAW_GRPC_CALL_H_

#include "tests/service/raw_socket.h"
// After Boost, which needs <utility> first.
#include <string>
#include <utility>
#include <vector>

namespace phrenic::service {

using Http2Headers = std::vector<std::pair<std::string, std::string>>;

// Returns a frame of HTTP/2: length, type, flags, stream, payload.
inline std::string Http2Frame(int type, int flags, std::uint32_t stream, const std::string& payload) {
  std::string frame;
  for (int shift = 16; shift >= 0; shift -= 8) frame += static_cast<char>(payload.size() >> shift);
  frame += static_cast<char>(type);
  frame += static_cast<char>(flags);
  for (int shift = 24; shift >= 0; shift -= 8) frame += static_cast<char>(stream >> shift);
  return frame + payload;
}

// Returns a length below 16,384 as an HPACK integer with a prefix of seven bits (RFC 7541 section 5.1).
inline std::string HpackLength(std::size_t length) {
  if (length < 127) return std::string(1, static_cast<char>(length));
  length -= 127;
  std::string bytes(1, '\x7f');
  for (; length >= 128; length >>= 7) bytes += static_cast<char>(length | 128);
  return bytes + static_cast<char>(length);
}

// Returns headers as literals without indexing (RFC 7541 section 6.2.2), with any bytes.
inline std::string HpackLiterals(const Http2Headers& headers) {
  std::string block;
  for (const auto& [name, value] : headers) {
    block += '\0';
    block += HpackLength(name.size()) + name + HpackLength(value.size()) + value;
  }
  return block;
}

// Returns the bytes of a connection that makes one unary call of gRPC on stream 1, with an empty message.
inline std::string Http2Call(const std::string& path, const Http2Headers& headers) {
  constexpr int kData = 0, kHeaders = 1, kSettings = 4, kEndStream = 1, kEndHeaders = 4;
  Http2Headers all = {{":method", "POST"},
                      {":scheme", "http"},
                      {":path", path},
                      {":authority", "localhost"},
                      {"content-type", "application/grpc"},
                      {"te", "trailers"}};
  all.insert(all.end(), headers.begin(), headers.end());
  return "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + Http2Frame(kSettings, 0, 0, "") +
         Http2Frame(kHeaders, kEndHeaders, 1, HpackLiterals(all)) +
         Http2Frame(kData, kEndStream, 1, std::string(5, '\0'));
}

// Reads frames until stream 1 ends. False if the connection ends before.
inline bool AwaitEndOfStream(RawSocket& socket) {
  constexpr int kHeaders = 1, kReset = 3, kGoAway = 7, kEndStream = 1;
  while (true) {
    const std::string head = socket.ReadExactly(9);
    if (head.size() < 9) return false;
    const auto byte = [&head](int i) { return static_cast<unsigned char>(head[static_cast<std::size_t>(i)]); };
    socket.ReadExactly(static_cast<std::size_t>(byte(0) << 16 | byte(1) << 8 | byte(2)));
    const int type = byte(3);
    if (type == kGoAway) return false;
    if (byte(8) == 1 && (type == kReset || (type == kHeaders && (byte(4) & kEndStream) != 0))) return true;
  }
}

}  // namespace phrenic::service

#endif  // PHRENIC_TESTS_SERVICE_RAW_GRPC_CALL_H_
