// The bricks of a regular grid that a closed surface reaches, each with the fraction of its volume that is inside.
// Fields are trilinear in a brick: a mesh of hexahedra in which the surface is embedded (Duester, Parvizian, Yang and
// Rank, Comput Methods Appl Mech Eng 2008;197:3768).
#ifndef PHRENIC_SERVER_MECHANICS_LUNGS_BRICK_GRID_H_
#define PHRENIC_SERVER_MECHANICS_LUNGS_BRICK_GRID_H_

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "server/mesh/mesh.h"
#include "server/mesh/nearest.h"

namespace phrenic {

// Corner c of a brick has the coordinates (c & 1, c >> 1 & 1, c >> 2 & 1), in edges.
using BrickCorners = Eigen::Matrix<int, 8, 1>;
using BrickWeights = Eigen::Matrix<double, 8, 1>;
using BrickGradients = Eigen::Matrix<double, 3, 8>;

// A brick is split into kBrickSplit parts along each axis; part (i, j, k) is at index i + kBrickSplit (j + kBrickSplit
// k).
inline constexpr int kBrickSplit = 4;
inline constexpr int kBrickParts = kBrickSplit * kBrickSplit * kBrickSplit;
using BrickFractions = std::array<float, kBrickParts>;

// The trilinear shape functions at a point of a brick, `local` in 0..1 inside, and their gradients by `local`.
BrickWeights WeightsAt(const Eigen::Vector3d& local);
BrickGradients GradientsAt(const Eigen::Vector3d& local);

// Immutable, thread-safe.
class BrickGrid {
 public:
  // A point as a position in a brick.
  struct Place {
    int brick = 0;
    Eigen::Vector3d local;  // in edges, 0..1 inside
  };

  // Covers the surface [m] with bricks of `edge` [m], centred on its bounding box. Bricks that hold no volume but the
  // centroid of a triangle are kept. Requires: `surface` is closed and faces outwards.
  BrickGrid(const Mesh& surface, double edge);

  const Points& nodes() const { return nodes_; }  // 3 x n [m], layer by layer along z
  // The first node of each layer, and the number of nodes. A brick joins two successive layers.
  const std::vector<int>& layers() const { return layers_; }
  // The node at each corner of each brick, and the fraction of each of its parts inside the surface, in 0..1.
  const std::vector<BrickCorners>& bricks() const { return bricks_; }
  const std::vector<BrickFractions>& fractions() const { return fractions_; }
  double edge() const { return edge_; }  // [m]
  // The cells of the bounding lattice: the corner of the first [m], their number along each axis, and the index of the
  // brick in each, x fastest; -1: none.
  const Eigen::Vector3d& origin() const { return origin_; }
  const Eigen::Vector3i& cells() const { return cells_; }
  const std::vector<int>& brick_of_cell() const { return brick_of_cell_; }
  // True if the part of a brick that holds the point is inside the surface, or cut by it: within a quarter of an edge.
  bool Holds(const Eigen::Vector3d& point) const;

  // Returns the brick that holds the point, or the one whose centre is nearest, in which fields are extrapolated by at
  // most one edge.
  Place Locate(const Eigen::Vector3d& point) const;

 private:
  int Cell(const Eigen::Vector3i& at) const { return at.x() + cells_.x() * (at.y() + cells_.y() * at.z()); }
  bool HasCell(const Eigen::Vector3i& at) const {
    return (at.array() >= 0).all() && (at.array() < cells_.array()).all();
  }
  // The fraction of each part of each cell, x fastest.
  std::vector<float> FractionsOf(const Mesh& surface) const;
  BrickFractions FractionsIn(const Eigen::Vector3i& cell, const std::vector<float>& fractions) const;
  std::vector<bool> CellsTouched(const Mesh& surface) const;
  void AddBricks(const std::vector<float>& fractions, const std::vector<bool>& touched);
  void NumberNodes();
  Eigen::Vector3d InEdges(const Eigen::Vector3d& point) const { return (point - origin_) / edge_; }

  double edge_;
  Eigen::Vector3d origin_;  // [m]
  Eigen::Vector3i cells_;
  Points nodes_;
  std::vector<int> layers_;
  std::vector<BrickCorners> bricks_;
  std::vector<BrickFractions> fractions_;
  std::vector<int> brick_of_cell_;        // -1: none
  std::vector<Eigen::Vector3i> cell_of_;  // of each brick
  std::optional<NearestSearch> centres_;  // of the bricks
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LUNGS_BRICK_GRID_H_
