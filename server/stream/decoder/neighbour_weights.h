// An order of a mesh's vertices and weights that predict each vertex from earlier ones. Server and viewer compute them
// independently, with the same bits on every machine.
#ifndef PHRENIC_SERVER_STREAM_DECODER_NEIGHBOUR_WEIGHTS_H_
#define PHRENIC_SERVER_STREAM_DECODER_NEIGHBOUR_WEIGHTS_H_

#include <cstdint>
#include <vector>

#include "server/stream/decoder/rest_mesh.h"

namespace phrenic::stream {

// A place is an index into the order.
struct NeighbourWeights {
  std::vector<int> order;             // the vertex at each place: breadth-first from the lowest, ascending
  std::vector<int> first;             // n + 1: the range of each place in `places` and `weights`
  std::vector<int> places;            // at most kMostNeighbours earlier places: neighbours, then their neighbours
  std::vector<std::int32_t> weights;  // [1/kUnit]; sum to kUnit, except at the first place, which has none
};

inline constexpr int kMostNeighbours = 8;
inline constexpr int kUnit = 4096;

// The weights evaluate a linear function of the rest position, fitted to the neighbours by regularised least squares,
// at the vertex: w_j = 1 - d_j.c, c = (r I + sum d d^T)^-1 sum d, d_j = x_j - x, r = max |d|^2/32, divided by their
// sum. A vertex without earlier neighbours is predicted from the previous vertex. Weights are equal where the fit is
// ill-conditioned (|w| above 4 times their sum). Computed in double, with sums, products and one division in a fixed
// order, so that all clients round alike. Thread-safe.
NeighbourWeights MakeNeighbourWeights(const RestMesh& mesh);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_NEIGHBOUR_WEIGHTS_H_
