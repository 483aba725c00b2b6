#include "server/mechanics/skinning/skin_drivers.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

// Appends the drivers of a vertex of a skinned body, their weights times `weight`.
void AppendOfVertex(const Skin& skin, int vertex, int for_vertex, double weight, std::vector<SkinWeight>& weights) {
  if (!skin.triangles.empty()) {
    const TriangleBinding& binding = skin.triangles[vertex];
    for (int i = 0; i < 3; ++i) weights.push_back({for_vertex, -1, binding.corners[i], weight * binding.weights[i]});
    return;
  }
  const SkinWeights& own = skin.weights;
  const auto before = [](const SkinWeights::Row& row, int v) { return row.vertex < v; };
  const auto row = std::lower_bound(own.rows.begin(), own.rows.end(), vertex, before);
  if (row == own.rows.end() || row->vertex != vertex) return;
  for (int i = 0; i < row->poses + row->simulated; ++i) {
    const bool pose = i < row->poses;
    const int driver = own.drivers[row->first + i];
    weights.push_back({for_vertex, pose ? driver : -1, pose ? -1 : driver, weight * own.weights[row->first + i]});
  }
}

// A priority queue of the boxes within `reach` [m] of a point, nearest first; ties by index.
class NearestBoxes {
 public:
  struct Box {
    double squared;  // [m^2]
    int driver;
  };

  NearestBoxes(const std::vector<Eigen::AlignedBox3d>& boxes, const Eigen::Vector3d& point, double reach) {
    heap_.reserve(boxes.size());
    for (size_t c = 0; c < boxes.size(); ++c) {
      const double squared = boxes[c].squaredExteriorDistance(point);
      if (std::sqrt(squared) < reach) heap_.push_back({squared, static_cast<int>(c)});
    }
    std::make_heap(heap_.begin(), heap_.end(), Farther);
  }
  bool empty() const { return heap_.empty(); }
  Box Take() {
    std::pop_heap(heap_.begin(), heap_.end(), Farther);
    const Box nearest = heap_.back();
    heap_.pop_back();
    return nearest;
  }

 private:
  static bool Farther(const Box& a, const Box& b) {
    return a.squared != b.squared ? a.squared > b.squared : a.driver > b.driver;
  }

  std::vector<Box> heap_;
};

}  // namespace

SkinDrivers::SkinDrivers(const ModelBuilder& builder, const std::vector<int>& bodies)
    : builder_(builder), bodies_(bodies) {
  for (const int b : bodies) {
    const Points& vertices = builder.model.bodies[b].mesh.vertices;
    searches_.push_back(&builder.Search(b));
    boxes_.emplace_back(vertices.rowwise().minCoeff(), vertices.rowwise().maxCoeff());
  }
}

SkinDrivers::Nearby SkinDrivers::Nearest(const Eigen::Vector3d& point, double reach) const {
  Nearby nearest{.distance = kAnywhere};
  for (NearestBoxes boxes(boxes_, point, reach); !boxes.empty();) {
    const auto [squared, driver] = boxes.Take();
    if (std::sqrt(squared) >= reach) break;
    const Neighbour found = searches_[driver]->Nearest(point, reach);
    if (!(found.distance < reach)) continue;
    nearest = {driver, found.vertex, found.distance};
    reach = found.distance;
  }
  return nearest;
}

void SkinDrivers::AppendWeights(const Nearby& nearby, int for_vertex, double weight,
                                std::vector<SkinWeight>& weights) const {
  const BodyModel& body = builder_.model.bodies[bodies_[nearby.driver]];
  if (body.pose >= 0) {
    weights.push_back({for_vertex, body.pose, -1, weight});
  } else if (body.first_vertex >= 0) {
    weights.push_back({for_vertex, -1, body.first_vertex + nearby.vertex, weight});
  } else if (body.skin >= 0) {
    AppendOfVertex(builder_.model.skins[body.skin], nearby.vertex, for_vertex, weight, weights);
  }
}

}  // namespace phrenic
