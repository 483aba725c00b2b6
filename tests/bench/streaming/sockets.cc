#include "tests/bench/streaming/sockets.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace phrenic::bench {
namespace {

sockaddr_in Loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

}  // namespace

Socket::~Socket() {
  if (handle_ >= 0) close(handle_);
}

Socket ConnectTo(int port) {
  Socket socket(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address = Loopback(port);
  constexpr int kOn = 1;
  setsockopt(socket.handle(), IPPROTO_TCP, TCP_NODELAY, &kOn, sizeof kOn);
  if (connect(socket.handle(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) return Socket();
  return socket;
}

Socket ListenSomewhere(int* port) {
  Socket socket(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address = Loopback(0);
  socklen_t size = sizeof address;
  bind(socket.handle(), reinterpret_cast<sockaddr*>(&address), size);
  getsockname(socket.handle(), reinterpret_cast<sockaddr*>(&address), &size);
  listen(socket.handle(), 64);
  *port = ntohs(address.sin_port);
  return socket;
}

bool SendAll(const Socket& socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(socket.handle(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

}  // namespace phrenic::bench
