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

constexpr std::uint32_t kMostHeaderBytes = 16 << 10;
constexpr std::size_t kHearAtOnce = 4 << 10;  // [bytes]
constexpr std::size_t kMostHeard = 64 << 10;  // of requests sent ahead [bytes]

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

WebConnection::WebConnection(net::ip::tcp::socket socket, const std::shared_ptr<net::ssl::context>& tls,
                             const WebSettings& settings, grpc::GenericStub& stub)
    : stream_(std::move(socket), tls), buffer_(kMostHeaderBytes + kMostHeard), settings_(settings), stub_(stub) {
  beast::error_code gone;
  const auto peer = stream_.tcp().socket().remote_endpoint(gone);
  peer_ = gone ? "unknown" : peer.address().to_string();  // never empty: that is the process itself
  waiting_since_ = std::chrono::steady_clock::now().time_since_epoch().count();
}

std::chrono::steady_clock::time_point WebConnection::waiting_since() const {
  return std::chrono::steady_clock::time_point(std::chrono::steady_clock::duration(waiting_since_.load()));
}

void WebConnection::Run() {
  net::dispatch(stream_.get_executor(), [self = shared_from_this()] {
    self->stream_.tcp().expires_after(self->settings_.head_time);
    self->stream_.AsyncHandshake([self](beast::error_code error) {
      if (error) return self->Hang();
      self->AwaitRequest(self->settings_.head_time);
    });
  });
}

void WebConnection::Refuse() {
  net::dispatch(stream_.get_executor(), [self = shared_from_this()] {
    if (self->stream_.encrypted()) return self->Hang();  // a handshake is too much work
    self->RefuseWith(http::status::service_unavailable,
                     "there are too many connections (--max-connections); try again later");
  });
}

void WebConnection::Close() {
  net::dispatch(stream_.get_executor(), [self = shared_from_this()] { self->Hang(); });
}

