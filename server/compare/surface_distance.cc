#include "server/compare/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <vector>

#include "server/compare/farthest_point.h"
#include "server/compare/surface_samples.h"
#include "server/mesh/units.h"

namespace phrenic::compare {
namespace {

constexpr double kSquareMillimetres = 1e6;
constexpr double kNoDistance = std::numeric_limits<double>::quiet_NaN();

// A sample's distance and the area that it represents.
struct Weighted {
  double distance;  // [m]
  double area;      // [m^2]
  bool operator<(const Weighted& other) const { return distance < other.distance; }
};

// The distances from one surface to another.
struct Directed {
  std::vector<Weighted> samples;  // ascending by distance
  Eigen::VectorXd at_vertices;    // one per vertex [m]
  Farthest farthest;
};

// Queries distances of consecutive points. Two upper bounds limit each search: the previous distance plus the distance
// of the two points (Lipschitz continuity), and the distance to the previous nearest triangle.
class Walk {
 public:
  explicit Walk(const MeasuredSurface& to) : to_(to) {}

  double DistanceAt(const Eigen::Vector3d& point) {
    double reach = distance_ + (point - before_).norm();
    if (triangle_ >= 0) reach = std::min(reach, to_.DistanceTo(triangle_, point));
    const SurfacePoint nearest = to_.Nearest(point, reach);
    before_ = point;
    triangle_ = nearest.triangle;
    distance_ = std::sqrt(nearest.squared);
    return distance_;
  }

