// One browser's connection: HTTP/1.1, requests one after the other, each answered by a file or by a gRPC call.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_CONNECTION_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_CONNECTION_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <grpcpp/generic/generic_stub.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "server/service/web/web_call.h"
#include "server/service/web/web_stream.h"

namespace phrenic::service {

// What all connections share; outlives them.
struct WebSettings {
  std::string root;
  std::vector<std::string> allowed_origins;
  std::size_t max_body_bytes = 0;
  std::chrono::milliseconds head_time{10'000};  // for a request's head to come, and for a handshake
  std::chrono::milliseconds idle_time{60'000};  // for its rest, and for a client to take what it is sent
  // IdempotencyCache what is no file, "/healthz" say, with what the request has in "authorization"; nothing where it is
  // a file.
  struct Page {
    unsigned status = 200;
    std::string type, text;
  };
  std::function<std::optional<Page>(std::string_view target, std::string_view authorization)> page;
};

// Its functions run on its own strand; only Run, Refuse, Close and waiting_since may be called from elsewhere.
class WebConnection final : public std::enable_shared_from_this<WebConnection> {
 public:
  // `tls` null: nothing is encrypted.
  WebConnection(boost::asio::ip::tcp::socket socket, const std::shared_ptr<boost::asio::ssl::context>& tls,
                const WebSettings& settings, grpc::GenericStub& stub);

  void Run();
  // Since when it waits for a request to come whole; time_point::max() while it answers one.
  std::chrono::steady_clock::time_point waiting_since() const;
  // Instead of Run: answers that there are too many connections.
  void Refuse();
  // Breaks the connection off, and its call.
  void Close();

 private:
  using Request = boost::beast::http::request<boost::beast::http::string_body>;
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;

  void AwaitRequest(std::chrono::milliseconds patience);
  void ReadHead();
  void ReadBody();
  void OnRequest(boost::beast::error_code error);
  void RefuseUnreadable(boost::beast::error_code error);
  void Handle(const Request& request);
  void ServeFile(const Request& request);
  void ServePage(const Request& request, const WebSettings::Page& page);
  void Preflight(const Request& request);
  void RefuseWith(boost::beast::http::status status, const std::string& text);
  template <class Body>
  void Send(boost::beast::http::response<Body> response);
  void Hang();

  void StartCall(Request request);
  void SendMessage(const grpc::ByteBuffer& message);
  void SendTrailers(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers);
  void SendChunk(const std::string& frame, bool last);
  void OnChunk(boost::beast::error_code error, bool last);
  // Notices while a call is under way that the browser has gone.
  void Listen();
  void OnHeard(boost::beast::error_code error, std::size_t bytes);
  void NextRequest();

  WebStream stream_;
  std::string peer_;  // "192.0.2.1"
  std::atomic<std::chrono::steady_clock::rep> waiting_since_;
  boost::beast::flat_buffer buffer_;
  const WebSettings& settings_;
  grpc::GenericStub& stub_;
  std::optional<Parser> parser_;

  // Of the present request.
  std::string origin_;  // a page's that may call; empty where there is none
  bool keep_alive_ = false;
  // Of the present call.
  std::shared_ptr<WebCall> call_;
  std::string head_;                 // of the response; sent with its first chunk
  bool text_ = false;                // frames in base64
  std::string lead_, tail_;          // of the chunk being written, before and after ...
  std::vector<grpc::Slice> slices_;  // ... the message's bytes
  bool listening_ = false;
  bool answered_ = false;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_CONNECTION_H_
