#include "server/mechanics/lungs/brick_grid.h"

#include <algorithm>
#include <cmath>

#include "server/mesh/line_crossings.h"

namespace phrenic {
namespace {

constexpr int kLines = 2;  // per part and axis, on which its fraction is sampled

Eigen::Vector3i CornerOf(int c) { return {c & 1, c >> 1 & 1, c >> 2 & 1}; }

// Adds the share of a line along z that is inside, between two crossings, to each of `count` parts along it.
void AddSpan(double from, double to, int count, size_t stride, float* parts) {
  const int last = std::min(count - 1, static_cast<int>(std::floor(to)));
  for (int k = std::max(0, static_cast<int>(std::floor(from))); k <= last; ++k) {
    const double length = std::min<double>(to, k + 1) - std::max<double>(from, k);
    parts[k * stride] += static_cast<float>(length / (kLines * kLines));
  }
}

}  // namespace

BrickWeights WeightsAt(const Eigen::Vector3d& local) {
  BrickWeights weights;
  for (int c = 0; c < 8; ++c) {
    const Eigen::Array3d corner = CornerOf(c).cast<double>();
    weights[c] = (1 - corner + (2 * corner - 1) * local.array()).prod();
  }
  return weights;
}

BrickGradients GradientsAt(const Eigen::Vector3d& local) {
  BrickGradients gradients;
  for (int c = 0; c < 8; ++c) {
    const Eigen::Array3d sign = 2 * CornerOf(c).cast<double>().array() - 1;
    const Eigen::Array3d factor = (1 - sign) / 2 + sign * local.array();
    for (int axis = 0; axis < 3; ++axis) {
      gradients(axis, c) = sign[axis] * factor[(axis + 1) % 3] * factor[(axis + 2) % 3];
    }
  }
  return gradients;
}

BrickGrid::BrickGrid(const Mesh& surface, double edge) : edge_(edge) {
  const Eigen::Vector3d low = surface.vertices.rowwise().minCoeff(), high = surface.vertices.rowwise().maxCoeff();
  cells_ = ((high - low) / edge).array().ceil().cast<int>().max(1);
  origin_ = (low + high) / 2 - edge / 2 * cells_.cast<double>();
  AddBricks(FractionsOf(surface), CellsTouched(surface));
}

std::vector<float> BrickGrid::FractionsOf(const Mesh& surface) const {
  const Eigen::Vector3i parts = kBrickSplit * cells_;
  const double across = kLines * kBrickSplit / edge_;
  const Eigen::Vector3d scale(across, across, kBrickSplit / edge_);
  Points in_lines = scale.asDiagonal() * (surface.vertices.colwise() - origin_);
  in_lines.topRows<2>().array() -= 0.5;
  const Eigen::Vector2i lines = kLines * parts.head<2>();
  const auto crossings = LineCrossings(in_lines, surface.triangles, lines);
  std::vector<float> fractions(static_cast<size_t>(parts.prod()), 0.0F);
  const size_t layer = static_cast<size_t>(parts.x()) * parts.y();
  for (int j = 0; j < lines.y(); ++j) {
    for (int i = 0; i < lines.x(); ++i) {
      const std::vector<double>& along = crossings[static_cast<size_t>(j) * lines.x() + i];
      float* first = &fractions[i / kLines + static_cast<size_t>(parts.x()) * (j / kLines)];
      for (size_t c = 0; c + 1 < along.size(); c += 2) AddSpan(along[c], along[c + 1], parts.z(), layer, first);
    }
  }
  return fractions;
}

BrickFractions BrickGrid::FractionsIn(const Eigen::Vector3i& cell, const std::vector<float>& fractions) const {
  const Eigen::Vector3i parts = kBrickSplit * cells_;
  BrickFractions in_cell;
  for (int p = 0; p < kBrickParts; ++p) {
    const Eigen::Vector3i within(p % kBrickSplit, p / kBrickSplit % kBrickSplit, p / (kBrickSplit * kBrickSplit));
    const Eigen::Vector3i at = kBrickSplit * cell + within;
    in_cell[p] =
        fractions[at.x() + static_cast<size_t>(parts.x()) * (at.y() + static_cast<size_t>(parts.y()) * at.z())];
  }
  return in_cell;
}

std::vector<bool> BrickGrid::CellsTouched(const Mesh& surface) const {
  std::vector<bool> touched(static_cast<size_t>(cells_.prod()), false);
  for (const auto& triangle : surface.triangles.colwise()) {
    const Eigen::Vector3d centre = surface.vertices(Eigen::all, triangle).rowwise().mean();
    const Eigen::Vector3i at = InEdges(centre).array().floor().cast<int>().max(0).min(cells_.array() - 1);
    touched[Cell(at)] = true;
  }
  return touched;
}

void BrickGrid::AddBrick(const Eigen::Vector3i& cell, const BrickFractions& fractions, std::vector<int>& node_at,
                         std::vector<Eigen::Vector3d>& nodes) {
  const Eigen::Vector3i along = cells_.array() + 1;
  BrickCorners corners;
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3i corner = cell + CornerOf(c);
    int& node = node_at[corner.x() + along.x() * (corner.y() + along.y() * corner.z())];
    if (node < 0) {
      node = static_cast<int>(nodes.size());
      nodes.emplace_back(origin_ + edge_ * corner.cast<double>());
    }
    corners[c] = node;
  }
  brick_of_cell_[Cell(cell)] = static_cast<int>(bricks_.size());
  bricks_.push_back(corners);
  fractions_.push_back(fractions);
  cell_of_.push_back(cell);
}

void BrickGrid::AddBricks(const std::vector<float>& fractions, const std::vector<bool>& touched) {
  std::vector<int> node_at(static_cast<size_t>((cells_.array() + 1).prod()), -1);
  std::vector<Eigen::Vector3d> nodes;
  brick_of_cell_.assign(touched.size(), -1);
  for (int i = 0; i < static_cast<int>(touched.size()); ++i) {
    const Eigen::Vector3i cell(i % cells_.x(), i / cells_.x() % cells_.y(), i / (cells_.x() * cells_.y()));
    const BrickFractions inside = FractionsIn(cell, fractions);
    const bool holds_volume = std::any_of(inside.begin(), inside.end(), [](float f) { return f > 0; });
    if (holds_volume || touched[i]) AddBrick(cell, inside, node_at, nodes);
  }
  nodes_ = Eigen::Map<const Points>(nodes.data()->data(), 3, static_cast<Eigen::Index>(nodes.size()));
  Points centres(3, static_cast<Eigen::Index>(cell_of_.size()));
  for (Eigen::Index b = 0; b < centres.cols(); ++b) {
    centres.col(b) = origin_ + edge_ * (cell_of_[b].cast<double>().array() + 0.5).matrix();
  }
  centres_.emplace(centres);
}

BrickGrid::Place BrickGrid::Locate(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d in_edges = InEdges(point);
  const Eigen::Vector3d clamped = in_edges.cwiseMax(-1).cwiseMin(cells_.cast<double>());
  const Eigen::Vector3i at = clamped.array().floor().cast<int>();
  int brick = HasCell(at) ? brick_of_cell_[Cell(at)] : -1;
  if (brick < 0) brick = std::max(0, centres_->Nearest(point).vertex);
  return {brick, (in_edges - cell_of_[brick].cast<double>()).cwiseMax(-1).cwiseMin(2)};
}

}  // namespace phrenic
