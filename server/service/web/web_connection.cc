#include "server/service/web/web_connection.h"

#include <boost/asio/dispatch.hpp>
#include <boost/asio/strand.hpp>

#include "absl/strings/str_cat.h"
#include "server/service/calls/status.h"
#include "server/service/net/metadata_keys.h"
#include "server/service/web/grpc_web.h"
#include "server/service/web/origins.h"
#include "server/service/web/static_files.h"
#include "server/service/web/web_headers.h"

namespace phrenic::service {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;

constexpr std::uint32_t kMaxHeaderBytes = 16 << 10;
constexpr std::size_t kReadBytes = 4 << 10;
constexpr std::size_t kMaxPipelinedBytes = 64 << 10;  // of requests sent before the current one is answered
constexpr std::size_t kSmallBodyBytes = 64 << 10;     // bodies that every caller may send, and that no budget counts
constexpr std::chrono::seconds kLingerTime(2);
constexpr std::size_t kLingerBytes = 1 << 20;
constexpr std::string_view kWatchMethod = "/phrenic.v1.FrameService/WatchFrames";

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

// Returns the longest body that can hold a message [bytes]: with its prefix, in base64 if `text`.
std::size_t LimitOf(bool text, std::size_t max_message_bytes) {
  constexpr std::size_t kFramePrefix = 5, kBlock = 3, kEncodedBlock = 4;
  const std::size_t bytes = max_message_bytes + kFramePrefix;
  return text ? (bytes + kBlock - 1) / kBlock * kEncodedBlock : bytes;
}

Refusal TooLong(bool known, std::size_t limit) {
  if (known) {
    return {http::status::payload_too_large,
            absl::StrCat("the request body exceeds the limit of ", limit, " bytes (--max-message-mb)")};
  }
  return {http::status::unauthorized,
          absl::StrCat("authorization: a request body above ", limit, " bytes requires an account or a join link")};
}

Refusal Busy() {
  return {http::status::service_unavailable,
          "the server receives as many long requests as it has memory for (--max-message-mb); try again"};
}

}  // namespace

WebConnection::WebConnection(net::ip::tcp::socket socket, const std::shared_ptr<net::ssl::context>& tls,
                             const WebShared& shared)
    : stream_(std::move(socket), tls),
      buffer_(kMaxHeaderBytes + kMaxPipelinedBytes),
      shared_(shared),
      settings_(shared.settings),
      reply_(stream_, shared.settings.idle_time) {
  beast::error_code error;
  const auto peer = stream_.tcp().socket().remote_endpoint(error);
  peer_ = error ? "unknown" : peer.address().to_string();  // an empty peer would be a call from within the process
  const auto local = stream_.tcp().socket().local_endpoint(error);
  if (!error) local_ = local.address();
  waiting_since_ = std::chrono::steady_clock::now().time_since_epoch().count();
}

std::chrono::steady_clock::time_point WebConnection::waiting_since() const {
  return std::chrono::steady_clock::time_point(std::chrono::steady_clock::duration(waiting_since_.load()));
}

void WebConnection::Run() {
  net::dispatch(stream_.get_executor(), [self = shared_from_this()] {
    self->stream_.tcp().expires_after(self->settings_.head_time);
    self->stream_.AsyncHandshake([self](beast::error_code error) {
      if (error) return self->Disconnect();
      self->AwaitRequest(self->settings_.head_time);
    });
  });
}

void WebConnection::Refuse() {
  net::dispatch(stream_.get_executor(), [self = shared_from_this()] {
    if (self->stream_.encrypted()) return self->Disconnect();  // a handshake would cost too much
    self->SendError(http::status::service_unavailable,
                    "the server has reached its connection limit (--max-connections); try again later");
  });
}

void WebConnection::Close() {
  net::dispatch(stream_.get_executor(), [self = shared_from_this()] { self->Disconnect(); });
}

