// A raw HTTP/2 client for calls that no gRPC library makes.
#ifndef PHRENIC_TESTS_SERVICE_RAW_HTTP2_H_
#define PHRENIC_TESTS_SERVICE_RAW_HTTP2_H_

#include <string>
#include <utility>
#include <vector>

#include "tests/service/raw_socket.h"

namespace phrenic::service {

// Not thread-safe. It opens streams within the server's limits only, and obeys the flow control of each stream: it
// never sends more of a message than the first window.
class RawHttp2 {
 public:
  explicit RawHttp2(int port) : socket_(port) {
    constexpr char kPreface[] = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";
    socket_.Send(kPreface + Frame(kSettings, 0, 0, "") + Frame(kSettings, kAck, 0, ""));
  }

  // Begins a call of a method with the headers of gRPC and `more`. Returns its stream.
  int Begin(const std::string& path, const std::vector<std::pair<std::string, std::string>>& more = {}) {
    stream_ += 2;
    std::string headers = "\x83\x86";  // :method POST, :scheme http (RFC 7541 appendix A)
    headers += Literal(":path", path) + Literal(":authority", "x") + Literal("te", "trailers") +
               Literal("content-type", "application/grpc");
    for (const auto& [name, value] : more) headers += Literal(name, value);
    socket_.Send(Frame(kHeaders, kEndHeaders, stream_, headers));
    return stream_;
  }
  // Sends the start of a message of `length` bytes: its prefix and `sent` zeros.
  bool SendPart(int stream, std::size_t length, std::size_t sent) {
    std::string prefix(1, '\0');
    for (int shift = 24; shift >= 0; shift -= 8) prefix += static_cast<char>(length >> shift);
    return socket_.Send(Frame(kData, 0, stream, prefix + std::string(sent, '\0')));
  }
  // Reads frames until the server ends the stream. False if it closes the connection, or is silent for 10 s.
  bool AwaitEnd(int stream) {
    for (;;) {
      const std::string head = Get(kHead);
      if (head.size() < kHead) return false;
      std::size_t length = 0;
      for (int i = 0; i < 3; ++i) length = length << 8 | static_cast<unsigned char>(head[i]);
      if (Get(length).size() < length) return false;
      const bool ends = head[3] == kReset || (head[3] == kHeaders && (head[4] & kEndStream) != 0);
      if (ends && static_cast<unsigned char>(head[8]) == stream % 256) return true;
    }
  }

 private:
  static constexpr char kData = 0, kHeaders = 1, kReset = 3, kSettings = 4;
  static constexpr char kAck = 1, kEndStream = 1, kEndHeaders = 4;
  static constexpr std::size_t kHead = 9;

  // Returns `count` bytes; fewer at the end of the connection.
  std::string Get(std::size_t count) {
    while (received_.size() < count) {
      const std::string more = socket_.ReadSome(1);
      if (more.empty()) break;
      received_ += more;
    }
    std::string bytes = received_.substr(0, count);
    received_.erase(0, bytes.size());
    return bytes;
  }
  static std::string Literal(const std::string& name, const std::string& value) {
    return std::string(1, '\0') + static_cast<char>(name.size()) + name + static_cast<char>(value.size()) + value;
  }
  static std::string Frame(char type, char flags, int stream, const std::string& payload) {
    std::string frame;
    for (int shift = 16; shift >= 0; shift -= 8) frame += static_cast<char>(payload.size() >> shift);
    frame += type;
    frame += flags;
    for (int shift = 24; shift >= 0; shift -= 8) frame += static_cast<char>(stream >> shift);
    return frame + payload;
  }

  RawSocket socket_;
  std::string received_;
  int stream_ = -1;
};

}  // namespace phrenic::service

#endif  // PHRENIC_TESTS_SERVICE_RAW_HTTP2_H_
