#include "server/mechanics/state.h"

#include <array>
#include <bit>

namespace phrenic {
namespace {

// Four sums side by side: each waits for its own last product only.
using HashLanes = std::array<std::uint64_t, 4>;

void Mix(double value, std::uint64_t& hash) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * kPrime;
  hash ^= hash >> 29;  // word-wise FNV-1a leaves the low bits blind to the high ones without it
}

void Mix(const double* values, Eigen::Index count, HashLanes& lanes) {
  const Eigen::Index whole = count / 4 * 4;
  for (Eigen::Index i = 0; i < whole; i += 4) {
    for (int lane = 0; lane < 4; ++lane) Mix(values[i + lane], lanes[lane]);
  }
  for (Eigen::Index i = whole; i < count; ++i) Mix(values[i], lanes[0]);
}

}  // namespace

std::uint64_t StateHash(const State& state) {
  constexpr std::uint64_t kBasis = 0xcbf29ce484222325;
  HashLanes lanes = {kBasis, kBasis + 1, kBasis + 2, kBasis + 3};
  Mix(state.x.data(), state.x.size(), lanes);
  Mix(state.v.data(), state.v.size(), lanes);
  Mix(state.scalars.q.data(), state.scalars.q.size(), lanes);
  Mix(state.scalars.v.data(), state.scalars.v.size(), lanes);
  std::uint64_t hash = kBasis;
  Mix(state.time, hash);
  Mix(state.phase, hash);
  for (const std::uint64_t lane : lanes) Mix(std::bit_cast<double>(lane), hash);
  return hash;
}

}  // namespace phrenic
