#include "server/service/web/web_connection.h"

#include <boost/asio/dispatch.hpp>
#include <boost/asio/strand.hpp>
#include <sstream>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
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

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

WebConnection::WebConnection(net::ip::tcp::socket socket, const std::shared_ptr<net::ssl::context>& tls,
                             const WebSettings& settings, grpc::GenericStub& stub)
    : stream_(std::move(socket), tls), buffer_(kMaxHeaderBytes + kMaxPipelinedBytes), settings_(settings), stub_(stub) {
  beast::error_code error;
  const auto peer = stream_.tcp().socket().remote_endpoint(error);
  peer_ = error ? "unknown" : peer.address().to_string();  // an empty peer would be a call from within the process
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
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(settings_.max_body_bytes);
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
                            if (error) return self->OnRequest(error);
                            self->ReadBody();
                          });
}

void WebConnection::ReadBody() {
  stream_.tcp().expires_after(settings_.idle_time);
  http::async_read(stream_, buffer_, *parser_,
                   [self = shared_from_this()](beast::error_code error, std::size_t) { self->OnRequest(error); });
}

void WebConnection::OnRequest(beast::error_code error) {
  waiting_since_ = std::chrono::steady_clock::time_point::max().time_since_epoch().count();
  if (!error) {
    Handle(parser_->get());
  } else if (error == http::error::body_limit || error == http::error::header_limit ||
             error.category() == http::make_error_code(http::error::bad_method).category()) {
    RejectUnreadable(error);
  } else {
    Disconnect();
  }
}

// The start of the next request is unknown after a malformed or oversized one, so the connection is closed.
void WebConnection::RejectUnreadable(beast::error_code error) {
  origin_.clear();
  keep_alive_ = false;
  if (error == http::error::end_of_stream || error == http::error::partial_message) return Disconnect();
  if (error == http::error::body_limit) {
    return SendError(
        http::status::payload_too_large,
        absl::StrCat("the request body exceeds the limit of ", settings_.max_body_bytes, " bytes (--max-message-mb)"));
  }
  if (error == http::error::header_limit) {
    return SendError(http::status::request_header_fields_too_large,
                     absl::StrCat("the request header exceeds the limit of ", kMaxHeaderBytes, " bytes"));
  }
  SendError(http::status::bad_request, "the request is not HTTP/1.1");
}

void WebConnection::Handle(const Request& request) {
  keep_alive_ = request.keep_alive();
  origin_.clear();
  const std::string_view origin = View(request[http::field::origin]);
  if (!IsAllowedOrigin(origin, View(request[http::field::host]), settings_.allowed_origins)) {
    return SendError(http::status::forbidden,
                     "this origin is not allowed to call the server; allow it with --allow-origin");
  }
  origin_ = std::string(origin);
  if (request.method() == http::verb::options) return Preflight(request);
  if (request.method() == http::verb::get || request.method() == http::verb::head) return HandleGet(request);
  if (request.method() != http::verb::post)
    return SendError(http::status::method_not_allowed, "the method must be GET, HEAD or POST");
  if (!IsGrpcWeb(View(request[http::field::content_type]))) {
    return SendError(http::status::unsupported_media_type,
                     "a POST must be a gRPC-web call: Content-Type application/grpc-web+proto");
  }
  if (request.version() < 11) return SendError(http::status::http_version_not_supported, "gRPC-web needs HTTP/1.1");
  StartCall(parser_->release());
}

void WebConnection::Preflight(const Request& request) {
  http::response<http::empty_body> response(http::status::no_content, request.version());
  AllowOrigin(origin_, response);
  response.set(http::field::access_control_allow_methods, "POST, GET, HEAD, OPTIONS");
  response.set(http::field::access_control_allow_headers, request[http::field::access_control_request_headers]);
  response.set(http::field::access_control_max_age, "7200");
  Send(std::move(response));
}

void WebConnection::SendPage(const Request& request, const WebSettings::Page& page) {
  http::response<http::string_body> response(http::int_to_status(page.status), request.version(), page.text);
  response.set(http::field::content_type, page.type);
  response.set(http::field::cache_control, "no-store");
  response.prepare_payload();
  if (request.method() == http::verb::head) response.body().clear();
  Send(std::move(response));
}

void WebConnection::HandleGet(const Request& request) {
  if (settings_.page) {
    const auto page = settings_.page(View(request.target()), View(request[http::field::authorization]));
    if (page.has_value()) return SendPage(request, *page);
  }
  const auto file = FindStaticFile(settings_.root, View(request.target()));
  if (!file.ok()) {
    const auto status = absl::IsNotFound(file.status()) ? http::status::not_found : http::status::bad_request;
    return SendError(status, std::string(file.status().message()));
  }
  SendFile(request, *file);
}

