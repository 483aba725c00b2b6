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

void BrickGrid::AddBricks(const std::vector<float>& fractions, const std::vector<bool>& touched) {
  brick_of_cell_.assign(touched.size(), -1);
  for (int i = 0; i < static_cast<int>(touched.size()); ++i) {
    const Eigen::Vector3i cell(i % cells_.x(), i / cells_.x() % cells_.y(), i / (cells_.x() * cells_.y()));
    const BrickFractions inside = FractionsIn(cell, fractions);
    const bool holds_volume = std::any_of(inside.begin(), inside.end(), [](float f) { return f > 0; });
    if (!holds_volume && !touched[i]) continue;
    brick_of_cell_[i] = static_cast<int>(cell_of_.size());
    cell_of_.push_back(cell);
    fractions_.push_back(inside);
  }
  NumberNodes();
  Points centres(3, static_cast<Eigen::Index>(cell_of_.size()));
  for (Eigen::Index b = 0; b < centres.cols(); ++b) {
    centres.col(b) = origin_ + edge_ * (cell_of_[b].cast<double>().array() + 0.5).matrix();
  }
  centres_.emplace(centres);
}

void BrickGrid::NumberNodes() {
  const Eigen::Vector3i along = cells_.array() + 1;
  const auto index = [&](const Eigen::Vector3i& at) { return at.x() + along.x() * (at.y() + along.y() * at.z()); };
  std::vector<int> node_at(static_cast<size_t>(along.prod()), -1);
  for (const Eigen::Vector3i& cell : cell_of_) {
    for (int c = 0; c < 8; ++c) node_at[index(cell + CornerOf(c))] = 0;
  }
  std::vector<Eigen::Vector3d> nodes;
  for (int i = 0; i < static_cast<int>(node_at.size()); ++i) {
    const Eigen::Vector3i at(i % along.x(), i / along.x() % along.y(), i / (along.x() * along.y()));
    if (at.x() == 0 && at.y() == 0) layers_.push_back(static_cast<int>(nodes.size()));
    if (node_at[i] < 0) continue;
    node_at[i] = static_cast<int>(nodes.size());
    nodes.emplace_back(origin_ + edge_ * at.cast<double>());
  }
  layers_.push_back(static_cast<int>(nodes.size()));
  nodes_ = Eigen::Map<const Points>(nodes.data()->data(), 3, static_cast<Eigen::Index>(nodes.size()));
  for (const Eigen::Vector3i& cell : cell_of_) {
    BrickCorners& corners = bricks_.emplace_back();
    for (int c = 0; c < 8; ++c) corners[c] = node_at[index(cell + CornerOf(c))];
  }
}

bool BrickGrid::Holds(const Eigen::Vector3d& point) const {
  const Eigen::Array3d in_parts = kBrickSplit * InEdges(point).array();
  if (!(in_parts >= 0).all() || !(in_parts < kBrickSplit * cells_.cast<double>().array()).all()) return false;
  const Eigen::Vector3i part = in_parts.cast<int>();
  const int brick = brick_of_cell_[Cell(part / kBrickSplit)];
  const Eigen::Vector3i within = part - kBrickSplit * (part / kBrickSplit);
  const int index = within.x() + kBrickSplit * (within.y() + kBrickSplit * within.z());
  return brick >= 0 && fractions_[brick][index] > 0;
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