// The first byte of a request may take `timeout`, the rest of its header head_time.
void WebConnection::AwaitRequest(std::chrono::milliseconds timeout) {
  waiting_since_ = std::chrono::steady_clock::now().time_since_epoch().count();
  body_share_.reset();
  call_request_.reset();
  origin_.clear();
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(LimitOf(true, settings_.max_message_bytes));
  if (buffer_.size() > 0) return ReadHead();
  stream_.tcp().expires_after(timeout);
  stream_.async_read_some(buffer_.prepare(kReadBytes),
                          [self = shared_from_this()](beast::error_code error, std::size_t bytes) {
                            if (error) return self->Disconnect();
                            self->buffer_.commit(bytes);
                            self->ReadHead();
                          });
}

void WebConnection::ReadHead() {
  stream_.tcp().expires_after(settings_.head_time);
  http::async_read_header(stream_, buffer_, *parser_,
                          [self = shared_from_this()](beast::error_code error, std::size_t) {
                            if (error) return self->OnReadError(error);
                            self->OnHead();
                          });
}

void WebConnection::OnHead() {
  const Request& request = parser_->get();
  keep_alive_ = request.keep_alive();
  std::optional<Refusal> refusal = Judge(request);
  if (!refusal.has_value()) refusal = AdmitBody(request);
  if (refusal.has_value()) return Reject(*refusal);
  parser_->eager(true);
  stream_.tcp().expires_after(settings_.idle_time);  // of the whole body, so that a slow one does not stay
  ReadBody();
}

std::optional<Refusal> WebConnection::Judge(const HttpRequestHead& head) {
  if (auto refusal = CheckFraming(head)) return refusal;
  if (auto refusal = CheckHost(head, shared_.hosts, local_, stream_.certificate())) return refusal;
  if (IsForm(View(head.target()))) return JudgeForm(head);
  const std::string_view origin = View(head[http::field::origin]);
  if (!IsAllowedOrigin(origin, View(head[http::field::host]), settings_.allowed_origins)) {
    return Refusal{http::status::forbidden,
                   "this origin is not allowed to call the server; allow it with --allow-origin"};
  }
  origin_ = std::string(origin);
  if (auto refusal = CheckMethodAndType(head)) return refusal;
  if (head.method() != http::verb::post) return std::nullopt;
  auto call = CallOf(head, peer_);
  if (call.ok()) {
    call_request_ = *std::move(call);
    return std::nullopt;
  }
  const bool large = absl::IsResourceExhausted(call.status());
  return Refusal{large ? http::status::request_header_fields_too_large : http::status::bad_request,
                 std::string(call.status().message())};
}

bool WebConnection::IsForm(std::string_view target) const {
  return settings_.form != nullptr && target.starts_with("/lti/");
}

std::optional<Refusal> WebConnection::JudgeForm(const HttpRequestHead& head) {
  if (head.method() == http::verb::get) return std::nullopt;
  if (head.method() != http::verb::post) {
    return Refusal{http::status::method_not_allowed, "the method must be GET or POST"};
  }
  if (View(head[http::field::content_type]).starts_with("application/x-www-form-urlencoded")) return std::nullopt;
  return Refusal{http::status::unsupported_media_type,
                 "the body must be a form: Content-Type application/x-www-form-urlencoded"};
}

std::optional<Refusal> WebConnection::AdmitBody(const HttpRequestHead& head) {
  body_limit_ = kSmallBodyBytes;
  const auto length = parser_->content_length();
  if (length.has_value() ? *length <= kSmallBodyBytes : !parser_->chunked()) return std::nullopt;
  if (IsForm(View(head.target()))) return TooLong(true, kSmallBodyBytes);
  const auto caller = settings_.known ? settings_.known(CredentialsOf(head)) : "";
  if (caller.has_value()) {
    body_limit_ = LimitOf(IsGrpcWebText(View(head[http::field::content_type])), settings_.max_message_bytes);
    body_share_.emplace(shared_.bodies, caller->empty() ? peer_ : *caller);
  }
  if (!length.has_value()) return std::nullopt;
  if (*length > body_limit_) return TooLong(caller.has_value(), body_limit_);
  return body_share_->GrowTo(*length) ? std::nullopt : std::optional(Busy());
}

