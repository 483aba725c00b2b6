// Computes the basis of a session's frames on a thread of its own, and a new one when the motion changes.
#ifndef PHRENIC_SERVER_STREAM_BASIS_MAKER_H_
#define PHRENIC_SERVER_STREAM_BASIS_MAKER_H_

#include <future>
#include <memory>
#include <vector>

#include "absl/time/time.h"
#include "server/stream/basis.h"

namespace phrenic::stream {

// Not thread-safe: only the publisher's thread calls it.
class BasisMaker {
 public:
  // `predicted` is the codec of CODEC_PREDICTED for `shape`.
  BasisMaker(const RestShape& shape, std::shared_ptr<const Codec> predicted);

  // Samples a frame at intervals and keeps it if the current basis approximates it poorly. Starts a new basis when
  // enough frames are kept, at growing intervals.
  void See(const Floats& positions, absl::Time now);

  // Returns the newest basis; null before the first.
  const std::shared_ptr<const Basis>& newest() const { return newest_; }

 private:
  using Made = std::shared_ptr<const Basis>;

  bool IsPoorlyApproximated(const Floats& moved) const;
  void Make(absl::Time now);
  void TakeMade();

  const Floats rest_;
  const std::shared_ptr<const Codec> predicted_;
  std::vector<Floats> seen_;  // displacements that the basis approximates poorly
  Made newest_;
  std::future<Made> making_;
  absl::Time next_look_ = absl::InfinitePast(), next_basis_ = absl::InfinitePast();
  absl::Duration interval_;
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_BASIS_MAKER_H_
