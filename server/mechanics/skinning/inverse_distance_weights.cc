#include "server/mechanics/skinning/inverse_distance_weights.h"

#include <cmath>

namespace phrenic {
namespace {

constexpr double kNear = 5e-3;           // distances below this count alike [m]
constexpr double kSmallestShare = 0.01;  // of the nearest's: smaller ones are dropped and the rest scaled to 1
constexpr double kSlack = 1e-9;          // of distances that are bounds: more than they are rounded by
constexpr double kAround = 0.01;         // how far points may lie from the last place that was looked around [m]

double Weight(double distance) {
  const double squared = distance * distance + kNear * kNear;
  return 1 / (squared * squared);
}

// How near a driver must be to have the smallest share of what the nearest has: w_c/w = ((d^2 + n^2)/(d_c^2 + n^2))^2.
double BoundsOf(double nearest) {
  const double squared = (nearest * nearest + kNear * kNear) / std::sqrt(kSmallestShare);
  return std::sqrt(squared - kNear * kNear) * (1 + kSlack);
}

}  // namespace

InverseDistanceWeights::InverseDistanceWeights(const SkinDrivers& drivers)
    : drivers_(drivers),
      tracks_(static_cast<size_t>(drivers.count())),
      middle_(Eigen::Vector3d::Constant(SkinDrivers::kAnywhere)) {}

// How far the driver is from a point at least.
double InverseDistanceWeights::Track::AtLeast(const Eigen::Vector3d& point) const {
  const double moved = (point - from).norm();
  return distance - moved - kSlack * (distance + moved);
}

// As far as the vertex that was nearest last.
double InverseDistanceWeights::AtMost(int driver, const Eigen::Vector3d& point) const {
  return (drivers_.vertices(driver).col(tracks_[driver].vertex) - point).norm() * (1 + kSlack);
}

void InverseDistanceWeights::Find(int driver, const Eigen::Vector3d& point) {
  const Neighbour found = drivers_.search(driver).Nearest(point, AtMost(driver, point));
  tracks_[driver] = {point, found.distance, found.vertex, Weight(found.distance)};
  if (tracks_[driver].weight > tracks_[nearest_].weight) nearest_ = driver;
}

// Tells which may carry points within kAround from this one.
void InverseDistanceWeights::LookAround(const Eigen::Vector3d& point) {
  middle_ = point;
  const double reach = BoundsOf(AtMost(nearest_, point) + kAround) + kAround;
  around_.clear();
  for (int c = 0; c < drivers_.count(); ++c) {
    if (tracks_[c].AtLeast(point) <= reach) around_.push_back(c);
  }
}

// Weighs all drivers that may have a share; the others' weight is 0.
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
  const double smallest = kSmallestShare * tracks_[nearest_].weight;
  double sum = 0;
  for (const int c : around_) sum += tracks_[c].weight >= smallest ? tracks_[c].weight : 0;
  for (const int c : around_) {
    const Track& track = tracks_[c];
    if (track.weight < smallest) continue;
    drivers_.AppendWeights({c, track.vertex, track.distance}, for_vertex, track.weight / sum, weights);
  }
}

}  // namespace phrenic
