// A TCP proxy on loopback that can be cut, as a network between two machines: connections stay open and nothing passes.
#ifndef PHRENIC_TESTS_CLUSTER_CUT_PROXY_H_
#define PHRENIC_TESTS_CLUSTER_CUT_PROXY_H_

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

namespace phrenic::cluster {

// Thread-safe. One thread passes bytes in both directions.
class CutProxy {
 public:
  // Passes connections on to 127.0.0.1:`port`.
  explicit CutProxy(int port) : port_(port), listener_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = Loopback(0);
    bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address);
    listen(listener_, 64);
    socklen_t size = sizeof address;
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    own_port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { Pass(); });
  }
  ~CutProxy() {
    ended_ = true;
    thread_.join();
    for (const Pair& pair : pairs_) Close(pair);
    close(listener_);
  }
  CutProxy(const CutProxy&) = delete;
  CutProxy& operator=(const CutProxy&) = delete;

  int port() const { return own_port_; }
  void Cut(bool cut) { cut_ = cut; }

 private:
  struct Pair {
    int client, server;
  };
  static sockaddr_in Loopback(int port) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    return address;
  }
  static void Close(const Pair& pair) {
    close(pair.client);
    close(pair.server);
  }
  void Accept() {
    const int client = accept(listener_, nullptr, nullptr), server = socket(AF_INET, SOCK_STREAM, 0);
    const sockaddr_in address = Loopback(port_);
    const bool connected = connect(server, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    if (connected) {
      pairs_.push_back({client, server});
    } else {
      Close({client, server});
    }
  }
  // Returns false once either side has closed.
  static bool Move(int from, int to) {
    char bytes[1 << 16];
    const ssize_t size = recv(from, bytes, sizeof bytes, 0);
    return size > 0 && send(to, bytes, static_cast<std::size_t>(size), MSG_NOSIGNAL) == size;
  }
  void Pass() {
    constexpr int kLook = 10;  // [ms]
    while (!ended_) {
      if (cut_) {
        usleep(1000 * kLook);
        continue;
      }
      std::vector<pollfd> waits = {{listener_, POLLIN, 0}};
      for (const Pair& pair : pairs_) {
        waits.push_back({pair.client, POLLIN, 0});
        waits.push_back({pair.server, POLLIN, 0});
      }
      if (poll(waits.data(), waits.size(), kLook) <= 0 || cut_) continue;
      std::vector<Pair> open;
      for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const Pair& pair = pairs_[i];
        const bool good = (waits[1 + 2 * i].revents == 0 || Move(pair.client, pair.server)) &&
                          (waits[2 + 2 * i].revents == 0 || Move(pair.server, pair.client));
        if (good) open.push_back(pair);
        if (!good) Close(pair);
      }
      pairs_ = std::move(open);
      if (waits[0].revents != 0) Accept();
    }
  }

  const int port_, listener_;
  int own_port_ = 0;
  std::vector<Pair> pairs_;  // of the thread
  std::atomic<bool> cut_ = false, ended_ = false;
  std::thread thread_;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_TESTS_CLUSTER_CUT_PROXY_H_
