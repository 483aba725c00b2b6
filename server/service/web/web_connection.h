// One browser connection over HTTP/1.1 (RFC 9112). Requests are handled in sequence; each is answered by a static file,
// by a generated page or by a gRPC-web call.
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
#include "server/service/web/body_budget.h"
#include "server/service/web/hosts.h"
#include "server/service/web/static_files.h"
#include "server/service/web/web_call.h"
#include "server/service/web/web_request.h"
#include "server/service/web/web_stream.h"

namespace phrenic::service {

// Settings shared by all connections, which they outlive.
struct WebSettings {
  std::string root;                          // folder of the viewer's files
  std::vector<std::string> allowed_origins;  // beside the server's own and loopback origins
  std::vector<std::string> allowed_hosts;    // beside loopback, the address in use and the certificate's names
  std::size_t max_message_bytes = 0;
  std::chrono::milliseconds head_time{10'000};  // timeout of a request's header, and of the TLS handshake
  std::chrono::milliseconds idle_time{60'000};  // timeout of a whole body, of each write, and between requests
  // The headers of a request that tell who sends it.
  struct Credentials {
    std::string_view authorization, join;
  };
  struct Page {
    unsigned status = 200;  // HTTP status code
    std::string type, text;
  };
  // Returns the generated page of a target such as "/healthz"; nullopt if the target is a static file. Thread-safe.
  std::function<std::optional<Page>(std::string_view target, const Credentials& credentials)> page;
  // Returns under which name the sender of a request has its part of the budget for bodies, empty for its IP address;
  // nullopt if it is not known, so that its bodies must be small. Null: everybody is known. Thread-safe.
  std::function<std::optional<std::string>(const Credentials& credentials)> known;
};

// What all connections share; it outlives them.
struct WebShared {
  const WebSettings& settings;
  const AllowedHosts& hosts;
  grpc::GenericStub& stub;
  BodyBudget& bodies;
};

// Runs on its own strand. Run, Refuse, Close and waiting_since are thread-safe.
class WebConnection final : public std::enable_shared_from_this<WebConnection> {
 public:
  // Without encryption if `tls` is null.
  WebConnection(boost::asio::ip::tcp::socket socket, const std::shared_ptr<boost::asio::ssl::context>& tls,
                const WebShared& shared);

  // Serves requests until the client disconnects or a timeout expires.
  void Run();
  // Answers 503 Service Unavailable and disconnects. Call it instead of Run if the connection limit is reached.
  void Refuse();
  // Disconnects and cancels the current call.
  void Close();
  // Returns when the connection began to wait for its current request; time_point::max() while it answers one.
  std::chrono::steady_clock::time_point waiting_since() const;

 private:
  using Request = boost::beast::http::request<boost::beast::http::string_body>;
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;

  void AwaitRequest(std::chrono::milliseconds timeout);
  void ReadHead();
  // Judges the request by its head, then reads the body.
  void OnHead();
  std::optional<Refusal> Judge(const HttpRequestHead& head);
  // Decides how long the body may be and takes a part of the budget for it.
  std::optional<Refusal> AdmitBody(const HttpRequestHead& head);
  void ReadBody();
  void OnBodyPart();
  void OnReadError(boost::beast::error_code error);
  // Answers a request whose rest is not read, and disconnects.
  void Reject(const Refusal& refusal);
  void Handle(const Request& request);
  void HandleGet(const Request& request);
  void SendPage(const Request& request, const WebSettings::Page& page);
  void SendFile(const Request& request, const StaticFile& file);
  // Answers a CORS preflight request (Fetch standard section 3.3.6).
  void Preflight(const Request& request);
  static WebSettings::Credentials CredentialsOf(const HttpRequestHead& head);
  void SendError(boost::beast::http::status status, const std::string& text);
  template <class Body>
  void Send(boost::beast::http::response<Body> response);
  void Disconnect();
  // Ends the sending half and discards what still arrives, for a short time and up to a limit. A close with unread
  // bytes would reset the connection and may lose the answer (RFC 9112 section 9.6).
  void Linger();
  void DiscardInput(std::size_t left);

  void StartCall(Request request);
  void SendMessage(const grpc::ByteBuffer& message);
  void SendTrailers(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers);
  // Writes `frame` and then slices_ as one chunk of the body (RFC 9112 section 7.1).
  void SendChunk(const std::string& frame, bool last);
  void OnChunkSent(boost::beast::error_code error, bool last);
  // Reads during a call, to detect that the browser disconnected. Keeps pipelined requests in buffer_.
  void WatchForDisconnect();
  void OnReadDuringCall(boost::beast::error_code error, std::size_t bytes);
  void NextRequest();

  WebStream stream_;
  std::string peer_;                // IP address; "unknown" if the client disconnected early
  boost::asio::ip::address local_;  // that the client connected to
  std::atomic<std::chrono::steady_clock::rep> waiting_since_;
  boost::beast::flat_buffer buffer_;
  const WebShared& shared_;
  const WebSettings& settings_;
  std::optional<Parser> parser_;

  // State of the current request.
  std::string origin_;  // an allowed one; empty if the request has none
  bool keep_alive_ = false;
  bool unread_ = false;                           // a part of the request was not read
  std::size_t body_limit_ = 0;                    // [bytes]
  std::optional<BodyBudget::Share> body_share_;   // of a long body, until the call ends
  std::optional<WebCall::Request> call_request_;  // without its message
  // State of the current call.
  std::shared_ptr<WebCall> call_;
  std::string head_;                     // of the response; sent with its first chunk
  bool base64_ = false;                  // frames are base64
  std::string chunk_head_, chunk_tail_;  // around the message bytes of the chunk being written
  std::vector<grpc::Slice> slices_;      // the message bytes
  bool reading_during_call_ = false;
  bool call_ended_ = false;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_CONNECTION_H_
