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
#include "server/service/web/web_reply.h"
#include "server/service/web/web_request.h"
#include "server/service/web/web_stream.h"
#include "server/service/web/web_watch.h"

namespace phrenic::service {

// Settings shared by all connections, which they outlive. The gateway owns them; they do not change.
struct WebSettings {
  std::string root;                             // folder of the viewer's files
  std::vector<std::string> allowed_origins;     // beside the server's own and loopback origins
  std::vector<std::string> allowed_hosts;       // beside loopback, the address in use and the certificate's names
  std::size_t max_message_bytes = 0;            // of a request, without its gRPC-web prefix [bytes]
  std::chrono::milliseconds head_time{10'000};  // timeout of a request's header, and of the TLS handshake
  std::chrono::milliseconds idle_time{60'000};  // timeout of a whole body, of each write, and between requests
  // The headers of a request that tell who sends it. The views point into the request.
  struct Credentials {
    std::string_view authorization, join;
  };
  // A response that is not a file.
  struct Page {
    unsigned status = 200;  // HTTP status code
    std::string type, text;
    std::vector<std::pair<std::string, std::string>> headers = {};  // further ones
  };
  // A request to a form's target: GET, or POST of an application/x-www-form-urlencoded body of 64 KiB at most. Pages of
  // any origin may send it.
  struct Form {
    bool post = false;
    std::string target, body, cookies;
  };
  // Returns the generated page of a target such as "/healthz"; nullopt if the target is a static file. Thread-safe.
  // Runs on the connection's strand, so it must be short. Null: there are only static files.
  std::function<std::optional<Page>(std::string_view target, const Credentials& credentials)> page;
  // Answers the requests to targets that begin with "/lti/"; calls `done` once, on any thread, before the gateway is
  // destroyed. Returns at once. Null: there are none, and their targets are as all others.
  std::function<void(Form form, std::function<void(Page page)> done)> form = nullptr;
  // Answers a call without gRPC: returns the serialized response or the error; nullopt if the call is to be made.
  // Thread-safe. Runs on the connection's strand, so it must be short. Null: every call is made.
  using Answer = std::optional<absl::StatusOr<std::string>>;
  std::function<Answer(const WebCall::Request& call)> answer = nullptr;
  // Origins that may frame the viewer, beside allowed_origins.
  std::vector<std::string> framers = {};
  // Returns under which name the sender of a request has its part of the budget for bodies, empty for its IP address;
  // nullopt if it is not known, so that its bodies must be small. Null: everybody is known. Thread-safe. Called for
  // bodies above 64 KiB.
  std::function<std::optional<std::string>(const Credentials& credentials)> known;
};

// What all connections share; it outlives them.
struct WebShared {
  const WebSettings& settings;
  const AllowedHosts& hosts;
  grpc::GenericStub& stub;
  BodyBudget& bodies;
  WatchClaims& watches;
};

// Runs on its own strand. Run, Refuse, Close and waiting_since are thread-safe.
//
// The gateway makes it for each accepted socket and knows it by a weak pointer. The handlers of pending operations keep
// it alive: it is destroyed when none is left, after Disconnect. It has no lock: the strand orders all operations.
//
// Limits: 16 KiB for a request's header, max_message_bytes for the message in a body, 64 KiB for a body of an unknown
// caller. A request that exceeds them, or that Judge refuses, is answered and the connection closed. During a call it
// reads 64 KiB of pipelined requests ahead. Statuses: 400 malformed, 401 a long body of an unknown caller, 403 origin,
// 404 no such file, 405 method, 413 body, 415 type, 421 host, 431 header, 503 no memory or no connection left, 505 HTTP
// version. Errors of a call are in its trailers, under 200.
class WebConnection final : public std::enable_shared_from_this<WebConnection> {
 public:
  // Without encryption if `tls` is null. Starts nothing. `shared` outlives the connection.
  WebConnection(boost::asio::ip::tcp::socket socket, const std::shared_ptr<boost::asio::ssl::context>& tls,
                const WebShared& shared);

  // Serves requests until the client disconnects or a timeout expires. Performs the TLS handshake first.
  void Run();
  // Answers 503 Service Unavailable and disconnects. Call it instead of Run if the connection limit is reached. Only
  // disconnects with TLS, since a handshake would cost too much.
  void Refuse();
  // Disconnects and cancels the current call. Takes effect soon after it returns.
  void Close();
  // Returns when the connection began to wait for its current request; time_point::max() while it answers one. The
  // gateway closes the connection that has waited longest if it has no room.
  std::chrono::steady_clock::time_point waiting_since() const;

 private:
  using Request = boost::beast::http::request<boost::beast::http::string_body>;
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;

  // Waits for the first byte of a request for `timeout`; the rest of its header has head_time. Forgets the previous
  // one.
  void AwaitRequest(std::chrono::milliseconds timeout);
  // Reads the header, part of which may be in the buffer.
  void ReadHead();
  // Judges the request by its head, then reads the body.
  void OnHead();
  // Checks framing, host, origin, method and metadata, in this order. nullopt: the request is served.
  std::optional<Refusal> Judge(const HttpRequestHead& head);
  // Decides how long the body may be and takes a part of the budget for it.
  std::optional<Refusal> AdmitBody(const HttpRequestHead& head);
  // Handles the request when the body is complete. The whole body has idle_time.
  void ReadBody();
  // Rejects a body of unknown length once it exceeds its limit or the budget.
  void OnBodyPart();
  // Answers a request that is not HTTP or is too large, and disconnects; disconnects without an answer otherwise.
  void OnReadError(boost::beast::error_code error);
  // Answers a request whose rest is not read, and disconnects.
  void Reject(const Refusal& refusal);
  // Answers OPTIONS by Preflight, POST by a call, GET and HEAD by a page or a file.
  void Handle(const Request& request);
  // True if settings_.form answers the target.
  bool IsForm(std::string_view target) const;
  // Judge for a form.
  std::optional<Refusal> JudgeForm(const HttpRequestHead& head);
  void HandleForm(const Request& request);
  // Asks settings_.page first.
  void HandleGet(const Request& request);
  // Sends no body for HEAD. Pages are not cached.
  void SendPage(bool with_body, const WebSettings::Page& page);
  // 304 if the browser has this version. Reads the file in parts while it is sent.
  void SendFile(const Request& request, const StaticFile& file);
  // Answers a CORS preflight request (Fetch standard section 3.3.6).
  void Preflight(const Request& request);
  static WebSettings::Credentials CredentialsOf(const HttpRequestHead& head);
  // Sends plain text that a page of an allowed origin may read.
  void SendError(boost::beast::http::status status, const std::string& text);
  // Adds the common headers, writes within idle_time, and then waits for the next request or disconnects.
  template <class Body>
  void Send(boost::beast::http::response<Body> response);
  // Cancels the call and closes the socket. Idempotent.
  void Disconnect();
  // Ends the sending half and discards what still arrives, for a short time and up to a limit. A close with unread
  // bytes would reset the connection and may lose the answer (RFC 9112 section 9.6).
  void Linger();
  // `left` is what may still be discarded [bytes].
  void DiscardInput(std::size_t left);

  // Answers with trailers alone if the body is not one message, or if the method has no valid name.
  void StartCall(Request request);
  // Writes the response of a call that was answered without gRPC.
  void SendAnswer(const absl::StatusOr<std::string>& answer);
  // Claims the watch of a call to WatchFrames.
  void ClaimWatch(WebCall::Request& call);
  // Writes one message of the call; the next is read when this one is written.
  void SendMessage(const grpc::ByteBuffer& message);
  // Writes the messages of watch_ that may be sent now, one at a time.
  void PumpWatch();
  // Writes the last chunk, with the headers if no message was sent; after the message that is being written.
  void SendTrailers(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers);
  // Goes on after a message: with waiting trailers, or with the next message.
  void OnMessageSent(boost::beast::error_code error);
  // Ends the request.
  void OnTrailersSent(boost::beast::error_code error);
  // Reads during a call, to detect that the browser disconnected. Keeps pipelined requests in buffer_.
  void WatchForDisconnect();
  // Disconnects if the browser is gone, which cancels the call.
  void OnReadDuringCall(boost::beast::error_code error, std::size_t bytes);
  // Requires: no read is in progress.
  void NextRequest();

  WebStream stream_;                                           // its executor is the strand
  std::string peer_;                                           // IP address; "unknown" if the client disconnected early
  boost::asio::ip::address local_;                             // that the client connected to
  std::atomic<std::chrono::steady_clock::rep> waiting_since_;  // time_point::max() while it answers
  boost::beast::flat_buffer buffer_;                           // bytes that are read and not used
  const WebShared& shared_;
  const WebSettings& settings_;
  std::optional<Parser> parser_;  // of the current request

  // State of the current request.
  std::string origin_;  // an allowed one; empty if the request has none
  bool keep_alive_ = false;
  bool unread_ = false;                           // a part of the request was not read
  std::size_t body_limit_ = 0;                    // [bytes]
  std::optional<BodyBudget::Share> body_share_;   // of a long body, until the call ends
  std::optional<WebCall::Request> call_request_;  // without its message
  // State of the current call.
  std::shared_ptr<WebCall> call_;     // null: none in progress
  std::unique_ptr<WebWatch> watch_;   // of a call to WatchFrames; null: none in progress
  WebReply reply_;                    // its response
  std::function<void()> when_sent_;   // sends the trailers, which wait for a message; null: none wait
  bool reading_during_call_ = false;  // a read of WatchForDisconnect is pending
  bool call_ended_ = false;           // its last chunk was sent
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_CONNECTION_H_
