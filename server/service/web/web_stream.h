// A TCP stream with optional TLS that meets Asio's AsyncReadStream and AsyncWriteStream requirements.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_STREAM_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_STREAM_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core.hpp>
#include <memory>
#include <optional>

namespace phrenic::service {

// Not thread-safe: use it on the socket's strand. Errors reach the handlers as boost::system::error_code.
//
// WebConnection owns it. One read and one write may be pending at a time. A pending operation must have ended before
// the stream is destroyed. It must not be moved, because TLS refers to the TCP stream.
class WebStream {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;

  // Plain TCP if `tls` is null. OpenSSL keeps what it needs of `tls`, which may be released afterwards.
  WebStream(boost::asio::ip::tcp::socket socket, const std::shared_ptr<boost::asio::ssl::context>& tls)
      : tcp_(std::move(socket)) {
    if (tls != nullptr) tls_.emplace(tcp_, *tls);
  }

  executor_type get_executor() { return tcp_.get_executor(); }
  // Returns the layer below TLS, which has the deadlines. A deadline that expires closes the socket and fails what is
  // pending (boost::beast::error::timeout).
  boost::beast::tcp_stream& tcp() { return tcp_; }
  bool encrypted() const { return tls_.has_value(); }
  // Returns the server's certificate; null without TLS. It lives as long as the stream.
  X509* certificate() { return tls_.has_value() ? SSL_get_certificate(tls_->native_handle()) : nullptr; }

  // Performs the TLS handshake; without TLS it calls the handler at once. The handler gets the error. Set a deadline
  // before.
  template <class Handler>
  void AsyncHandshake(Handler handler) {
    if (!tls_.has_value()) return handler(boost::system::error_code());
    tls_->async_handshake(boost::asio::ssl::stream_base::server, std::move(handler));
  }

  // Reads or writes at least one byte of plain text, and gives the handler error and number of bytes.
  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    if (tls_.has_value()) return tls_->async_read_some(buffers, std::forward<Handler>(handler));
    return tcp_.async_read_some(buffers, std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    if (tls_.has_value()) return tls_->async_write_some(buffers, std::forward<Handler>(handler));
    return tcp_.async_write_some(buffers, std::forward<Handler>(handler));
  }

 private:
  boost::beast::tcp_stream tcp_;                                            // first: tls_ refers to it
  std::optional<boost::asio::ssl::stream<boost::beast::tcp_stream&>> tls_;  // nullopt: plain TCP
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_STREAM_H_
