#include "server/fluoroscopy/projection.h"

#include <algorithm>
#include <cmath>

namespace phrenic::fluoroscopy {
namespace {

using Corner = Eigen::Vector3d;  // x and y [pixels from the upper left corner], z = depth + source distance [m]

// Returns on which side of the edge a point lies: exactly opposite for the opposite edge, since the ends have an order.
double SideOf(const Corner& from, const Corner& to, double x, double y) {
  const bool swap = from.x() > to.x() || (from.x() == to.x() && from.y() > to.y());
  const Corner &a = swap ? to : from, &b = swap ? from : to;
  const double value = (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
  return swap ? -value : value;
}

// True if a point is inside of an edge; of two triangles beside an edge, one has the points on it.
bool IsWithin(double value, const Corner& from, const Corner& to, int facing) {
  if (value != 0) return value > 0;
  const double dx = facing * (to.x() - from.x()), dy = facing * (to.y() - from.y());
  return dy < 0 || (dy == 0 && dx > 0);
}

class Raster {
 public:
  Raster(const Projection& projection, int size)
      : projection_(projection), size_(size), sums_(Picture::Zero(size, size)) {}

  void Add(const Absorber& absorber) {
    const Points screen = Screen(absorber.vertices);
    for (const auto& t : absorber.triangles.colwise()) {
      AddTriangle(screen.col(t[0]), screen.col(t[1]), screen.col(t[2]), absorber.weight);
    }
  }

  const Picture& sums() const { return sums_; }

 private:
  Points Screen(const Points& vertices) const {
    Eigen::Matrix3d axes;
    axes << projection_.right.transpose(), -projection_.up.transpose(), projection_.to_detector.transpose();
    Points screen = axes * (vertices.colwise() - projection_.isocentre);
    const double source = projection_.source_distance, pixels = size_ / 2.0 / projection_.half_width;
    for (auto corner : screen.colwise()) {
      corner.z() += source;
      const double scale = pixels / (source == 0 ? 1 : corner.z() / source);
      corner.head<2>() = Eigen::Vector2d::Constant(size_ / 2.0) + scale * corner.head<2>();
    }
    return screen;
  }

  // The first and last pixel whose middle may lie between the smallest and the largest of three coordinates.
  std::pair<int, int> Pixels(double a, double b, double c) const {
    const auto [low, high] = std::minmax({a, b, c});
    return {static_cast<int>(std::ceil(std::max(low, 0.0) - 0.5)),
            static_cast<int>(std::floor(std::min<double>(high, size_) - 0.5))};
  }

  void AddTriangle(const Corner& a, const Corner& b, const Corner& c, double weight) {
    const double area = SideOf(a, b, c.x(), c.y());
    if (area == 0) return;
    const int facing = area < 0 ? 1 : -1;  // rows go down: a front face is clockwise here
    const auto [left, right] = Pixels(a.x(), b.x(), c.x());
    const auto [top, bottom] = Pixels(a.y(), b.y(), c.y());
    for (int row = std::max(0, top); row <= std::min(size_ - 1, bottom); ++row) {
      for (int column = std::max(0, left); column <= std::min(size_ - 1, right); ++column) {
        const double x = column + 0.5, y = row + 0.5;
        const double u = -facing * SideOf(b, c, x, y), v = -facing * SideOf(c, a, x, y),
                     w = -facing * SideOf(a, b, x, y);
        if (!IsWithin(u, b, c, facing) || !IsWithin(v, c, a, facing) || !IsWithin(w, a, b, facing)) continue;
        const Eigen::Vector3d parts = Eigen::Vector3d(u, v, w) / (u + v + w);
        sums_(row, column) += facing * weight * Distance({a.z(), b.z(), c.z()}, parts, x, y);
      }
    }
  }

  // Distance along the ray from the source, or from the isocentre's plane for parallel rays [m].
  double Distance(const Eigen::Vector3d& depths, const Eigen::Vector3d& parts, double x, double y) const {
    const double source = projection_.source_distance;
    if (source == 0) return parts.dot(depths);
    const double scale = 2 * projection_.half_width / size_ / source;
    return std::hypot((x - size_ / 2.0) * scale, (y - size_ / 2.0) * scale, 1.0) / parts.dot(depths.cwiseInverse());
  }

  const Projection& projection_;
  int size_;
  Picture sums_;
};

}  // namespace

Picture LineIntegrals(const std::vector<Absorber>& absorbers, const Projection& projection, int size) {
  Raster raster(projection, size);
  for (const Absorber& absorber : absorbers) raster.Add(absorber);
  return raster.sums();
}

}  // namespace phrenic::fluoroscopy