void WebConnection::ReadBody() {
  if (parser_->is_done()) return Handle(parser_->get());
  http::async_read_some(stream_, buffer_, *parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (error) return self->OnReadError(error);
    self->OnBodyPart();
  });
}

// A body of unknown length takes its part of the budget as it grows.
void WebConnection::OnBodyPart() {
  const std::string& body = parser_->get().body();
  if (body.size() > body_limit_) return Reject(TooLong(body_share_.has_value(), body_limit_));
  if (body_share_.has_value() && body.size() > kSmallBodyBytes && !body_share_->GrowTo(body.capacity())) {
    return Reject(Busy());
  }
  ReadBody();
}

// The start of the next request is unknown after a malformed or oversized one, so the connection is closed.
void WebConnection::OnReadError(beast::error_code error) {
  const bool unreadable = error.category() == http::make_error_code(http::error::bad_method).category();
  if (!unreadable || error == http::error::end_of_stream || error == http::error::partial_message) return Disconnect();
  if (error == http::error::body_limit) {
    return Reject(TooLong(true, LimitOf(true, settings_.max_message_bytes)));
  }
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return Reject({http::status::request_header_fields_too_large,
                   absl::StrCat("the request header exceeds the limit of ", kMaxHeaderBytes, " bytes")});
  }
  Reject({http::status::bad_request, "the request is not HTTP/1.1"});
}

void WebConnection::Reject(const Refusal& refusal) {
  keep_alive_ = false;
  unread_ = true;
  SendError(refusal.status, refusal.text);
}

void WebConnection::Handle(const Request& request) {
  waiting_since_ = std::chrono::steady_clock::time_point::max().time_since_epoch().count();
  if (IsForm(View(request.target()))) return HandleForm(request);
  if (request.method() == http::verb::options) return Preflight(request);
  if (request.method() == http::verb::post) return StartCall(parser_->release());
  HandleGet(request);
}

void WebConnection::Preflight(const Request& request) {
  http::response<http::empty_body> response(http::status::no_content, request.version());
  if (!AllowPreflight(origin_, View(request[http::field::access_control_request_headers]), response)) {
    return SendError(http::status::bad_request, "Access-Control-Request-Headers: must be names of headers");
  }
  Send(std::move(response));
}

WebSettings::Credentials WebConnection::CredentialsOf(const HttpRequestHead& head) {
  return {View(head[http::field::authorization]), View(head["x-join"])};
}

void WebConnection::SendPage(bool with_body, const WebSettings::Page& page) {
  http::response<http::string_body> response(http::int_to_status(page.status), 11, page.text);
  for (const auto& [name, value] : page.headers) response.insert(name, value);
  response.set(http::field::content_type, page.type);
  response.set(http::field::cache_control, "no-store");
  response.prepare_payload();
  if (!with_body) response.body().clear();
  Send(std::move(response));
}

void WebConnection::HandleForm(const Request& request) {
  stream_.tcp().expires_never();  // the answer has its own limits of time
  settings_.form({.post = request.method() == http::verb::post,
                  .target = std::string(View(request.target())),
                  .body = request.body(),
                  .cookies = std::string(View(request[http::field::cookie]))},
                 [self = shared_from_this()](const WebSettings::Page& page) {
                   net::dispatch(self->stream_.get_executor(), [self, page] { self->SendPage(true, page); });
                 });
}

void WebConnection::HandleGet(const Request& request) {
  if (settings_.page) {
    const auto page = settings_.page(View(request.target()), CredentialsOf(request));
    if (page.has_value()) return SendPage(request.method() != http::verb::head, *page);
  }
  const auto file = FindStaticFile(settings_.root, View(request.target()), View(request[http::field::accept_encoding]));
  if (!file.ok()) {
    const auto status = absl::IsNotFound(file.status()) ? http::status::not_found : http::status::bad_request;
    return SendError(status, std::string(file.status().message()));
  }
  SendFile(request, *file);
}

