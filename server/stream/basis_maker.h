// Computes the basis of a session's frames on a thread of its own, and a new one when the motion changes.
#ifndef PHRENIC_SERVER_STREAM_BASIS_MAKER_H_
#define PHRENIC_SERVER_STREAM_BASIS_MAKER_H_

#include <future>
#include <memory>
#include <vector>

#include "absl/time/time.h"
#include "server/stream/basis.h"

namespace phrenic::stream {

// Not thread-safe: only the publisher's thread calls it. Encoder makes one at the first request for CODEC_BASIS. A
// basis is computed on another thread, one at a time; the destructor waits for it.
class BasisMaker {
 public:
  // `predicted` is the codec of CODEC_PREDICTED for `shape`. `shape` has all streamed vertices and is copied.
  BasisMaker(const RestShape& shape, std::shared_ptr<const Codec> predicted);

  // Samples a frame at intervals and keeps it if the current basis approximates it poorly. Starts a new basis when
  // enough frames are kept, at growing intervals. `positions` are 3 x n, of all streamed vertices [m]; `now` is the
  // time of the frame. It looks at a frame every 100 ms at most, and keeps the last 24 whose largest residual is above
  // 0.05 mm. The intervals between two bases double from 2 s to 60 s.
  void See(const Floats& positions, absl::Time now);

  // Returns the newest basis; null before the first. See replaces it, so copy the pointer.
  const std::shared_ptr<const Basis>& newest() const { return newest_; }

 private:
  using Made = std::shared_ptr<const Basis>;

  // True if a vertex is more than 0.05 mm from the sum of its projections onto the shapes; without a basis, from rest.
  // `moved` are displacements [m].
  bool IsPoorlyApproximated(const Floats& moved) const;
  // Starts the computation from the frames kept and from the previous shapes, so that earlier motion stays
  // representable.
  void Make(absl::Time now);
  // Takes a basis that is finished, without waiting. One without shapes is dropped.
  void TakeMade();

  const Floats rest_;
  const std::shared_ptr<const Codec> predicted_;
  std::vector<Floats> seen_;  // displacements that the basis approximates poorly
  Made newest_;
  std::future<Made> making_;                                                         // invalid while none is computed
  absl::Time next_look_ = absl::InfinitePast(), next_basis_ = absl::InfinitePast();  // on the clock of `now`
  absl::Duration interval_;                                                          // after the next basis
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_BASIS_MAKER_H_
