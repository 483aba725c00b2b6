#include "server/mechanics/state.h"

#include <bit>

namespace phrenic {
namespace {

void Mix(const double* values, Eigen::Index count, std::uint64_t& hash) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  for (Eigen::Index i = 0; i < count; ++i) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(values[i])) * kPrime;
    hash ^= hash >> 29;  // word-wise FNV-1a leaves the low bits blind to the high ones without it
  }
}

}  // namespace

std::uint64_t StateHash(const State& state) {
  std::uint64_t hash = 0xcbf29ce484222325;
  Mix(&state.time, 1, hash);
  Mix(&state.phase, 1, hash);
  Mix(state.x.data(), state.x.size(), hash);
  Mix(state.v.data(), state.v.size(), hash);
  return hash;
}

}  // namespace phrenic