// A connection may be silent for longer than the head of a request may take once it has begun.
void WebConnection::AwaitRequest(std::chrono::milliseconds patience) {
  waiting_since_ = std::chrono::steady_clock::now().time_since_epoch().count();
  parser_.emplace();
  parser_->header_limit(kMostHeaderBytes);
  parser_->body_limit(settings_.max_body_bytes);
  if (buffer_.size() > 0) return ReadHead();
  stream_.tcp().expires_after(patience);
  stream_.async_read_some(buffer_.prepare(kHearAtOnce),
                          [self = shared_from_this()](beast::error_code error, std::size_t bytes) {
                            if (error) return self->Hang();
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
    RefuseUnreadable(error);
  } else {
    Hang();
  }
}

// After a request that is no HTTP, or too large, nobody knows where the next one begins.
void WebConnection::RefuseUnreadable(beast::error_code error) {
  origin_.clear();
  keep_alive_ = false;
  if (error == http::error::end_of_stream || error == http::error::partial_message) return Hang();
  if (error == http::error::body_limit) {
    return RefuseWith(http::status::payload_too_large,
                      absl::StrCat("a request has at most ", settings_.max_body_bytes, " bytes (--max-message-mb)"));
  }
  if (error == http::error::header_limit) {
    return RefuseWith(http::status::request_header_fields_too_large,
                      absl::StrCat("a request's header has at most ", kMostHeaderBytes, " bytes"));
  }
  RefuseWith(http::status::bad_request, "the request is not HTTP/1.1");
}

void WebConnection::Handle(const Request& request) {
  keep_alive_ = request.keep_alive();
  origin_.clear();
  const std::string_view origin = View(request[http::field::origin]);
  if (!MayCall(origin, View(request[http::field::host]), settings_.allowed_origins)) {
    return RefuseWith(http::status::forbidden, "pages of this origin may not call; allow it with --allow-origin");
  }
  origin_ = std::string(origin);
  if (request.method() == http::verb::options) return Preflight(request);
  if (request.method() == http::verb::get || request.method() == http::verb::head) return ServeFile(request);
  if (request.method() != http::verb::post) return RefuseWith(http::status::method_not_allowed, "GET, HEAD or POST");
  if (!IsGrpcWeb(View(request[http::field::content_type]))) {
    return RefuseWith(http::status::unsupported_media_type, "a POST is a gRPC-web call, application/grpc-web+proto");
  }
  if (request.version() < 11) return RefuseWith(http::status::http_version_not_supported, "gRPC-web needs HTTP/1.1");
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

void WebConnection::ServePage(const Request& request, const WebSettings::Page& page) {
  http::response<http::string_body> response(http::int_to_status(page.status), request.version(), page.text);
  response.set(http::field::content_type, page.type);
  response.set(http::field::cache_control, "no-store");
  response.prepare_payload();
  if (request.method() == http::verb::head) response.body().clear();
  Send(std::move(response));
}

void WebConnection::ServeFile(const Request& request) {
  if (settings_.page) {
    const auto page = settings_.page(View(request.target()), View(request[http::field::authorization]));
    if (page.has_value()) return ServePage(request, *page);
  }
  const auto file = FindStaticFile(settings_.root, View(request.target()));
  if (!file.ok()) {
    const auto status = absl::IsNotFound(file.status()) ? http::status::not_found : http::status::bad_request;
    return RefuseWith(status, std::string(file.status().message()));
  }
  if (View(request[http::field::if_none_match]) == file->etag) {
    http::response<http::empty_body> response(http::status::not_modified, request.version());
    SetFileHeaders(*file, settings_.allowed_origins, response);
    return Send(std::move(response));
  }
  beast::error_code error;
  http::file_body::value_type body;
  body.open(file->path.c_str(), beast::file_mode::scan, error);
  if (error) return RefuseWith(http::status::not_found, "the page cannot be read");
  const std::uint64_t size = body.size();
  if (request.method() == http::verb::head) {
    http::response<http::empty_body> response(http::status::ok, request.version());
    SetFileHeaders(*file, settings_.allowed_origins, response);
    response.content_length(size);
    return Send(std::move(response));
  }
  http::response<http::file_body> response(std::piecewise_construct, std::make_tuple(std::move(body)),
                                           std::make_tuple(http::status::ok, request.version()));
  SetFileHeaders(*file, settings_.allowed_origins, response);
  response.content_length(size);
  Send(std::move(response));
}

void WebConnection::RefuseWith(http::status status, const std::string& text) {
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
  auto kept = std::make_shared<http::response<Body>>(std::move(response));
  stream_.tcp().expires_after(settings_.idle_time);
  http::async_write(stream_, *kept, [self = shared_from_this(), kept](beast::error_code error, std::size_t) {
    if (error || !self->keep_alive_) return self->Hang();
    self->AwaitRequest(self->settings_.idle_time);
  });
}

void WebConnection::Hang() {
  if (call_ != nullptr) std::exchange(call_, nullptr)->Abandon();
  beast::error_code ignored;
  stream_.tcp().socket().shutdown(net::ip::tcp::socket::shutdown_both, ignored);
  stream_.tcp().close();
}

void WebConnection::StartCall(Request request) {
  const std::string_view content_type = View(request[http::field::content_type]);
  text_ = IsGrpcWebText(content_type);
  answered_ = false;
  head_ = CallHead(text_, stream_.encrypted(), origin_, keep_alive_);
  auto message = ParseRequestBody(std::move(request.body()), text_);
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
  Listen();
}

void WebConnection::SendMessage(const grpc::ByteBuffer& message) {
  message.Dump(&slices_);
  const std::array<char, 5> prefix = MessagePrefix(static_cast<std::uint32_t>(message.Length()));
  std::string frame(prefix.data(), prefix.size());
  if (text_) {
    for (const grpc::Slice& slice : slices_) frame.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
    slices_.clear();
  }
  SendChunk(frame, false);
}

void WebConnection::SendTrailers(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers) {
  slices_.clear();
  SendChunk(TrailersFrame(status, trailers), true);
}

// Writes `frame` and then slices_ as one chunk of the body.
void WebConnection::SendChunk(const std::string& frame, bool last) {
  const std::string encoded = text_ ? absl::Base64Escape(frame) : frame;
  std::size_t size = encoded.size();
  for (const grpc::Slice& slice : slices_) size += slice.size();
  lead_ = absl::StrCat(std::exchange(head_, {}), absl::Hex(size), "\r\n", encoded);
  tail_ = last ? "\r\n0\r\n\r\n" : "\r\n";
  std::vector<net::const_buffer> buffers = {net::buffer(lead_)};
  for (const grpc::Slice& slice : slices_) buffers.emplace_back(slice.begin(), slice.size());
  buffers.push_back(net::buffer(tail_));
  stream_.tcp().expires_after(settings_.idle_time);
  net::async_write(stream_, buffers, [self = shared_from_this(), last](beast::error_code error, std::size_t) {
    self->OnChunk(error, last);
  });
}

void WebConnection::OnChunk(beast::error_code error, bool last) {
  slices_.clear();
  if (error) return Hang();
  if (!last) {
    if (call_ != nullptr) call_->ReadNext();
    return;
  }
  call_ = nullptr;
  answered_ = true;
  if (!keep_alive_) return Hang();
  if (!listening_) return NextRequest();
  stream_.tcp().cancel();  // OnHeard goes on with the next request
}

void WebConnection::Listen() {
  if (buffer_.size() >= kMostHeard) return;
  listening_ = true;
  stream_.tcp().expires_never();
  stream_.async_read_some(
      buffer_.prepare(kHearAtOnce),
      [self = shared_from_this()](beast::error_code error, std::size_t bytes) { self->OnHeard(error, bytes); });
}

void WebConnection::OnHeard(beast::error_code error, std::size_t bytes) {
  listening_ = false;
  buffer_.commit(bytes);
  if (answered_ && (!error || error == net::error::operation_aborted)) return NextRequest();
  if (error) return Hang();
  Listen();
}

void WebConnection::NextRequest() {
  answered_ = false;
  AwaitRequest(settings_.idle_time);
}

}  // namespace phrenic::service
