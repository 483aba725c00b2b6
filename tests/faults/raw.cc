#include "tests/faults/raw.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "absl/strings/str_cat.h"

namespace phrenic::faults {
namespace {

constexpr int kPatience = 5000;  // [ms]
constexpr std::size_t kLargestFrame = 16384, kMostKept = std::size_t{1} << 20;

sockaddr_in Loopback(std::uint8_t last, int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl((127U << 24) + last);
  return address;
}

}  // namespace

RawConnection::RawConnection(int port, bool encrypted) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const sockaddr_in from = Loopback(66, 0), to = Loopback(1, port);
  const bool good = bind(socket_, reinterpret_cast<const sockaddr*>(&from), sizeof(from)) == 0 &&
                    connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to)) == 0 &&
                    (!encrypted || Encrypt());
  if (!good) Close();
}

RawConnection::~RawConnection() { Close(); }

void RawConnection::Close() {
  tls_ = nullptr;
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
}

bool RawConnection::Encrypt() {
  static SSL_CTX* const context = SSL_CTX_new(TLS_client_method());
  constexpr unsigned char kHttp2[] = {2, 'h', '2'};
  tls_.reset(SSL_new(context));
  SSL_set_alpn_protos(tls_.get(), kHttp2, sizeof(kHttp2));
  SSL_set_mode(tls_.get(), SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  SSL_set_fd(tls_.get(), socket_);
  if (SSL_connect(tls_.get()) != 1) return false;
  return fcntl(socket_, F_SETFL, O_NONBLOCK) == 0;
}

void RawConnection::ReadArrived() {
  std::array<char, 65536> piece{};
  ssize_t got = 0;
  bool ended = false;
  if (tls_ != nullptr) {
    got = SSL_read(tls_.get(), piece.data(), piece.size());
    const int problem = SSL_get_error(tls_.get(), static_cast<int>(got));
    ended = got <= 0 && problem != SSL_ERROR_WANT_READ && problem != SSL_ERROR_WANT_WRITE;
  } else {
    got = recv(socket_, piece.data(), piece.size(), MSG_DONTWAIT);
    ended = got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
  }
  if (got > 0 && arrived_.size() < kMostKept) arrived_.append(piece.data(), static_cast<std::size_t>(got));
  if (ended) Close();
}

// Removes from `bytes` what was written. False if the connection has ended.
bool RawConnection::WriteSome(std::string_view& bytes) {
  ssize_t sent = 0;
  bool ended = false;
  if (tls_ != nullptr) {
    sent = SSL_write(tls_.get(), bytes.data(), static_cast<int>(std::min<std::size_t>(bytes.size(), 1U << 20)));
    const int problem = SSL_get_error(tls_.get(), static_cast<int>(sent));
    ended = sent <= 0 && problem != SSL_ERROR_WANT_READ && problem != SSL_ERROR_WANT_WRITE;
  } else {
    sent = send(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    ended = sent < 0 && errno != EAGAIN && errno != EINTR;
  }
  if (sent > 0) bytes.remove_prefix(static_cast<std::size_t>(sent));
  return !ended;
}

bool RawConnection::Send(std::string_view bytes, bool read) {
  while (open() && !bytes.empty()) {
    pollfd event = {socket_, static_cast<short>(read ? POLLOUT | POLLIN : POLLOUT), 0};
    if (poll(&event, 1, kPatience) <= 0) return false;
    if ((event.revents & (POLLIN | POLLHUP | POLLERR)) != 0) ReadArrived();
    if (open() && (event.revents & POLLOUT) != 0 && !WriteSome(bytes)) Close();
  }
  return bytes.empty();
}

std::string RawConnection::Receive(double seconds) {
  if (open() && arrived_.empty()) {
    if (tls_ != nullptr && SSL_pending(tls_.get()) > 0) ReadArrived();
  }
  if (open() && arrived_.empty()) {
    pollfd event = {socket_, POLLIN, 0};
    if (poll(&event, 1, static_cast<int>(1e3 * seconds)) > 0) ReadArrived();
  }
  return std::exchange(arrived_, "");
}

int StatusOf(int port, std::string_view request) {
  RawConnection connection(port);
  if (!connection.Send(request)) return 0;
  std::string answer;
  for (int tries = 0; tries < 50 && connection.open() && answer.size() < 12; ++tries) answer += connection.Receive(0.1);
  if (answer.starts_with("HTTP/") && answer.size() >= 12) return std::atoi(answer.substr(9, 3).c_str());
  return connection.open() ? -1 : 0;
}

std::string GrpcMessage(std::string_view message) { return http2::GrpcPrefix(message.size()).append(message); }

Http2::Http2(int port, bool encrypted) : connection_(port, encrypted) {
  connection_.Send(std::string(http2::kPreface) + Frame(FrameType::kSettings, 0, 0, ""));
}

std::uint32_t Http2::Open(const Headers& headers, bool end) {
  const std::uint32_t stream = std::exchange(next_, next_ + 2);
  windows_[stream] = first_window_;
  const auto flags = static_cast<std::uint8_t>(kEndHeaders | (end ? kEndStream : 0));
  Send(Frame(FrameType::kHeaders, flags, stream, HeaderBlock(headers)));
  return stream;
}

std::uint32_t Http2::Call(const std::string& path, const Headers& more, std::string_view message) {
  const std::uint32_t stream = Open(CallHeaders(path, more));
  Send(Frame(FrameType::kData, kEndStream, stream, GrpcMessage(message)));
  return stream;
}

std::size_t Http2::SendData(std::uint32_t stream, std::string_view data) {
  std::string frames;
  std::size_t sent = 0;
  while (sent < data.size()) {
    const std::int64_t allowed = std::min(window_, windows_[stream]);
    const std::size_t next =
        std::min({data.size() - sent, kLargestFrame, static_cast<std::size_t>(std::max<std::int64_t>(allowed, 0))});
    if (next == 0) break;
    frames += Frame(FrameType::kData, 0, stream, data.substr(sent, next));
    window_ -= static_cast<std::int64_t>(next), windows_[stream] -= static_cast<std::int64_t>(next);
    sent += next;
  }
  return frames.empty() || Send(frames) ? sent : 0;
}

void Http2::Read(double seconds) {
  unread_ += connection_.Receive(seconds);
  std::string_view rest = unread_;
  while (rest.size() >= http2::kFrameHead) {
    const http2::FrameHead head(rest);
    if (rest.size() < http2::kFrameHead + head.length) break;
    TakeFrame(head, rest.substr(http2::kFrameHead, head.length));
    rest.remove_prefix(http2::kFrameHead + head.length);
  }
  unread_ = std::string(rest);
}

void Http2::TakeFrame(const http2::FrameHead& head, std::string_view payload) {
  const auto [length, type, flags, stream] = head;
  if (type == FrameType::kSettings && (flags & kAck) == 0) TakeSettings(payload);
  if (type == FrameType::kPing && (flags & kAck) == 0) Send(Frame(FrameType::kPing, kAck, 0, payload));
  if (type == FrameType::kWindow) (stream == 0 ? window_ : windows_[stream]) += http2::BigEndian(payload);
  if (type == FrameType::kGoAway) gone_ = true;
  if (type == FrameType::kData && length > 0) ++data_frames_;
  if (head.EndsStream()) ended_.insert(stream);
}

void Http2::TakeSettings(std::string_view payload) {
  constexpr int kInitialWindow = 4;
  for (; payload.size() >= 6; payload.remove_prefix(6)) {
    if (http2::BigEndian(payload) >> 16 != kInitialWindow) continue;
    const std::int64_t window = http2::BigEndian(payload.substr(2));
    for (auto& [stream, left] : windows_) left += window - first_window_;
    first_window_ = window;
  }
  Send(Frame(FrameType::kSettings, kAck, 0, ""));
}

}  // namespace phrenic::faults
