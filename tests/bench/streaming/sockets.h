// Plain TCP to this machine.
#ifndef PHRENIC_TESTS_BENCH_STREAMING_SOCKETS_H_
#define PHRENIC_TESTS_BENCH_STREAMING_SOCKETS_H_

#include <string_view>
#include <utility>

namespace phrenic::bench {

// A socket or -1; closed with the object.
class Socket {
 public:
  explicit Socket(int handle = -1) : handle_(handle) {}
  Socket(Socket&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Socket();
  int handle() const { return handle_; }

 private:
  int handle_;
};

Socket ConnectTo(int port);
// Listens on a port that was free, which is told.
Socket ListenSomewhere(int* port);
// False where the other end has gone.
bool SendAll(const Socket& socket, std::string_view bytes);

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_STREAMING_SOCKETS_H_
