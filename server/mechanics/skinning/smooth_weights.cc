#include "server/mechanics/skinning/smooth_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/mesh/normals.h"

namespace phrenic {
namespace {

constexpr double kSmoothing = 8e-3;              // n [m]
constexpr double kUpright = 0.35;                // factor of vertical distances
constexpr double kSteep = 0.008;                 // of a vertical surface, relative to a level one
constexpr double kSmoothReach = 6;               // S / s_min
constexpr size_t kMostCarriers = 6000;           // bounds the time to order them, which grows with the square
constexpr double kSmallestShare = 0.01;          // relative to the largest; smaller shares are dropped
constexpr double kFew = 1. / 5, kMany = 1. / 3;  // of sqrt(S): vertices less than the first apart are not used

Eigen::Vector3d Scaled(const Eigen::Vector3d& point) { return {point.x(), point.y(), kUpright * point.z()}; }

double Smoothstep(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Returns the distance within which a driver has a share, given the least softened distance so far [m^2]: beyond it
// (least / softened)^2 is below kSmallestShare.
double ShareReach(double least) {
  constexpr double kAboveRounding = 1 + 1e-9;  // above rounding errors
  return std::sqrt(least / std::sqrt(kSmallestShare)) * kAboveRounding;
}

std::vector<int> Those(const ModelBuilder& builder, const std::vector<int>& bodies, bool deformable) {
  std::vector<int> chosen;
  std::copy_if(bodies.begin(), bodies.end(), std::back_inserter(chosen),
               [&](int b) { return (builder.model.bodies[b].first_vertex >= 0) == deformable; });
  return chosen;
}

}  // namespace

SmoothWeights::SmoothWeights(const ModelBuilder& builder, const std::vector<int>& drivers)
    : carriers_(FarthestFirst(builder, Those(builder, drivers, true))),
      others_(builder, Those(builder, drivers, false)) {
  const auto count = std::ssize(carriers_);
  for (Eigen::ArrayXd* column : {&columns_.x, &columns_.y, &columns_.z, &columns_.scaled, &columns_.level}) {
    column->resize(count);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const Carrier& carrier = carriers_[i];
    columns_.x[i] = carrier.at.x(), columns_.y[i] = carrier.at.y(), columns_.scaled[i] = carrier.at.z();
    columns_.z[i] = carrier.at.z() / kUpright;
    columns_.level[i] = carrier.level;
  }
}

std::vector<SmoothWeights::Carrier> SmoothWeights::FarthestFirst(const ModelBuilder& builder,
                                                                 const std::vector<int>& bodies) {
  std::vector<Carrier> order;
  for (const int b : bodies) {
    const BodyModel& body = builder.model.bodies[b];
    const Points normals = VertexNormals(body.mesh.vertices, body.mesh.triangles);
    for (Eigen::Index i = 0; i < body.mesh.vertices.cols(); ++i) {
      order.push_back({Scaled(body.mesh.vertices.col(i)), kSteep + (1 - kSteep) * normals(2, i) * normals(2, i),
                       std::numeric_limits<double>::infinity(), body.first_vertex + static_cast<int>(i)});
    }
  }
  const size_t used = std::min(order.size(), kMostCarriers);
  Eigen::ArrayXd x(order.size()), y(order.size()), z(order.size());
  for (size_t i = 0; i < order.size(); ++i) x[i] = order[i].at.x(), y[i] = order[i].at.y(), z[i] = order[i].at.z();
  Eigen::ArrayXd squared = Eigen::ArrayXd::Constant(std::ssize(order), std::numeric_limits<double>::infinity());
  for (size_t next = 1; next < used && !builder.stop.Stopped(); ++next) {
    const auto left = std::ssize(order) - static_cast<Eigen::Index>(next);
    const Eigen::Vector3d& last = order[next - 1].at;
    squared.tail(left) = squared.tail(left).min(
        (x.tail(left) - last.x()).square() + ((y.tail(left) - last.y()).square() + (z.tail(left) - last.z()).square()));
    // Compares distances, of which more are equal than of their squares: the first of equals is taken.
    size_t farthest = next;
    for (size_t i = next; i < order.size(); ++i) {
      if (squared[i] > squared[farthest] && std::sqrt(squared[i]) > std::sqrt(squared[farthest])) farthest = i;
    }
    std::swap(order[next], order[farthest]);
    for (Eigen::ArrayXd* column : {&x, &y, &z, &squared}) std::swap((*column)[next], (*column)[farthest]);
    order[next].apart = std::sqrt(squared[next]);
  }
  order.resize(used);
  return order;
}

double SmoothWeights::Softened(const Carrier& carrier, const Eigen::Vector3d& scaled) {
  return ((carrier.at - scaled).squaredNorm() + kSmoothing * kSmoothing) / carrier.level;
}

// Returns the least of all carriers' softened distances, at these z, from a point at `at_z` [m^2]; infinity without
// deformable drivers.
double SmoothWeights::Smallest(const Eigen::Vector3d& point, const Eigen::ArrayXd& z, double at_z) const {
  if (carriers_.empty()) return std::numeric_limits<double>::infinity();
  const auto squared = (columns_.x - point.x()).square() + ((columns_.y - point.y()).square() + (z - at_z).square());
  return ((squared + kSmoothing * kSmoothing) / columns_.level).minCoeff();
}

// Returns the shares of all deformable drivers together and of each other one. Those beyond the reach within which a
// driver has a share are not searched.
std::vector<SmoothWeights::Share> SmoothWeights::Shares(const Eigen::Vector3d& point) const {
  if (others_.count() == 0) return {{-1, -1, 1}};
  double softened = Smallest(point, columns_.z, point.z()), least = softened;
  std::vector<Share> shares = {{-1, -1, 1 / (softened * softened)}};
  for (int driver = 0; driver < others_.count(); ++driver) {
    const Neighbour nearest = others_.search(driver).Nearest(point, ShareReach(least));
    if (nearest.vertex < 0) continue;
    softened = nearest.distance * nearest.distance + kSmoothing * kSmoothing;
    least = std::min(least, softened);
    shares.push_back({driver, nearest.vertex, 1 / (softened * softened)});
  }
  double largest = 0, sum = 0;
  for (const Share& share : shares) largest = std::max(largest, share.weight);
  for (Share& share : shares) sum += share.weight = std::max(0.0, share.weight - kSmallestShare * largest);
  for (Share& share : shares) share.weight /= sum;
  return shares;
}

void SmoothWeights::AppendCarriers(const Eigen::Vector3d& scaled, double smallest, double share, int for_vertex,
                                   std::vector<SkinWeight>& weights) const {
  const double at_reach = kSmoothReach * smallest, reach = std::sqrt(at_reach);
  const size_t first = weights.size();
  double sum = 0;
  for (const Carrier& carrier : carriers_) {
    if (carrier.apart <= kFew * reach) break;
    const double at = Softened(carrier, scaled);
    if (at >= at_reach) continue;
    const double peak = 1 / at - 1 / at_reach;
    const double weight = peak * peak * Smoothstep((carrier.apart / reach - kFew) / (kMany - kFew));
    weights.push_back({for_vertex, -1, carrier.simulated_vertex, weight});
    sum += weight;
  }
  for (size_t i = first; i < weights.size(); ++i) weights[i].weight *= share / sum;
}

void SmoothWeights::Append(const Eigen::Vector3d& point, int for_vertex, std::vector<SkinWeight>& weights) const {
  const Eigen::Vector3d scaled = Scaled(point);
  for (const Share& share : Shares(point)) {
    if (share.weight == 0) continue;
    if (share.driver < 0) {
      AppendCarriers(scaled, Smallest(scaled, columns_.scaled, scaled.z()), share.weight, for_vertex, weights);
    } else {
      others_.AppendWeights({share.driver, share.vertex, 0}, for_vertex, share.weight, weights);
    }
  }
}

}  // namespace phrenic
