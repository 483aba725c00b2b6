#include "server/stream/basis_maker.h"

#include <algorithm>
#include <utility>

namespace phrenic::stream {
namespace {

constexpr absl::Duration kBetweenLooks = absl::Milliseconds(100);
constexpr std::size_t kMostSeen = 24;  // frames: half a quiet breath
constexpr double kMuch = 5e-5;         // residual of a poor approximation [m]: half of the viewers' bound
constexpr absl::Duration kFirstPatience = absl::Seconds(2), kLongestPatience = absl::Seconds(60);

// New frames and the previous shapes, so that the new basis still spans earlier motion.
std::shared_ptr<const Basis> MakeFrom(const Floats& rest, const Codec& predicted, std::vector<Floats> seen,
                                      const Basis* before) {
  if (before != nullptr) seen.insert(seen.end(), before->shapes.begin(), before->shapes.end());
  auto basis = MakeBasis(predicted, rest, FindShapes(seen), before == nullptr ? 1 : before->epoch + 1);
  if (!basis.ok() || basis->shapes.empty()) return nullptr;
  return std::make_shared<const Basis>(*std::move(basis));
}

}  // namespace

BasisMaker::BasisMaker(const RestShape& shape, std::shared_ptr<const Codec> predicted)
    : rest_(shape.rest), predicted_(std::move(predicted)), interval_(kFirstPatience) {}

// The residual after projecting onto each shape in turn: shapes are nearly orthogonal.
bool BasisMaker::IsPoorlyApproximated(const Floats& moved) const {
  Floats left = moved;
  if (newest_ != nullptr) {
    for (const Floats& shape : newest_->shapes) {
      left -= left.cwiseProduct(shape).sum() / std::max(shape.squaredNorm(), 1e-20F) * shape;
    }
  }
  return left.size() > 0 && left.colwise().norm().maxCoeff() > kMuch;
}

void BasisMaker::See(const Floats& positions, absl::Time now) {
  TakeMade();
  if (now < next_look_) return;
  next_look_ = now + kBetweenLooks;
  Floats moved = positions - rest_;
  if (!IsPoorlyApproximated(moved)) return;
  if (seen_.size() == kMostSeen) seen_.erase(seen_.begin());
  seen_.push_back(std::move(moved));
  if (seen_.size() == kMostSeen && now >= next_basis_ && !making_.valid()) Make(now);
}

void BasisMaker::Make(absl::Time now) {
  next_basis_ = now + interval_;
  interval_ = std::min(2 * interval_, kLongestPatience);
  making_ = std::async(std::launch::async, [rest = rest_, predicted = predicted_, seen = std::exchange(seen_, {}),
                                            before = newest_]() mutable {
    return MakeFrom(rest, *predicted, std::move(seen), before.get());
  });
}

void BasisMaker::TakeMade() {
  if (!making_.valid() || making_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  Made made = making_.get();
  if (made != nullptr) newest_ = std::move(made);
}

}  // namespace phrenic::stream
