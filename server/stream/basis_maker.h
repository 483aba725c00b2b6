// Makes the basis of a session's frames, and a new one when they move in other ways, on a thread of its own.
#ifndef PHRENIC_SERVER_STREAM_BASIS_MAKER_H_
#define PHRENIC_SERVER_STREAM_BASIS_MAKER_H_

#include <future>
#include <memory>
#include <vector>

#include "absl/time/time.h"
#include "server/stream/basis.h"

namespace phrenic::stream {

// Not thread-safe: the publisher's thread has it, and the work is done by another.
class BasisMaker {
 public:
  // `predicted` is the codec of CODEC_PREDICTED for that shape.
  BasisMaker(const RestShape& shape, std::shared_ptr<const Codec> predicted);

  // Looks at a frame now and then, and keeps it where the present basis leaves much of it; once enough are kept a new
  // basis is made, less and less often.
  void See(const Floats& positions, absl::Time now);

  // The newest; null before there is one.
  const std::shared_ptr<const Basis>& newest() const { return newest_; }

 private:
  using Made = std::shared_ptr<const Basis>;

  bool LeavesMuch(const Floats& moved) const;
  void Make(absl::Time now);
  void TakeMade();

  const Floats rest_;
  const std::shared_ptr<const Codec> predicted_;
  std::vector<Floats> seen_;  // displacements that are new to the basis
  Made newest_;
  std::future<Made> making_;
  absl::Time next_look_ = absl::InfinitePast(), next_basis_ = absl::InfinitePast();
  absl::Duration patience_;
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_BASIS_MAKER_H_
