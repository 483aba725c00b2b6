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

std::vector<int> Those(const ModelBuilder& builder, const std::vector<int>& bodies, bool deformable) {
  std::vector<int> chosen;
  std::copy_if(bodies.begin(), bodies.end(), std::back_inserter(chosen),
               [&](int b) { return (builder.model.bodies[b].first_vertex >= 0) == deformable; });
  return chosen;
}

}  // namespace

SmoothWeights::SmoothWeights(const ModelBuilder& builder, const std::vector<int>& drivers)
    : carriers_(FarthestFirst(builder, Those(builder, drivers, true))),
      others_(builder, Those(builder, drivers, false)) {}

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
  for (size_t next = 1; next < used && !builder.stop.Stopped(); ++next) {
    size_t farthest = next;
    for (size_t i = next; i < order.size(); ++i) {
      order[i].apart = std::min(order[i].apart, (order[i].at - order[next - 1].at).norm());
      if (order[i].apart > order[farthest].apart) farthest = i;
    }
    std::swap(order[next], order[farthest]);
  }
  order.resize(used);
  return order;
}

double SmoothWeights::Softened(const Carrier& carrier, const Eigen::Vector3d& scaled) {
  return ((carrier.at - scaled).squaredNorm() + kSmoothing * kSmoothing) / carrier.level;
}

// Returns s_min [m^2]; infinity without deformable drivers.
double SmoothWeights::Smallest(const Eigen::Vector3d& scaled) const {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Carrier& carrier : carriers_) smallest = std::min(smallest, Softened(carrier, scaled));
  return smallest;
}

// Returns the shares of all deformable drivers together and of each other one.
std::vector<SmoothWeights::Share> SmoothWeights::Shares(const Eigen::Vector3d& point) const {
  if (others_.count() == 0) return {{-1, -1, 1}};
  double softened = std::numeric_limits<double>::infinity();
  for (const Carrier& carrier : carriers_) {
    const Eigen::Vector3d apart = point - Eigen::Vector3d(carrier.at.x(), carrier.at.y(), carrier.at.z() / kUpright);
    softened = std::min(softened, (apart.squaredNorm() + kSmoothing * kSmoothing) / carrier.level);
  }
  std::vector<Share> shares = {{-1, -1, 1 / (softened * softened)}};
  for (int driver = 0; driver < others_.count(); ++driver) {
    const Neighbour nearest = others_.search(driver).Nearest(point);
    softened = nearest.distance * nearest.distance + kSmoothing * kSmoothing;
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
      AppendCarriers(scaled, Smallest(scaled), share.weight, for_vertex, weights);
    } else {
      others_.AppendWeights({share.driver, share.vertex, 0}, for_vertex, share.weight, weights);
    }
  }
}

}  // namespace phrenic
