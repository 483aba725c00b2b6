// Viewers over gRPC: each with a connection of its own, as on machines of their own.
#ifndef PHRENIC_TESTS_BENCH_STREAMING_VIEWERS_H_
#define PHRENIC_TESTS_BENCH_STREAMING_VIEWERS_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "phrenic/v1/frames.pb.h"
#include "tests/bench/streaming/seen.h"

namespace phrenic::bench {

struct Wanted {
  int viewers = 1;
  v1::Codec codec = v1::CODEC_PREDICTED;
  double max_fps = 30;
  double bound_mm = 0;  // 0: the server's own, coarser where the line takes too little
  int window = 6;       // frames unacknowledged; 0: they acknowledge nothing
  bool reads = true;    // or take nothing at all after the connection
};

// A request of viewer `number` for the bench's session.
v1::WatchFramesRequest RequestOf(const Wanted& wanted, int number);

inline constexpr char kSession[] = "bench";

// Watches until it is destroyed.
class Viewers {
 public:
  virtual ~Viewers() = default;
  Seen& seen() { return seen_; }
  // Whether each has had a frame within that time.
  bool WaitForAll(absl::Duration longest);

 protected:
  explicit Viewers(int viewers) : missing_(viewers) {}
  void FirstCame() ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  Seen seen_;
  absl::Mutex mutex_;
  int missing_ ABSL_GUARDED_BY(mutex_);
};

std::unique_ptr<Viewers> WatchOverGrpc(const std::string& address, const Wanted& wanted);

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_STREAMING_VIEWERS_H_
