#include "tests/anatomy/silhouette.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "server/mesh/nearest.h"

namespace phrenic::anatomy {
namespace {

constexpr double kPixel = 0.5e-3, kCamera = 0.5;  // [m]

// Returns the axes of a view: right, up and towards the camera.
Eigen::Matrix3d AxesOf(View view) {
  const Eigen::Vector3d left = Eigen::Vector3d::UnitX(), back = Eigen::Vector3d::UnitY(), up = Eigen::Vector3d::UnitZ();
  const auto axes = [](const Eigen::Vector3d& above, const Eigen::Vector3d& towards) {
    Eigen::Matrix3d rows;
    rows << above.cross(towards).transpose(), above.transpose(), towards.transpose();
    return rows;
  };
  switch (view) {
    case View::kFront:
      return axes(up, -back);
    case View::kBack:
      return axes(up, back);
    case View::kLeft:
      return axes(up, left);
    case View::kRight:
      return axes(up, -left);
    case View::kAbove:
      return axes(-back, up);
    case View::kBelow:
      return axes(-back, -up);
  }
  return Eigen::Matrix3d::Identity();
}

// A picture in which the pixels that a surface covers are set.
class Picture {
 public:
  // Requires: all points that are drawn lie between the corners, a pixel from them or more.
  Picture(const Eigen::Array2d& low, const Eigen::Array2d& high)
      : low_(low), size_(((high - low) / kPixel).ceil().cast<int>()), covered_(size_.x() * size_.y(), false) {}

  void Draw(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    const Eigen::Array2i from = PixelOf(a.cwiseMin(b).cwiseMin(c)), to = PixelOf(a.cwiseMax(b).cwiseMax(c));
    for (int i = from.x(); i <= to.x(); ++i) {
      for (int j = from.y(); j <= to.y(); ++j) {
        const Eigen::Vector2d at = Middle(i, j);
        const double ab = Turn(a, b, at), bc = Turn(b, c, at), ca = Turn(c, a, at);
        if (std::min({ab, bc, ca}) >= 0 || std::max({ab, bc, ca}) <= 0) covered_[Index(i, j)] = true;
      }
    }
  }

  // Returns the middles of the covered pixels beside one that is not.
  Points Border() const {
    std::vector<Eigen::Vector3d> border;
    for (int i = 1; i + 1 < size_.x(); ++i) {
      for (int j = 1; j + 1 < size_.y(); ++j) {
        if (!covered_[Index(i, j)]) continue;
        const bool inside = covered_[Index(i - 1, j)] && covered_[Index(i + 1, j)] && covered_[Index(i, j - 1)] &&
                            covered_[Index(i, j + 1)];
        if (!inside) border.emplace_back(Middle(i, j).x(), Middle(i, j).y(), 0);
      }
    }
    Points points(3, border.size());
    for (size_t k = 0; k < border.size(); ++k) points.col(static_cast<Eigen::Index>(k)) = border[k];
    return points;
  }

 private:
  static double Turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  }
  Eigen::Array2i PixelOf(const Eigen::Vector2d& at) const {
    return ((at.array() - low_) / kPixel).floor().cast<int>().max(0).min(size_ - 1);
  }
  Eigen::Vector2d Middle(int i, int j) const { return low_ + kPixel * (Eigen::Array2d(i, j) + 0.5); }
  size_t Index(int i, int j) const {
    return static_cast<size_t>(i) * static_cast<size_t>(size_.y()) + static_cast<size_t>(j);
  }

  Eigen::Array2d low_;
  Eigen::Array2i size_;
  std::vector<bool> covered_;
};

Eigen::Vector3d Centroid(const Points& points) { return points.rowwise().mean(); }

double Size(const Points& points) {
  return std::sqrt((points.colwise() - Centroid(points)).colwise().squaredNorm().mean());
}

double DirectedDistance(const Points& from, const NearestSearch& to) {
  double sum = 0;
  for (const auto& point : from.colwise()) sum += to.Nearest(point).distance;
  return sum / static_cast<double>(from.cols());
}

// Returns the middles of about `count` triangles that share the area evenly.
Points EvenSamples(const Mesh& mesh, int count) {
  const auto corner = [&](Eigen::Index t, int k) { return mesh.vertices.col(mesh.triangles(k, t)); };
  Eigen::VectorXd areas(mesh.triangles.cols());
  for (Eigen::Index t = 0; t < areas.size(); ++t) {
    const Eigen::Vector3d u = corner(t, 1) - corner(t, 0), v = corner(t, 2) - corner(t, 0);
    areas[t] = u.cross(v).norm();
  }
  const double share = areas.sum() / count;
  Points samples(3, count + 1);
  Eigen::Index taken = 0;
  double passed = share / 2;
  for (Eigen::Index t = 0; t < areas.size(); ++t) {
    for (passed += areas[t]; passed >= share && taken < samples.cols(); passed -= share) {
      samples.col(taken++) = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3;
    }
  }
  return samples.leftCols(taken);
}

}  // namespace

Points Outline(const Mesh& mesh, View view, const Eigen::Vector3d& centre) {
  const Points seen = AxesOf(view) * (mesh.vertices.colwise() - centre);
  Eigen::Matrix2Xd plane(2, seen.cols());
  for (Eigen::Index i = 0; i < seen.cols(); ++i)
    plane.col(i) = seen.col(i).head<2>() * kCamera / (kCamera - seen(2, i));
  Picture picture(plane.rowwise().minCoeff().array() - 2 * kPixel, plane.rowwise().maxCoeff().array() + 2 * kPixel);
  for (const auto& t : mesh.triangles.colwise()) picture.Draw(plane.col(t[0]), plane.col(t[1]), plane.col(t[2]));
  return picture.Border();
}

double MeanDistance(const Points& a, const Points& b) {
  return (DirectedDistance(a, NearestSearch(b)) + DirectedDistance(b, NearestSearch(a))) / 2;
}

Eigen::Affine3d Registered(const Mesh& mesh, const Mesh& target) {
  constexpr int kSamples = 1500, kRounds = 60;
  const Points ours = EvenSamples(mesh, kSamples), theirs = EvenSamples(target, kSamples);
  const NearestSearch there(theirs);
  Eigen::Affine3d to_target = Eigen::Translation3d(Centroid(theirs)) * Eigen::Scaling(Size(theirs) / Size(ours)) *
                              Eigen::Translation3d(-Centroid(ours));
  Points from(3, ours.cols() + theirs.cols()), to(3, from.cols());
  for (int round = 0; round < kRounds; ++round) {
    const Points moved = to_target * ours;
    const NearestSearch here(moved);
    for (Eigen::Index i = 0; i < from.cols(); ++i) {
      const bool forth = i < ours.cols();
      const Eigen::Index j = forth ? i : i - ours.cols();
      from.col(i) = ours.col(forth ? j : here.Nearest(theirs.col(j)).vertex);
      to.col(i) = theirs.col(forth ? there.Nearest(moved.col(j)).vertex : j);
    }
    to_target = Eigen::umeyama(from, to, true);
  }
  return to_target;
}

}  // namespace phrenic::anatomy
