// A raw HTTP client for valid, slow and malicious requests.
#ifndef PHRENIC_TESTS_SUPPORT_RAW_SOCKET_H_
#define PHRENIC_TESTS_SUPPORT_RAW_SOCKET_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace phrenic::service {

namespace http = boost::beast::http;

// Not thread-safe. Every operation times out after 10 s.
class RawSocket {
 public:
  using Response = http::response<http::string_body>;

  explicit RawSocket(int port) : stream_(context_) {
    stream_.connect({boost::asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)});
  }

  // False if the server has closed the connection.
  bool Send(const std::string& bytes) {
    boost::system::error_code error;
    boost::asio::write(stream_.socket(), boost::asio::buffer(bytes), error);
    return !error;
  }

  // Reads one response; nullopt if the connection ends before.
  std::optional<Response> Read() {
    http::response_parser<http::string_body> parser;
    if (!Run([&](auto handler) { http::async_read(stream_, buffer_, parser, handler); })) return std::nullopt;
    return parser.release();
  }

  // Reads at least `count` bytes, fewer if the connection ends before.
  std::string ReadSome(std::size_t count) {
    std::string bytes;
    while (bytes.size() < count) {
      char piece[4096];
      std::size_t got = 0;
      stream_.expires_after(kTimeout);
      stream_.async_read_some(boost::asio::buffer(piece), [&](boost::system::error_code, std::size_t n) { got = n; });
      context_.restart();
      context_.run();
      if (got == 0) break;
      bytes.append(piece, got);
    }
    return bytes;
  }

  // Reads `count` bytes, fewer if the connection ends before.
  std::string ReadExactly(std::size_t count) {
    while (unread_.size() < count) {
      const std::string more = ReadSome(1);
      if (more.empty()) break;
      unread_ += more;
    }
    const std::string bytes = unread_.substr(0, count);
    unread_.erase(0, bytes.size());
    return bytes;
  }

  std::optional<Response> Ask(const std::string& bytes) {
    Send(bytes);
    return Read();
  }

 private:
  static constexpr std::chrono::seconds kTimeout{10};

  template <class Start>
  bool Run(const Start& start) {
    bool ok = false;
    stream_.expires_after(kTimeout);
    start([&](boost::system::error_code error, std::size_t) { ok = !error; });
    context_.restart();
    context_.run();
    return ok;
  }

  boost::asio::io_context context_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  std::string unread_;  // of ReadExactly
};

// One frame of a gRPC-web body.
struct WebFrame {
  unsigned char flags = 0;
  std::string bytes;
};

// Returns the complete frames at the start of a body.
inline std::vector<WebFrame> WebFrames(std::string_view body) {
  std::vector<WebFrame> frames;
  while (body.size() >= 5) {
    std::size_t length = 0;
    for (int i = 1; i < 5; ++i) length = length << 8 | static_cast<unsigned char>(body[i]);
    if (body.size() < 5 + length) break;
    frames.push_back({static_cast<unsigned char>(body[0]), std::string(body.substr(5, length))});
    body.remove_prefix(5 + length);
  }
  return frames;
}

// Returns the frame of one message.
inline std::string WebMessage(const std::string& message) {
  std::string frame(1, '\0');
  for (int shift = 24; shift >= 0; shift -= 8) frame += static_cast<char>(message.size() >> shift);
  return frame + message;
}

}  // namespace phrenic::service

#endif  // PHRENIC_TESTS_SUPPORT_RAW_SOCKET_H_
