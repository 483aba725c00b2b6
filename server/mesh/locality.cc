#include "server/mesh/locality.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>

namespace phrenic {
namespace {

// Adjacency in compressed rows: the neighbours of vertex i are of[first[i]] to of[first[i + 1] - 1].
struct Neighbours {
  std::vector<int> first, of;
  int Degree(int i) const { return first[i + 1] - first[i]; }
};

Neighbours FindNeighbours(const Edges& edges, int vertices) {
  Neighbours found{std::vector<int>(vertices + 1, 0), std::vector<int>(edges.size())};
  for (const int vertex : edges.reshaped()) ++found.first[vertex + 1];
  std::partial_sum(found.first.begin(), found.first.end(), found.first.begin());
  std::vector<int> next(found.first.begin(), found.first.end() - 1);
  for (const auto& edge : edges.colwise()) {
    found.of[next[edge[0]]++] = edge[1];
    found.of[next[edge[1]]++] = edge[0];
  }
  return found;
}

// Appends the connected component of `start` in breadth-first order, neighbours by ascending degree.
void AppendComponent(int start, const Neighbours& neighbours, std::vector<bool>& seen, std::vector<int>& order) {
  const auto by_degree = [&neighbours](int a, int b) { return neighbours.Degree(a) < neighbours.Degree(b); };
  size_t next = order.size();
  order.push_back(start);
  seen[start] = true;
  for (; next < order.size(); ++next) {
    const int vertex = order[next];
    const auto level = static_cast<std::ptrdiff_t>(order.size());
    for (int k = neighbours.first[vertex]; k < neighbours.first[vertex + 1]; ++k) {
      const int neighbour = neighbours.of[k];
      if (seen[neighbour]) continue;
      seen[neighbour] = true;
      order.push_back(neighbour);
    }
    std::stable_sort(order.begin() + level, order.end(), by_degree);
  }
}

constexpr double kScattered = 8192;  // mean index distance between the ends of an edge
constexpr int kCurveBits = 10;       // bits of a cell's coordinate along each axis

// Returns the number with two zero bits inserted before each bit.
std::uint32_t Spread(std::uint32_t number) {
  number = (number | number << 16) & 0x030000ff;
  number = (number | number << 8) & 0x0300f00f;
  number = (number | number << 4) & 0x030c30c3;
  return (number | number << 2) & 0x09249249;
}

// Returns a cell's index along the Hilbert curve from its coordinates (Skilling's AxesToTranspose).
std::uint32_t HilbertIndex(std::array<std::uint32_t, 3> x) {
  // Returns all ones if the bit is set, else 0; branch-free, since both are equally likely.
  const auto all = [](std::uint32_t number, int bit) { return 0 - (number >> bit & 1); };
  for (int bit = kCurveBits - 1; bit > 0; --bit) {
    const std::uint32_t below = (1U << bit) - 1;
    for (std::uint32_t& axis : x) {
      const std::uint32_t set = all(axis, bit), swapped = (x[0] ^ axis) & below & ~set;
      x[0] ^= swapped | (below & set);
      axis ^= swapped;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t gray = 0;
  for (int bit = kCurveBits - 1; bit > 0; --bit) gray ^= all(x[2], bit) & ((1U << bit) - 1);
  return Spread(x[0] ^ gray) << 2 | Spread(x[1] ^ gray) << 1 | Spread(x[2] ^ gray);
}

}  // namespace

std::vector<int> CuthillMcKeeOrder(const Edges& edges, int vertices) {
  const Neighbours neighbours = FindNeighbours(edges, vertices);
  std::vector<int> starts(vertices);
  std::iota(starts.begin(), starts.end(), 0);
  std::stable_sort(starts.begin(), starts.end(),
                   [&neighbours](int a, int b) { return neighbours.Degree(a) < neighbours.Degree(b); });
  std::vector<int> order;
  std::vector<bool> seen(vertices, false);
  for (const int start : starts) {
    if (!seen[start] && neighbours.Degree(start) > 0) AppendComponent(start, neighbours, seen, order);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

std::vector<int> CuthillMcKeeIfScattered(const Edges& edges, int vertices) {
  if (edges.cols() == 0) return {};
  const double apart = (edges.row(1) - edges.row(0)).cwiseAbs().cast<double>().mean();
  return apart > kScattered ? CuthillMcKeeOrder(edges, vertices) : std::vector<int>();
}

std::vector<int> HilbertOrder(const ConstPoints& points) {
  if (points.cols() == 0) return {};
  const Eigen::Vector3d low = points.rowwise().minCoeff();
  const double size = (points.rowwise().maxCoeff() - low).maxCoeff();
  const double scale = size > 0 ? ((1 << kCurveBits) - 1) / size : 0;
  std::vector<std::pair<std::uint32_t, int>> cells;
  cells.reserve(static_cast<size_t>(points.cols()));
  for (int i = 0; i < static_cast<int>(points.cols()); ++i) {
    std::array<std::uint32_t, 3> cell{};
    for (int k = 0; k < 3; ++k) cell[k] = static_cast<std::uint32_t>(scale * (points(k, i) - low[k]));
    cells.emplace_back(HilbertIndex(cell), i);
  }
  std::sort(cells.begin(), cells.end());
  std::vector<int> order;
  order.reserve(cells.size());
  for (const auto& [index, i] : cells) order.push_back(i);
  return order;
}

}  // namespace phrenic
