// Free loopback ports for programs that a test starts. They lie below the ephemeral range (32768-60999, proc(5)'s
// ip_local_port_range), so that no connection takes one between the search and its use.
#ifndef PHRENIC_TESTS_SUPPORT_FREE_PORTS_H_
#define PHRENIC_TESTS_SUPPORT_FREE_PORTS_H_

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>

namespace phrenic {

// Returns true if no program listens at 127.0.0.1:port.
inline bool IsFreePort(int port) {
  const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  const bool is_free = bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(file);
  return is_free;
}

// Returns the first of `count` consecutive free ports, at most 100; 0 if there are none. Each call of a process looks
// further on, and processes that run at the same time begin at different places. Thread-safe.
inline int FreePorts(int count = 1) {
  constexpr int kFirst = 10'000, kPorts = 22'000;
  static std::atomic<int> next = getpid() * 100 % kPorts;
  for (int tries = 0; tries < kPorts / count; ++tries) {
    const int first = kFirst + next.fetch_add(count) % (kPorts - count);
    bool all_free = true;
    for (int port = first; port < first + count && all_free; ++port) all_free = IsFreePort(port);
    if (all_free) return first;
  }
  return 0;
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_SUPPORT_FREE_PORTS_H_
