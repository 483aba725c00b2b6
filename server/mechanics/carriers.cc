#include "server/mechanics/carriers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace phrenic {
namespace {

constexpr double kNear = 5e-3;           // distances below this count alike [m]
constexpr double kSmallestShare = 0.01;  // smaller shares are dropped and the rest scaled to 1

double Weight(double distance) { return std::pow(distance * distance + kNear * kNear, -2); }

std::vector<RideShare> OfVertex(const Ride& ride, int vertex) {
  if (!ride.triangles.empty()) {
    const TriangleShare& place = ride.triangles[vertex];
    std::vector<RideShare> shares;
    shares.reserve(3);
    for (int i = 0; i < 3; ++i) shares.push_back({vertex, -1, place.corners[i], place.weights[i]});
    return shares;
  }
  const auto before = [](const RideShare& share, int v) { return share.vertex < v; };
  auto first = std::lower_bound(ride.shares.begin(), ride.shares.end(), vertex, before);
  auto last = std::lower_bound(first, ride.shares.end(), vertex + 1, before);
  return {first, last};
}

// Leaves out what is too small to see and brings the rest back to the same sum.
void Prune(std::vector<double>& weights) {
  double sum = 0, kept = 0;
  for (const double weight : weights) sum += weight;
  for (double& weight : weights) {
    if (weight < kSmallestShare * sum) weight = 0;
    kept += weight;
  }
  for (double& weight : weights) weight /= kept;
}

}  // namespace

Carriers::Carriers(const Draft& draft, const std::vector<int>& bodies) : draft_(draft), bodies_(bodies) {
  for (const int b : bodies) {
    const Points& vertices = draft.model.bodies[b].mesh.vertices;
    searches_.push_back(std::make_unique<NearestSearch>(vertices));
    boxes_.emplace_back(vertices.rowwise().minCoeff(), vertices.rowwise().maxCoeff());
  }
}

std::vector<int> Carriers::NearestBoxFirst(const Eigen::Vector3d& point) const {
  std::vector<int> order(boxes_.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> distance(boxes_.size());
  for (size_t c = 0; c < boxes_.size(); ++c) distance[c] = boxes_[c].squaredExteriorDistance(point);
  std::stable_sort(order.begin(), order.end(), [&distance](int a, int b) { return distance[a] < distance[b]; });
  return order;
}

Carriers::Contact Carriers::Nearest(const Eigen::Vector3d& point) const {
  Contact nearest{.distance = std::numeric_limits<double>::infinity()};
  for (const int c : NearestBoxFirst(point)) {
    if (boxes_[c].exteriorDistance(point) >= nearest.distance) break;
    const Neighbour found = searches_[c]->Nearest(point);
    if (found.distance < nearest.distance) nearest = {c, found.vertex, found.distance};
  }
  return nearest;
}

std::vector<RideShare> Carriers::Shares(const Contact& contact, int for_vertex) const {
  const BodyModel& body = draft_.model.bodies[bodies_[contact.carrier]];
  if (body.pose >= 0) return {{for_vertex, body.pose, -1, 1.0}};
  if (body.first_vertex >= 0) return {{for_vertex, -1, body.first_vertex + contact.vertex, 1.0}};
  if (body.ride < 0) return {};
  std::vector<RideShare> shares = OfVertex(draft_.model.rides[body.ride], contact.vertex);
  for (RideShare& share : shares) share.vertex = for_vertex;
  return shares;
}

std::vector<RideShare> Carriers::Blend(const Eigen::Vector3d& point, int for_vertex) const {
  std::vector<Contact> contacts;
  std::vector<double> weights;
  double largest = 0;
  for (const int c : NearestBoxFirst(point)) {
    if (Weight(boxes_[c].exteriorDistance(point)) < kSmallestShare * largest) break;  // it and the rest are too far
    const Neighbour found = searches_[c]->Nearest(point);
    contacts.push_back({c, found.vertex, found.distance});
    weights.push_back(Weight(found.distance));
    largest = std::max(largest, weights.back());
  }
  Prune(weights);
  std::vector<RideShare> blended;
  for (size_t c = 0; c < contacts.size(); ++c) {
    if (weights[c] == 0) continue;
    for (RideShare share : Shares(contacts[c], for_vertex)) {
      share.weight *= weights[c];
      blended.push_back(share);
    }
  }
  return blended;
}

}  // namespace phrenic
