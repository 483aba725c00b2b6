// A bounding volume hierarchy of axis-aligned boxes over items that may move, such as triangles and vertices. Its
// structure is built once; its boxes are refitted to the items.
#ifndef PHRENIC_SERVER_MESH_BOX_TREE_H_
#define PHRENIC_SERVER_MESH_BOX_TREE_H_

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Immutable after construction; thread-safe. The caller keeps the boxes. Fit (into boxes of the right size) and Visit
// do not allocate.
class BoxTree {
 public:
  using Boxes = std::vector<Eigen::AlignedBox3d>;

  BoxTree() = default;
  // Splits the items at the median along the longest side of the bounding box of their centres (3 x n, one column per
  // item) [m], until at most `leaf` (at least 1) are left; ties are split by index.
  BoxTree(const Points& centres, int leaf);

  // The items in the tree's order, in which those of a leaf are adjacent. Fit and Visit count items in this order.
  const std::vector<int>& order() const { return order_; }

  // Refits the boxes: extend(i, box) extends a box by item order()[i]. Resizes `boxes` if needed.
  template <typename Extend>
  void Fit(const Extend& extend, Boxes& boxes) const {
    if (boxes.size() < nodes_.size()) boxes.resize(nodes_.size());
    for (int n = static_cast<int>(nodes_.size()) - 1; n >= 0; --n) {
      const Node& node = nodes_[n];
      boxes[n].setEmpty();
      if (node.left >= 0) {
        boxes[n].extend(boxes[node.left]).extend(boxes[node.left + 1]);
        continue;
      }
      for (int i = node.first; i < node.first + node.count; ++i) extend(i, boxes[n]);
    }
  }

  // Calls visit(i) for each item order()[i] of the leaves whose box is not farther from `point` than limit() [m^2], a
  // squared distance that may shrink meanwhile; the nearer boxes first. Requires: the boxes are fitted.
  template <typename Limit, typename Visitor>
  void Visit(const Boxes& boxes, const Eigen::Vector3d& point, const Limit& limit, const Visitor& visit) const {
    std::array<Near, kMaxStack> stack;
    int depth = 0;
    stack[depth++] = {0, boxes[0].squaredExteriorDistance(point)};
    while (depth > 0) {
      const Near near = stack[--depth];
      if (near.squared > limit()) continue;
      const Node& node = nodes_[near.node];
      if (node.left < 0) {
        for (int i = node.first; i < node.first + node.count; ++i) visit(i);
        continue;
      }
      const Near left = {node.left, boxes[node.left].squaredExteriorDistance(point)};
      const Near right = {node.left + 1, boxes[node.left + 1].squaredExteriorDistance(point)};
      stack[depth++] = left.squared <= right.squared ? right : left;
      stack[depth++] = left.squared <= right.squared ? left : right;
    }
  }

 private:
  static constexpr int kMaxStack = 64;  // nodes to visit; a balanced tree needs one per level

  struct Node {
    int first, count;  // the range of its items in order_
    int left = -1;     // its children are left and left + 1; -1 for a leaf
  };
  // A node to visit, and the squared distance of its box [m^2].
  struct Near {
    int node;
    double squared;
  };
  void Split(int node, const Points& centres, int leaf);

  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_BOX_TREE_H_
