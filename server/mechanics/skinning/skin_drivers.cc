#include "server/mechanics/skinning/skin_drivers.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

// What carries a vertex that rides itself carries what rides on it.
void AppendOfVertex(const Skin& ride, int vertex, int for_vertex, double weight, std::vector<SkinWeight>& shares) {
  if (!ride.triangles.empty()) {
    const TriangleBinding& place = ride.triangles[vertex];
    for (int i = 0; i < 3; ++i) shares.push_back({for_vertex, -1, place.corners[i], weight * place.weights[i]});
    return;
  }
  const auto before = [](const SkinWeight& share, int v) { return share.vertex < v; };
  auto share = std::lower_bound(ride.shares.begin(), ride.shares.end(), vertex, before);
  for (; share != ride.shares.end() && share->vertex == vertex; ++share) {
    shares.push_back({for_vertex, share->pose, share->simulated_vertex, weight * share->weight});
  }
}

// Boxes by their distances from a point, nearest first; of equally near ones the first. Those that are nearer than
// `reach` [m].
class NearestBoxes {
 public:
  struct Box {
    double squared;  // [m^2]
    int carrier;
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
    return a.squared != b.squared ? a.squared > b.squared : a.carrier > b.carrier;
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

SkinDrivers::Contact SkinDrivers::Nearest(const Eigen::Vector3d& point, double reach) const {
  Contact nearest{.distance = kAnywhere};
  for (NearestBoxes boxes(boxes_, point, reach); !boxes.empty();) {
    const auto [squared, carrier] = boxes.Take();
    if (std::sqrt(squared) >= reach) break;
    const Neighbour found = searches_[carrier]->Nearest(point, reach);
    if (!(found.distance < reach)) continue;
    nearest = {carrier, found.vertex, found.distance};
    reach = found.distance;
  }
  return nearest;
}

void SkinDrivers::AppendWeights(const Contact& contact, int for_vertex, double weight,
                                std::vector<SkinWeight>& shares) const {
  const BodyModel& body = builder_.model.bodies[bodies_[contact.carrier]];
  if (body.pose >= 0) {
    shares.push_back({for_vertex, body.pose, -1, weight});
  } else if (body.first_vertex >= 0) {
    shares.push_back({for_vertex, -1, body.first_vertex + contact.vertex, weight});
  } else if (body.skin >= 0) {
    AppendOfVertex(builder_.model.skins[body.skin], contact.vertex, for_vertex, weight, shares);
  }
}

}  // namespace phrenic
