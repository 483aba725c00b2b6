#include "server/stream/decoder/neighbour_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

namespace phrenic::stream {
namespace {

constexpr double kRegularisation = 0.03125;  // 1/32
constexpr double kLargestWeight = 4;         // above it the fit is ill-conditioned

using Offset = std::array<double, 3>;
using Chosen = std::vector<int>;  // vertices

// The neighbours of each vertex, ascending.
class Adjacency {
 public:
  explicit Adjacency(const RestMesh& mesh) : first_(mesh.vertices() + 1), end_(mesh.vertices()) {
    for (std::size_t i = 0; i + 1 < mesh.edges.size(); i += 2) {
      if (mesh.edges[i] == mesh.edges[i + 1]) continue;
      ++first_[mesh.edges[i] + 1], ++first_[mesh.edges[i + 1] + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::copy_n(first_.begin(), end_.size(), end_.begin());
    others_.resize(first_.back());
    for (std::size_t i = 0; i + 1 < mesh.edges.size(); i += 2) {
      if (mesh.edges[i] == mesh.edges[i + 1]) continue;
      others_[end_[mesh.edges[i]]++] = mesh.edges[i + 1];
      others_[end_[mesh.edges[i + 1]]++] = mesh.edges[i];
    }
    for (std::size_t vertex = 0; vertex < end_.size(); ++vertex) {
      int* const first = others_.data() + first_[vertex];
      std::sort(first, others_.data() + end_[vertex]);
      end_[vertex] = static_cast<std::size_t>(std::unique(first, others_.data() + end_[vertex]) - others_.data());
    }
  }
  std::size_t size() const { return end_.size(); }
  std::span<const int> operator[](std::size_t vertex) const {
    return std::span(others_).subspan(first_[vertex], end_[vertex] - first_[vertex]);
  }

 private:
  std::vector<std::size_t> first_, end_;  // of each vertex in `others_`
  std::vector<int> others_;
};

std::vector<int> BreadthFirst(const Adjacency& beside) {
  std::vector<int> order;
  std::vector<bool> seen(beside.size());
  order.reserve(beside.size());
  for (std::size_t start = 0; start < beside.size(); ++start) {
    if (seen[start]) continue;
    seen[start] = true;
    order.push_back(static_cast<int>(start));
    for (std::size_t next = order.size() - 1; next < order.size(); ++next) {
      for (const int vertex : beside[order[next]]) {
        if (seen[vertex]) continue;
        seen[vertex] = true;
        order.push_back(vertex);
      }
    }
  }
  return order;
}

// Neighbours earlier in the order, then their neighbours, each once.
Chosen Choose(const Adjacency& beside, const std::vector<int>& place, int vertex) {
  Chosen chosen;
  const auto add_from = [&](const auto& candidates) {
    for (const int candidate : candidates) {
      if (chosen.size() == kMostNeighbours) return;
      const bool is_new = std::find(chosen.begin(), chosen.end(), candidate) == chosen.end();
      if (is_new && place[candidate] < place[vertex]) chosen.push_back(candidate);
    }
  };
  add_from(beside[vertex]);
  const std::size_t near = chosen.size();
  for (std::size_t i = 0; i < near && chosen.size() < kMostNeighbours; ++i) add_from(beside[chosen[i]]);
  return chosen;
}

// Solves (r I + sum d d^T) c = sum d by Cramer's rule: sums, products and one division each, in this order.
Offset Fit(const std::vector<Offset>& offsets) {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, x = 0, y = 0, z = 0, furthest = 0;
  for (const auto& [dx, dy, dz] : offsets) {
    xx += dx * dx, xy += dx * dy, xz += dx * dz, yy += dy * dy, yz += dy * dz, zz += dz * dz;
    x += dx, y += dy, z += dz;
    furthest = std::max(furthest, dx * dx + dy * dy + dz * dz);
  }
  const double r = kRegularisation * furthest;
  xx += r, yy += r, zz += r;
  const double cx = yy * zz - yz * yz, cy = xz * yz - xy * zz, cz = xy * yz - xz * yy;
  const double determinant = xx * cx + xy * cy + xz * cz;
  if (!(determinant > 0)) return {0, 0, 0};
  const double ey = xx * zz - xz * xz, ez = xy * xz - xx * yz, ff = xx * yy - xy * xy;
  return {(cx * x + cy * y + cz * z) / determinant, (cy * x + ey * y + ez * z) / determinant,
          (cz * x + ez * y + ff * z) / determinant};
}

// Rounds to units of 1/kUnit; adds the rounding error to the first.
std::vector<std::int32_t> Weigh(std::span<const float> rest, int vertex, const Chosen& chosen) {
  std::vector<Offset> offsets;
  for (const int other : chosen) {
    Offset& offset = offsets.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      offset[axis] = static_cast<double>(rest[3 * static_cast<std::size_t>(other) + axis]) -
                     static_cast<double>(rest[3 * static_cast<std::size_t>(vertex) + axis]);
    }
  }
  const Offset c = Fit(offsets);
  std::vector<double> weights;
  double sum = 0;
  for (const auto& [dx, dy, dz] : offsets) {
    weights.push_back(1 - (dx * c[0] + dy * c[1] + dz * c[2]));
    sum += weights.back();
  }
  const bool wild = std::any_of(weights.begin(), weights.end(),
                                [sum](double weight) { return !(std::abs(weight) <= kLargestWeight * sum); });
  std::vector<std::int32_t> units;
  std::int32_t left = kUnit;
  for (const double weight : weights) {
    const double share = wild ? 1.0 / static_cast<double>(weights.size()) : weight / sum;
    units.push_back(static_cast<std::int32_t>(std::floor(share * kUnit + 0.5)));
    left -= units.back();
  }
  units.front() += left;
  return units;
}

}  // namespace

NeighbourWeights MakeNeighbourWeights(const RestMesh& mesh) {
  const Adjacency beside(mesh);
  NeighbourWeights made;
  made.order = BreadthFirst(beside);
  std::vector<int> place(made.order.size());
  for (std::size_t i = 0; i < made.order.size(); ++i) place[made.order[i]] = static_cast<int>(i);
  made.first.push_back(0);
  for (std::size_t i = 0; i < made.order.size(); ++i) {
    const int vertex = made.order[i];
    Chosen chosen = Choose(beside, place, vertex);
    if (chosen.empty() && i > 0) chosen.push_back(made.order[i - 1]);
    if (!chosen.empty()) {
      for (const int other : chosen) made.places.push_back(place[other]);
      for (const std::int32_t weight : Weigh(mesh.rest, vertex, chosen)) made.weights.push_back(weight);
    }
    made.first.push_back(static_cast<int>(made.places.size()));
  }
  return made;
}

}  // namespace phrenic::stream
