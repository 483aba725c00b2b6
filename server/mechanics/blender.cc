#include "server/mechanics/blender.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

constexpr double kNear = 5e-3;           // distances below this count alike [m]
constexpr double kSmallestShare = 0.01;  // smaller shares are dropped and the rest scaled to 1
constexpr double kSlack = 1e-9;          // of distances and weights that are bounds: more than they are rounded by

double Weight(double distance) {
  const double squared = distance * distance + kNear * kNear;
  return 1 / (squared * squared);
}

// How near a carrier must be to have the smallest share of what the nearest has: w_c/w = ((d^2 + n^2)/(d_c^2 + n^2))^2.
double ReachOf(double nearest) {
  const double squared = (nearest * nearest + kNear * kNear) / std::sqrt(kSmallestShare);
  return std::sqrt(squared - kNear * kNear);
}

}  // namespace

Blender::Blender(const Carriers& carriers) : carriers_(carriers), tracks_(static_cast<size_t>(carriers.count())) {}

// The vertex that was nearest from the last point bounds the search.
void Blender::Find(int carrier, const Eigen::Vector3d& point) {
  Track& track = tracks_[carrier];
  const Eigen::Vector3d last = carriers_.vertices(carrier).col(track.vertex);
  const Neighbour found = carriers_.search(carrier).Nearest(point, (last - point).norm() * (1 + kSlack));
  track = {point, found.distance, found.vertex, found.distance, true};
  if (found.distance < tracks_[nearest_].at_least) nearest_ = carrier;
}

// Finds all carriers that may have a share.
void Blender::FindNear(const Eigen::Vector3d& point) {
  for (Track& track : tracks_) {
    const double moved = (point - track.from).norm();
    track.at_least = std::max(0.0, track.distance - moved - kSlack * (track.distance + moved));
    track.found = false;
  }
  Find(nearest_, point);
  double reach = ReachOf(tracks_[nearest_].distance) * (1 + kSlack);
  for (int c = 0; c < carriers_.count(); ++c) {
    if (tracks_[c].found || tracks_[c].at_least > reach) continue;
    Find(c, point);
    reach = ReachOf(tracks_[nearest_].distance) * (1 + kSlack);
  }
}

// Weighs what is within reach. False where what is not found could decide if a share is too small.
bool Blender::WeighNear(const Eigen::Vector3d& point) {
  const double reach = ReachOf(tracks_[nearest_].distance) * (1 - kSlack);
  double sum = 0, beyond = 0;
  near_.clear();
  for (int c = 0; c < carriers_.count(); ++c) {
    const double distance = tracks_[c].at_least;
    if (distance > reach) {
      beyond += Weight(distance);
      continue;
    }
    near_.push_back({carriers_.SquaredToBox(c, point), c, Weight(distance)});
    sum += near_.back().weight;
  }
  const double surely = kSmallestShare * (1 - kSlack) * sum, perhaps = kSmallestShare * (1 + kSlack) * (sum + beyond);
  if (std::any_of(near_.begin(), near_.end(),
                  [&](const Weighed& c) { return c.weight >= surely && c.weight <= perhaps; })) {
    return false;
  }
  std::sort(near_.begin(), near_.end(), [](const Weighed& a, const Weighed& b) {
    return a.squared != b.squared ? a.squared < b.squared : a.carrier < b.carrier;
  });
  Prune(sum);
  return true;
}

// By their boxes, nearest first, until a box is too far.
void Blender::WeighAll(const Eigen::Vector3d& point) {
  double sum = 0, largest = 0;
  near_.clear();
  for (NearestBoxes boxes(carriers_, point); !boxes.empty();) {
    const auto [squared, c] = boxes.Take();
    if (Weight(std::sqrt(squared)) < kSmallestShare * largest) break;  // it and the rest are too far
    if (!tracks_[c].found) Find(c, point);
    near_.push_back({squared, c, Weight(tracks_[c].distance)});
    sum += near_.back().weight;
    largest = std::max(largest, near_.back().weight);
  }
  Prune(sum);
}

// Leaves out what is too small to see and brings the rest back to 1.
void Blender::Prune(double sum) {
  double kept = 0;
  for (Weighed& carrier : near_) {
    if (carrier.weight < kSmallestShare * sum) carrier.weight = 0;
    kept += carrier.weight;
  }
  for (Weighed& carrier : near_) carrier.weight /= kept;
}

void Blender::Blend(const Eigen::Vector3d& point, int for_vertex, std::vector<RideShare>& shares) {
  FindNear(point);
  if (!WeighNear(point)) WeighAll(point);
  for (const auto& [squared, carrier, weight] : near_) {
    if (weight == 0) continue;
    const Track& track = tracks_[carrier];
    carriers_.AppendShares({carrier, track.vertex, track.distance}, for_vertex, weight, shares);
  }
}

}  // namespace phrenic
