// A line to the server that carries so many bytes a second, in user space.
#ifndef PHRENIC_TESTS_BENCH_STREAMING_THIN_LINE_H_
#define PHRENIC_TESTS_BENCH_STREAMING_THIN_LINE_H_

#include <atomic>
#include <list>
#include <thread>

#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "tests/bench/streaming/sockets.h"

namespace phrenic::bench {

// Forwards bytes from the server at a limited rate, shared by all connections, and bytes to the server at once.
class ThinLine {
 public:
  ThinLine(int server_port, double bytes_per_second);
  ~ThinLine();
  int port() const { return port_; }
  // Carries nothing from now on, as a line that was cut; neither end is notified.
  void Freeze() { frozen_ = true; }

 private:
  struct Call {
    Socket client, server;
    std::thread up, down;
  };
  void Accept();
  void Carry(const Socket& from, const Socket& to, bool slowly);
  // When this much has gone over the line after all before it.
  absl::Time Room(std::size_t bytes) ABSL_LOCKS_EXCLUDED(mutex_);

  const int server_port_;
  const double bytes_per_second_;
  int port_ = 0;
  const Socket listening_;
  std::atomic<bool> frozen_ = false, stopped_ = false;
  absl::Mutex mutex_;
  absl::Time free_ ABSL_GUARDED_BY(mutex_) = absl::InfinitePast();
  std::list<Call> calls_;  // of the accepting thread, until it has ended
  std::thread accepting_;
};

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_STREAMING_THIN_LINE_H_
