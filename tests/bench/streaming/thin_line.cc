#include "tests/bench/streaming/thin_line.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>

#include "absl/time/clock.h"

namespace phrenic::bench {
namespace {

constexpr int kPatience = 50;      // between two looks at whether to end [ms]
constexpr int kBuffer = 16 << 10;  // of the line itself [bytes]

bool Readable(const Socket& socket) {
  pollfd polled = {.fd = socket.handle(), .events = POLLIN, .revents = 0};
  return poll(&polled, 1, kPatience) > 0;
}

}  // namespace

ThinLine::ThinLine(int server_port, double bytes_per_second)
    : server_port_(server_port), bytes_per_second_(bytes_per_second), listening_(ListenSomewhere(&port_)) {
  accepting_ = std::thread([this] { Accept(); });
}

ThinLine::~ThinLine() {
  stopped_ = true;
  accepting_.join();
  for (Call& call : calls_) {
    call.up.join();
    call.down.join();
  }
}

void ThinLine::Accept() {
  while (!stopped_) {
    if (!Readable(listening_)) continue;
    Call& call = calls_.emplace_back();
    call.client = Socket(accept(listening_.handle(), nullptr, nullptr));
    call.server = ConnectTo(server_port_);
    setsockopt(call.server.handle(), SOL_SOCKET, SO_RCVBUF, &kBuffer, sizeof kBuffer);
    call.up = std::thread([this, &call] { Carry(call.client, call.server, false); });
    call.down = std::thread([this, &call] { Carry(call.server, call.client, true); });
  }
}

absl::Time ThinLine::Room(std::size_t bytes) {
  absl::MutexLock lock(&mutex_);
  free_ = std::max(free_, absl::Now()) + absl::Seconds(static_cast<double>(bytes) / bytes_per_second_);
  return free_;
}

void ThinLine::Carry(const Socket& from, const Socket& to, bool slowly) {
  std::array<char, 1460> packet{};
  while (!stopped_) {
    if (frozen_) absl::SleepFor(absl::Milliseconds(kPatience));
    if (frozen_ || !Readable(from)) continue;
    const ssize_t got = recv(from.handle(), packet.data(), packet.size(), 0);
    if (got <= 0) break;
    const auto bytes = static_cast<std::size_t>(got);
    if (slowly) absl::SleepFor(Room(bytes) - absl::Now());
    if (!SendAll(to, {packet.data(), bytes})) break;
  }
  shutdown(to.handle(), SHUT_RDWR);
  shutdown(from.handle(), SHUT_RDWR);
}

}  // namespace phrenic::bench