 private:
  const MeasuredSurface& to_;
  Eigen::Vector3d before_ = Eigen::Vector3d::Zero();
  int triangle_ = -1;
  double distance_ = std::numeric_limits<double>::infinity();  // of the previous point [m]
};

Eigen::VectorXd VertexDistances(const MeasuredSurface& from, const MeasuredSurface& to) {
  Eigen::VectorXd distances = Eigen::VectorXd::Constant(from.vertices().cols(), kNoDistance);
  Walk walk(to);
  for (const auto triangle : from.triangles().colwise()) {
    for (const int vertex : triangle) {
      if (std::isnan(distances[vertex])) distances[vertex] = walk.DistanceAt(from.vertices().col(vertex));
    }
  }
  return distances;
}

std::vector<Weighted> SampleDistances(const MeasuredSurface& from, const MeasuredSurface& to,
                                      const Sampling& sampling) {
  std::vector<Weighted> samples;
  samples.reserve(static_cast<std::size_t>(sampling.samples));
  Walk walk(to);
  ForEachSample(from.vertices(), from.triangles(), sampling, [&](const Eigen::Vector3d& point, double area) {
    samples.push_back({walk.DistanceAt(point), area});
  });
  std::sort(samples.begin(), samples.end());
  return samples;
}

Directed Measure(const MeasuredSurface& from, const MeasuredSurface& to, const Sampling& sampling) {
  Directed directed;
  directed.at_vertices = VertexDistances(from, to);
  directed.samples = SampleDistances(from, to, sampling);
  double found = directed.samples.back().distance;
  for (const int vertex : from.used()) found = std::max(found, directed.at_vertices[vertex]);
  directed.farthest = FindFarthest(from, to, directed.at_vertices, found);
  return directed;
}

// Sums over samples in ascending order of distance, so that the result does not depend on the order of the triangles.
struct Sums {
  explicit Sums(const std::vector<Weighted>& samples, double tolerance) {
    for (const Weighted& sample : samples) {
      area += sample.area;
      first += sample.area * sample.distance;
      second += sample.area * sample.distance * sample.distance;
      if (sample.distance <= tolerance) within += sample.area;
    }
  }
  double area = 0, first = 0, second = 0, within = 0;
};

// Returns the area-weighted 95th percentile; NaN without area.
double Percentile95(const std::vector<Weighted>& samples) {
  double total = 0, area = 0;
  for (const Weighted& sample : samples) total += sample.area;
  if (!(total > 0)) return kNoDistance;
  for (const Weighted& sample : samples) {
    area += sample.area;
    if (area >= 0.95 * total) return sample.distance;
  }
  return samples.back().distance;
}

std::vector<Weighted> Pooled(const std::vector<Weighted>& a, const std::vector<Weighted>& b) {
  std::vector<Weighted> both;
  both.reserve(a.size() + b.size());
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

// Returns a message in which every distance is NaN.
v1::SurfaceDistance Unknown() {
  v1::SurfaceDistance distance;
  const auto* descriptor = v1::SurfaceDistance::descriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    if (descriptor->field(i)->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) continue;
    distance.GetReflection()->SetDouble(&distance, descriptor->field(i), kNoDistance);
  }
  return distance;
}

void FillMeans(const Directed& a, const Directed& b, double tolerance, v1::SurfaceDistance& distance) {
  const Sums of_a(a.samples, tolerance), of_b(b.samples, tolerance);
  distance.set_mean_a_to_b(kMillimetresAMetre * of_a.first / of_a.area);
  distance.set_mean_b_to_a(kMillimetresAMetre * of_b.first / of_b.area);
  distance.set_rms_a_to_b(kMillimetresAMetre * std::sqrt(of_a.second / of_a.area));
  distance.set_rms_b_to_a(kMillimetresAMetre * std::sqrt(of_b.second / of_b.area));
  distance.set_assd(kMillimetresAMetre * (of_a.first + of_b.first) / (of_a.area + of_b.area));
  distance.set_surface_dice((of_a.within + of_b.within) / (of_a.area + of_b.area));
}

void FillLargest(const Directed& a, const Directed& b, v1::SurfaceDistance& distance) {
  const double p95_a = Percentile95(a.samples), p95_b = Percentile95(b.samples);
  distance.set_p95_a_to_b(kMillimetresAMetre * p95_a);
  distance.set_p95_b_to_a(kMillimetresAMetre * p95_b);
  distance.set_hd95_max(kMillimetresAMetre * (std::isnan(p95_a) ? p95_a : std::max(p95_b, p95_a)));
  distance.set_hd95_pooled(kMillimetresAMetre * Percentile95(Pooled(a.samples, b.samples)));
  distance.set_hd_a_to_b(kMillimetresAMetre * a.farthest.found);
  distance.set_hd_b_to_a(kMillimetresAMetre * b.farthest.found);
  distance.set_hd_max(kMillimetresAMetre * std::max(a.farthest.found, b.farthest.found));
  distance.set_hd_max_bound(kMillimetresAMetre * std::max(a.farthest.bound, b.farthest.bound));
}

}  // namespace

absl::StatusOr<v1::SurfaceDistance> MeasureDistance(const MeasuredSurface& a, const MeasuredSurface& b,
                                                    const DistanceOptions& options, Eigen::VectorXd* at_vertices) {
  const auto sampling_a = PlanSampling(a.vertices(), a.triangles(), options.spacing);
  if (!sampling_a.ok()) return sampling_a.status();
  const auto sampling_b = PlanSampling(b.vertices(), b.triangles(), options.spacing);
  if (!sampling_b.ok()) return sampling_b.status();
  v1::SurfaceDistance distance = Unknown();
  distance.set_samples_a(sampling_a->samples);
  distance.set_samples_b(sampling_b->samples);
  distance.set_spacing_a(a.empty() ? kNoDistance : kMillimetresAMetre * sampling_a->longest);
  distance.set_spacing_b(b.empty() ? kNoDistance : kMillimetresAMetre * sampling_b->longest);
  distance.set_area_a(kSquareMillimetres * a.Area());
  distance.set_area_b(kSquareMillimetres * b.Area());
  if (at_vertices != nullptr) at_vertices->setConstant(a.vertices().cols(), kNoDistance);
  if (a.empty() || b.empty()) return distance;
  // Each direction has its own sums, so that the result does not depend on the threads.
  std::future<Directed> later = std::async([&] { return Measure(b, a, *sampling_b); });
  Directed from_a = Measure(a, b, *sampling_a);
  const Directed from_b = later.get();
  FillMeans(from_a, from_b, options.tolerance, distance);
  FillLargest(from_a, from_b, distance);
  if (at_vertices != nullptr) *at_vertices = std::move(from_a.at_vertices);
  return distance;
}

}  // namespace phrenic::compare
