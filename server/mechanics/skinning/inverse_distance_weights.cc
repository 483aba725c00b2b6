#include "server/mechanics/skinning/inverse_distance_weights.h"

#include <cmath>

namespace phrenic {
namespace {

constexpr double kNear = 5e-3;            // smoothing length [m]
constexpr double kSmallestWeight = 0.01;  // relative to the largest; smaller weights are dropped
constexpr double kSlack = 1e-9;           // relative margin of distance bounds, above their rounding error
constexpr double kAround = 0.01;          // the candidate drivers are valid within this distance of middle_ [m]

double Weight(double distance) {
  const double squared = distance * distance + kNear * kNear;
  return 1 / (squared * squared);
}

// Returns the distance within which a driver has at least kSmallestWeight of the weight of one at distance `nearest`,
// from w_c/w = ((d^2 + n^2)/(d_c^2 + n^2))^2 [m].
double BoundsOf(double nearest) {
  const double squared = (nearest * nearest + kNear * kNear) / std::sqrt(kSmallestWeight);
  return std::sqrt(squared - kNear * kNear) * (1 + kSlack);
}

}  // namespace

InverseDistanceWeights::InverseDistanceWeights(const SkinDrivers& drivers)
    : drivers_(drivers),
      tracks_(static_cast<size_t>(drivers.count())),
      middle_(Eigen::Vector3d::Constant(SkinDrivers::kAnywhere)) {}

// Returns a lower bound of the driver's distance from a point [m].
double InverseDistanceWeights::Track::AtLeast(const Eigen::Vector3d& point) const {
  const double moved = (point - from).norm();
  return distance - moved - kSlack * (distance + moved);
}

// Returns an upper bound of the driver's distance [m]: that of the vertex that was nearest in its last search.
double InverseDistanceWeights::AtMost(int driver, const Eigen::Vector3d& point) const {
  return (drivers_.vertices(driver).col(tracks_[driver].vertex) - point).norm() * (1 + kSlack);
}

void InverseDistanceWeights::Find(int driver, const Eigen::Vector3d& point) {
  const Neighbour found = drivers_.search(driver).Nearest(point, AtMost(driver, point));
  tracks_[driver] = {point, found.distance, found.vertex, Weight(found.distance)};
  if (tracks_[driver].weight > tracks_[nearest_].weight) nearest_ = driver;
}

// Finds the drivers that may have a weight for points within kAround of this one.
void InverseDistanceWeights::LookAround(const Eigen::Vector3d& point) {
  middle_ = point;
  const double reach = BoundsOf(AtMost(nearest_, point) + kAround) + kAround;
  around_.clear();
  for (int c = 0; c < drivers_.count(); ++c) {
    if (tracks_[c].AtLeast(point) <= reach) around_.push_back(c);
  }
}

// Computes the weights of all candidate drivers; 0 for those beyond reach.
void InverseDistanceWeights::Weigh(const Eigen::Vector3d& point) {
  for (const int c : around_) tracks_[c].weight = 0;
  const int first = nearest_;
  Find(first, point);
  double reach = BoundsOf(tracks_[first].distance);
  for (const int c : around_) {
    if (c == first || tracks_[c].AtLeast(point) > reach) continue;
    Find(c, point);
    reach = BoundsOf(tracks_[nearest_].distance);
  }
}

void InverseDistanceWeights::Append(const Eigen::Vector3d& point, int for_vertex, std::vector<SkinWeight>& weights) {
  if (!((point - middle_).norm() <= kAround)) LookAround(point);
  Weigh(point);
  const double smallest = kSmallestWeight * tracks_[nearest_].weight;
  double sum = 0;
  for (const int c : around_) sum += tracks_[c].weight >= smallest ? tracks_[c].weight : 0;
  for (const int c : around_) {
    const Track& track = tracks_[c];
    if (track.weight < smallest) continue;
    drivers_.AppendWeights({c, track.vertex, track.distance}, for_vertex, track.weight / sum, weights);
  }
}

}  // namespace phrenic