void WebConnection::SendFile(const Request& request, const StaticFile& file) {
  if (View(request[http::field::if_none_match]) == file.etag) {
    http::response<http::empty_body> response(http::status::not_modified, request.version());
    SetFileHeaders(file, settings_.framers, response);
    return Send(std::move(response));
  }
  beast::error_code error;
  http::file_body::value_type body;
  body.open(file.path.c_str(), beast::file_mode::scan, error);
  if (error) return SendError(http::status::not_found, "the file cannot be read");
  const std::uint64_t size = body.size();
  if (request.method() == http::verb::head) {
    http::response<http::empty_body> response(http::status::ok, request.version());
    SetFileHeaders(file, settings_.framers, response);
    response.content_length(size);
    return Send(std::move(response));
  }
  http::response<http::file_body> response(std::piecewise_construct, std::make_tuple(std::move(body)),
                                           std::make_tuple(http::status::ok, request.version()));
  SetFileHeaders(file, settings_.framers, response);
  response.content_length(size);
  Send(std::move(response));
}

void WebConnection::SendError(http::status status, const std::string& text) {
  http::response<http::string_body> response(status, 11, text + "\n");
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  AllowOrigin(origin_, response);
  response.prepare_payload();
  Send(std::move(response));
}

template <class Body>
void WebConnection::Send(http::response<Body> response) {
  SetCommonHeaders(stream_.encrypted(), response);
  response.keep_alive(keep_alive_);
  auto owned = std::make_shared<http::response<Body>>(std::move(response));
  stream_.tcp().expires_after(settings_.idle_time);
  http::async_write(stream_, *owned, [self = shared_from_this(), owned](beast::error_code error, std::size_t) {
    if (!error && self->unread_) return self->Linger();
    if (error || !self->keep_alive_) return self->Disconnect();
    self->AwaitRequest(self->settings_.idle_time);
  });
}

void WebConnection::Linger() {
  beast::error_code ignored;
  stream_.tcp().socket().shutdown(net::ip::tcp::socket::shutdown_send, ignored);
  body_share_.reset();
  parser_.reset();
  stream_.tcp().expires_after(kLingerTime);
  DiscardInput(kLingerBytes);
}

void WebConnection::DiscardInput(std::size_t left) {
  buffer_.clear();
  stream_.tcp().async_read_some(buffer_.prepare(kReadBytes),
                                [self = shared_from_this(), left](beast::error_code error, std::size_t bytes) {
                                  if (error || bytes >= left) return self->Disconnect();
                                  self->DiscardInput(left - bytes);
                                });
}

void WebConnection::Disconnect() {
  watch_ = nullptr;
  if (call_ != nullptr) std::exchange(call_, nullptr)->Cancel();
  beast::error_code ignored;
  stream_.tcp().socket().shutdown(net::ip::tcp::socket::shutdown_both, ignored);
  stream_.tcp().close();
}

void WebConnection::StartCall(Request request) {
  const bool text = IsGrpcWebText(View(request[http::field::content_type]));
  call_ended_ = false;
  reply_.Begin(CallHead(text, stream_.encrypted(), origin_, keep_alive_), text);
  auto message = ParseRequestBody(std::move(request.body()), text);
  if (!message.ok()) {
    return SendTrailers({grpc::StatusCode::INVALID_ARGUMENT, std::string(message.status().message())}, {});
  }
  WebCall::Request call = *std::exchange(call_request_, std::nullopt);
  call.message = *std::move(message);
  if (const auto answer = settings_.answer ? settings_.answer(call) : std::nullopt) return SendAnswer(*answer);
  ClaimWatch(call);
  const auto self = shared_from_this();
  auto started = WebCall::Start(
      shared_.stub, std::move(call), stream_.get_executor(),
      {.message = [self](const grpc::ByteBuffer& bytes) { self->SendMessage(bytes); },
       .done = [self](const grpc::Status& status, const Metadata& trailers) { self->SendTrailers(status, trailers); }});
  if (!started.ok()) {
    return SendTrailers({grpc::StatusCode::UNIMPLEMENTED, std::string(started.status().message())}, {});
  }
  call_ = *std::move(started);
  WatchForDisconnect();
}

