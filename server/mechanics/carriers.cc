#include "server/mechanics/carriers.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

// What carries a vertex that rides itself carries what rides on it.
void AppendOfVertex(const Ride& ride, int vertex, int for_vertex, double weight, std::vector<RideShare>& shares) {
  if (!ride.triangles.empty()) {
    const TriangleShare& place = ride.triangles[vertex];
    for (int i = 0; i < 3; ++i) shares.push_back({for_vertex, -1, place.corners[i], weight * place.weights[i]});
    return;
  }
  const auto before = [](const RideShare& share, int v) { return share.vertex < v; };
  auto share = std::lower_bound(ride.shares.begin(), ride.shares.end(), vertex, before);
  for (; share != ride.shares.end() && share->vertex == vertex; ++share) {
    shares.push_back({for_vertex, share->pose, share->simulated_vertex, weight * share->weight});
  }
}

bool Farther(const NearestBoxes::Box& a, const NearestBoxes::Box& b) {
  return a.squared != b.squared ? a.squared > b.squared : a.carrier > b.carrier;
}

}  // namespace

Carriers::Carriers(const Draft& draft, const std::vector<int>& bodies) : draft_(draft), bodies_(bodies) {
  for (const int b : bodies) {
    const Points& vertices = draft.model.bodies[b].mesh.vertices;
    searches_.push_back(&draft.Search(b));
    boxes_.emplace_back(vertices.rowwise().minCoeff(), vertices.rowwise().maxCoeff());
  }
}

Carriers::Contact Carriers::Nearest(const Eigen::Vector3d& point, double reach) const {
  Contact nearest{.distance = kAnywhere};
  for (NearestBoxes boxes(*this, point, reach); !boxes.empty();) {
    const auto [squared, carrier] = boxes.Take();
    if (std::sqrt(squared) >= reach) break;
    const Neighbour found = searches_[carrier]->Nearest(point, reach);
    if (!(found.distance < reach)) continue;
    nearest = {carrier, found.vertex, found.distance};
    reach = found.distance;
  }
  return nearest;
}

void Carriers::AppendShares(const Contact& contact, int for_vertex, double weight,
                            std::vector<RideShare>& shares) const {
  const BodyModel& body = draft_.model.bodies[bodies_[contact.carrier]];
  if (body.pose >= 0) {
    shares.push_back({for_vertex, body.pose, -1, weight});
  } else if (body.first_vertex >= 0) {
    shares.push_back({for_vertex, -1, body.first_vertex + contact.vertex, weight});
  } else if (body.ride >= 0) {
    AppendOfVertex(draft_.model.rides[body.ride], contact.vertex, for_vertex, weight, shares);
  }
}

NearestBoxes::NearestBoxes(const Carriers& carriers, const Eigen::Vector3d& point, double reach) {
  heap_.reserve(static_cast<size_t>(carriers.count()));
  for (int c = 0; c < carriers.count(); ++c) {
    const double squared = carriers.SquaredToBox(c, point);
    if (std::sqrt(squared) < reach) heap_.push_back({squared, c});
  }
  std::make_heap(heap_.begin(), heap_.end(), Farther);
}

NearestBoxes::Box NearestBoxes::Take() {
  std::pop_heap(heap_.begin(), heap_.end(), Farther);
  const Box nearest = heap_.back();
  heap_.pop_back();
  return nearest;
}

}  // namespace phrenic
