#include "server/mesh/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace phrenic {

BoxTree::BoxTree(const Points& centres, int leaf) : order_(static_cast<size_t>(centres.cols())) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.push_back({0, static_cast<int>(centres.cols())});
  for (int node = 0; node < static_cast<int>(nodes_.size()); ++node) Split(node, centres, leaf);
}

void BoxTree::Split(int node, const Points& centres, int leaf) {
  const auto [first, count, left] = nodes_[node];
  if (count <= leaf) return;
  Eigen::AlignedBox3d box;
  for (int i = first; i < first + count; ++i) box.extend(centres.col(order_[i]));
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto begin = order_.begin() + first, half = begin + count / 2;
  std::nth_element(begin, half, begin + count,
                   [&](int a, int b) { return std::pair(centres(axis, a), a) < std::pair(centres(axis, b), b); });
  nodes_[node].left = static_cast<int>(nodes_.size());
  nodes_.push_back({first, count / 2});
  nodes_.push_back({first + count / 2, count - count / 2});
}

}  // namespace phrenic