void WebConnection::SendAnswer(const absl::StatusOr<std::string>& answer) {
  if (!answer.ok()) return SendTrailers(ToGrpc(answer.status()), {});
  const auto sent = [self = shared_from_this()](beast::error_code error) { self->OnMessageSent(error); };
  if (!reply_.SendMessage(std::make_shared<const std::string>(*answer), sent)) {
    when_sent_ = [this] { SendTrailers(grpc::Status::OK, {}); };
    return;
  }
  SendTrailers(grpc::Status::OK, {});
}

// Headers that leave no room for the key are sent without it: the messages then come over gRPC.
void WebConnection::ClaimWatch(WebCall::Request& call) {
  call.metadata.erase(kWatchClaimKey);
  if (call.method != kWatchMethod) return;
  watch_ = std::make_unique<WebWatch>(shared_.watches, stream_.get_executor(), [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->PumpWatch();
  });
  const auto added = call.metadata.emplace(kWatchClaimKey, watch_->key());
  if (!CheckMetadata(call.metadata).ok()) call.metadata.erase(added);
}

void WebConnection::SendMessage(const grpc::ByteBuffer& message) {
  const auto sent = [self = shared_from_this()](beast::error_code error) { self->OnMessageSent(error); };
  if (reply_.SendMessage(message, sent)) OnMessageSent({});
}

void WebConnection::PumpWatch() {
  while (watch_ != nullptr && !reply_.writing()) {
    stream::Bytes message = watch_->Take();
    if (message == nullptr) return;
    const bool at_once = reply_.SendMessage(std::move(message), [self = shared_from_this()](beast::error_code error) {
      if (self->watch_ != nullptr) self->watch_->NoteSent();
      self->OnMessageSent(error);
    });
    if (!at_once) return;
    watch_->NoteSent();
  }
}

void WebConnection::SendTrailers(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers) {
  watch_ = nullptr;
  if (reply_.writing()) {
    when_sent_ = [this, status, trailers] { SendTrailers(status, trailers); };
    return;
  }
  const auto sent = [self = shared_from_this()](beast::error_code error) { self->OnTrailersSent(error); };
  if (reply_.SendTrailers(status, trailers, sent)) OnTrailersSent({});
}

void WebConnection::OnMessageSent(beast::error_code error) {
  const auto trailers = std::exchange(when_sent_, nullptr);
  if (error) return Disconnect();
  if (trailers) return trailers();
  if (watch_ != nullptr) PumpWatch();
  if (call_ != nullptr) call_->ReadNext();
}

void WebConnection::OnTrailersSent(beast::error_code error) {
  if (error) return Disconnect();
  call_ = nullptr;
  body_share_.reset();
  call_ended_ = true;
  if (!keep_alive_) return Disconnect();
  if (!reading_during_call_) return NextRequest();
  stream_.tcp().cancel();  // OnReadDuringCall then calls NextRequest
}

void WebConnection::WatchForDisconnect() {
  if (buffer_.size() >= kMaxPipelinedBytes) return;
  reading_during_call_ = true;
  stream_.tcp().expires_never();
  stream_.async_read_some(buffer_.prepare(kReadBytes),
                          [self = shared_from_this()](beast::error_code error, std::size_t bytes) {
                            self->OnReadDuringCall(error, bytes);
                          });
}

void WebConnection::OnReadDuringCall(beast::error_code error, std::size_t bytes) {
  reading_during_call_ = false;
  buffer_.commit(bytes);
  if (call_ended_ && (!error || error == net::error::operation_aborted)) return NextRequest();
  if (error) return Disconnect();
  WatchForDisconnect();
}

void WebConnection::NextRequest() {
  call_ended_ = false;
  AwaitRequest(settings_.idle_time);
}

}  // namespace phrenic::service
