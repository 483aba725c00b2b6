#include "server/stream/decoder/prediction.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace phrenic::stream {
namespace {

constexpr int kUnitBits = 12;
static_assert(kUnit == 1 << kUnitBits);

// Compilers make one SIMD vector of it, or four numbers where there is no SIMD.
typedef std::int32_t Int4 __attribute__((vector_size(16)));
typedef std::uint32_t UInt4 __attribute__((vector_size(16)));

UInt4 Load(const std::int32_t* from) {
  UInt4 vector;
  std::memcpy(&vector, from, sizeof vector);
  return vector;
}

}  // namespace

Prediction::Prediction(const NeighbourWeights& weights) {
  const std::size_t places = weights.order.size();
  neighbours_.resize(kMostNeighbours * places, {.at = 0, .weight = 0});
  std::int64_t most = kUnit;
  for (std::size_t place = 0; place < places; ++place) {
    std::int64_t sum = 0;
    for (int i = weights.first[place]; i < weights.first[place + 1]; ++i) {
      neighbours_[kMostNeighbours * place + i - weights.first[place]] = {.at = 4 * weights.places[i],
                                                                         .weight = weights.weights[i]};
      sum += std::abs(static_cast<std::int64_t>(weights.weights[i]));
    }
    most = std::max(most, sum);
  }
  largest_ = static_cast<std::int32_t>((std::numeric_limits<std::int32_t>::max() - kUnit) / most);
}

bool Prediction::AddFast(PaddedSteps& steps) const {
  constexpr UInt4 kHalf = {kUnit / 2, kUnit / 2, kUnit / 2, kUnit / 2};
  const auto limit = static_cast<std::uint32_t>(largest_);
  UInt4 beyond = {0, 0, 0, 0};  // all bits set where a value exceeds the limit
  std::int32_t* own = steps.data();
  const Neighbour* neighbour = neighbours_.data();
  const std::int32_t* const first = steps.data();
  for (std::size_t left = steps.size() / 4; left > 0; --left, own += 4, neighbour += kMostNeighbours) {
    UInt4 sum = kHalf, other = {0, 0, 0, 0};
    for (int i = 0; i < kMostNeighbours; i += 2) {
      const auto a = static_cast<std::uint32_t>(neighbour[i].weight);
      const auto b = static_cast<std::uint32_t>(neighbour[i + 1].weight);
      sum += UInt4{a, a, a, a} * Load(first + neighbour[i].at);
      other += UInt4{b, b, b, b} * Load(first + neighbour[i + 1].at);
    }
    const UInt4 value = Load(own) + (UInt4)((Int4)(sum + other) >> kUnitBits);
    std::memcpy(own, &value, sizeof value);
    // Values in -limit .. limit are 0 .. 2 limit after the addition, all others are larger.
    beyond |= (UInt4)(value + limit > UInt4{2 * limit, 2 * limit, 2 * limit, 2 * limit});
  }
  return (beyond[0] | beyond[1] | beyond[2] | beyond[3]) == 0;
}

void Prediction::AddExactly(PaddedSteps& steps) const {
  for (std::size_t place = 0; 4 * place < steps.size(); ++place) {
    const Neighbour* const neighbours = &neighbours_[kMostNeighbours * place];
    for (int axis = 0; axis < 3; ++axis) {
      std::int64_t sum = kUnit / 2;
      for (int i = 0; i < kMostNeighbours; ++i) {
        sum += static_cast<std::int64_t>(neighbours[i].weight) * steps[neighbours[i].at + axis];
      }
      steps[4 * place + axis] = static_cast<std::int32_t>(steps[4 * place + axis] + (sum >> kUnitBits));
    }
  }
}

}  // namespace phrenic::stream
