// A raw HTTP/2 client for calls that no gRPC library makes.
#ifndef PHRENIC_TESTS_SUPPORT_RAW_HTTP2_H_
#define PHRENIC_TESTS_SUPPORT_RAW_HTTP2_H_

#include "tests/support/raw_socket.h"
// After Boost, which needs <utility> first.
#include <string>

#include "tests/support/http2.h"

namespace phrenic::service {

// Not thread-safe. It opens streams within the server's limits only, and obeys the flow control of each stream: it
// never sends more of a message than the first window.
class RawHttp2 {
 public:
  explicit RawHttp2(int port) : socket_(port) {
    socket_.Send(std::string(http2::kPreface) + http2::Frame(http2::FrameType::kSettings, 0, 0, "") +
                 http2::Frame(http2::FrameType::kSettings, http2::kAck, 0, ""));
  }

  // Begins a call of a method with the headers of gRPC and `more`. Returns its stream.
  std::uint32_t Begin(const std::string& path, const http2::Headers& more = {}) {
    stream_ += 2;
    const std::string headers = http2::HeaderBlock(http2::CallHeaders(path, more));
    socket_.Send(http2::Frame(http2::FrameType::kHeaders, http2::kEndHeaders, stream_, headers));
    return stream_;
  }
  // Makes a whole call with an empty message. Returns its stream.
  std::uint32_t Call(const std::string& path, const http2::Headers& more = {}) {
    const std::uint32_t stream = Begin(path, more);
    socket_.Send(http2::Frame(http2::FrameType::kData, http2::kEndStream, stream, http2::GrpcPrefix(0)));
    return stream;
  }
  // Sends the start of a message of `length` bytes: its prefix and `sent` zeros.
  bool SendPart(std::uint32_t stream, std::size_t length, std::size_t sent) {
    return socket_.Send(
        http2::Frame(http2::FrameType::kData, 0, stream, http2::GrpcPrefix(length) + std::string(sent, '\0')));
  }
  // Reads frames until the server ends the stream. False if it closes the connection, or is silent for 10 s.
  bool AwaitEnd(std::uint32_t stream) {
    for (;;) {
      const std::string bytes = socket_.ReadExactly(http2::kFrameHead);
      if (bytes.size() < http2::kFrameHead) return false;
      const http2::FrameHead head(bytes);
      if (socket_.ReadExactly(head.length).size() < head.length) return false;
      if (head.type == http2::FrameType::kGoAway) return false;
      if (head.stream == stream && head.EndsStream()) return true;
    }
  }

 private:
  RawSocket socket_;
  std::uint32_t stream_ = static_cast<std::uint32_t>(-1);
};

}  // namespace phrenic::service

#endif  // PHRENIC_TESTS_SUPPORT_RAW_HTTP2_H_