void WebConnection::SendFile(const Request& request, const StaticFile& file) {
  if (View(request[http::field::if_none_match]) == file.etag) {
    http::response<http::empty_body> response(http::status::not_modified, request.version());
    SetFileHeaders(file, settings_.allowed_origins, response);
    return Send(std::move(response));
  }
  beast::error_code error;
  http::file_body::value_type body;
  body.open(file.path.c_str(), beast::file_mode::scan, error);
  if (error) return SendError(http::status::not_found, "the file cannot be read");
  const std::uint64_t size = body.size();
  if (request.method() == http::verb::head) {
    http::response<http::empty_body> response(http::status::ok, request.version());
    SetFileHeaders(file, settings_.allowed_origins, response);
    response.content_length(size);
    return Send(std::move(response));
  }
  http::response<http::file_body> response(std::piecewise_construct, std::make_tuple(std::move(body)),
                                           std::make_tuple(http::status::ok, request.version()));
  SetFileHeaders(file, settings_.allowed_origins, response);
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
    if (error || !self->keep_alive_) return self->Disconnect();
    self->AwaitRequest(self->settings_.idle_time);
  });
}

void WebConnection::Disconnect() {
  if (call_ != nullptr) std::exchange(call_, nullptr)->Cancel();
  beast::error_code ignored;
  stream_.tcp().socket().shutdown(net::ip::tcp::socket::shutdown_both, ignored);
  stream_.tcp().close();
}

void WebConnection::StartCall(Request request) {
  const std::string_view content_type = View(request[http::field::content_type]);
  base64_ = IsGrpcWebText(content_type);
  call_ended_ = false;
  head_ = CallHead(base64_, stream_.encrypted(), origin_, keep_alive_);
  auto message = ParseRequestBody(std::move(request.body()), base64_);
  if (!message.ok()) {
    return SendTrailers({grpc::StatusCode::INVALID_ARGUMENT, std::string(message.status().message())}, {});
  }
  WebCall::Request call{.method = std::string(View(request.target())),
                        .message = *std::move(message),
                        .metadata = CallMetadata(request, peer_),
                        .timeout = ParseTimeout(View(request["grpc-timeout"]))};
  const auto self = shared_from_this();
  call_ =
      WebCall::Start(stub_, std::move(call), stream_.get_executor(),
                     {.message = [self](const grpc::ByteBuffer& bytes) { self->SendMessage(bytes); },
                      .done =
                          [self](const grpc::Status& status, const std::multimap<std::string, std::string>& trailers) {
                            self->SendTrailers(status, trailers);
                          }});
  WatchForDisconnect();
}

void WebConnection::SendMessage(const grpc::ByteBuffer& message) {
  message.Dump(&slices_);
  const std::array<char, 5> prefix = MessagePrefix(static_cast<std::uint32_t>(message.Length()));
  std::string frame(prefix.data(), prefix.size());
  if (base64_) {
    for (const grpc::Slice& slice : slices_) frame.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
    slices_.clear();
  }
  SendChunk(frame, false);
}

void WebConnection::SendTrailers(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers) {
  slices_.clear();
  SendChunk(TrailersFrame(status, trailers), true);
}

void WebConnection::SendChunk(const std::string& frame, bool last) {
  const std::string encoded = base64_ ? absl::Base64Escape(frame) : frame;
  std::size_t size = encoded.size();
  for (const grpc::Slice& slice : slices_) size += slice.size();
  chunk_head_ = absl::StrCat(std::exchange(head_, {}), absl::Hex(size), "\r\n", encoded);
  chunk_tail_ = last ? "\r\n0\r\n\r\n" : "\r\n";
  std::vector<net::const_buffer> buffers = {net::buffer(chunk_head_)};
  for (const grpc::Slice& slice : slices_) buffers.emplace_back(slice.begin(), slice.size());
  buffers.push_back(net::buffer(chunk_tail_));
  stream_.tcp().expires_after(settings_.idle_time);
  net::async_write(stream_, buffers, [self = shared_from_this(), last](beast::error_code error, std::size_t) {
    self->OnChunkSent(error, last);
  });
}

void WebConnection::OnChunkSent(beast::error_code error, bool last) {
  slices_.clear();
  if (error) return Disconnect();
  if (!last) {
    if (call_ != nullptr) call_->ReadNext();
    return;
  }
  call_ = nullptr;
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
