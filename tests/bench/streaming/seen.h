// What viewers saw, added up.
#ifndef PHRENIC_TESTS_BENCH_STREAMING_SEEN_H_
#define PHRENIC_TESTS_BENCH_STREAMING_SEEN_H_

#include <cstdint>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "phrenic/v1/frames.pb.h"

namespace phrenic::bench {

struct Sight {
  std::vector<double> ages;  // of the frames that came, when they came [s], ascending
  std::int64_t frames = 0, bytes = 0;
  std::int64_t gaps = 0;          // frames that were missed
  double largest_error = 0;       // the coarsest bound of a frame [mm]
  double Age(double part) const;  // the quantile; 0 where nothing came [s]
};

// Any thread may call.
class Seen {
 public:
  // Of one viewer: `last` is the sequence of its frame before, 0 where there was none.
  void Add(const v1::Frame& frame, std::int64_t bytes, std::int64_t last);
  // What was added since the last call.
  Sight Take();

 private:
  absl::Mutex mutex_;
  Sight sight_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_STREAMING_SEEN_H_
