// An order of a mesh's vertices in which each can be foretold from those before it, and the weights to do so: the same
// bits on every machine and in every language, as server and viewer each work them out.
#ifndef PHRENIC_SERVER_STREAM_NEIGHBOUR_WEIGHTS_H_
#define PHRENIC_SERVER_STREAM_NEIGHBOUR_WEIGHTS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "server/stream/codec.h"

namespace phrenic::stream {

// Places are positions in the order: place 0 is the first vertex's.
struct NeighbourWeights {
  std::vector<int> order;             // the vertex at each place, breadth-first from the lowest, neighbours ascending
  std::vector<int> first;             // n + 1: the range of each place in `places` and `weights`
  std::vector<int> places;            // of at most kMostNeighbours before it: neighbours, then neighbours' neighbours
  std::vector<std::int32_t> weights;  // in units of 1/kUnit; they sum to kUnit, none for the first place alone
};

inline constexpr int kMostNeighbours = 8;
inline constexpr int kUnit = 4096;

// The weights are those of a linear function of the rest position, fitted to the neighbours by regularised least
// squares and read off at the vertex: w_j = 1 - d_j.c, c = (r I + sum d d^T)^-1 sum d, d_j = x_j - x, r = max |d|^2/32,
// over their sum. A vertex with no neighbour before it is foretold by the one before it.
NeighbourWeights MakeNeighbourWeights(const RestShape& shape);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_NEIGHBOUR_WEIGHTS_H_
