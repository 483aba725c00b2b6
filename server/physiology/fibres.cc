#include "server/physiology/fibres.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "server/mesh/harmonic.h"
#include "server/mesh/triangle_tree.h"
#include "server/physiology/parts.h"

namespace phrenic::physiology {
namespace {

constexpr double kAtWall = 0.006;                      // [m]
constexpr double kBeside = 0.06, kMidaxillary = 0.05;  // from the midline; in front of and behind the middle [m]

std::vector<bool> Marked(const Mesh& mesh, const std::string& region) {
  std::vector<bool> marked(static_cast<size_t>(mesh.vertices.cols()), false);
  const auto found = mesh.regions.find(region);
  if (found == mesh.regions.end()) return marked;
  for (const int i : found->second) marked[static_cast<size_t>(i)] = true;
  return marked;
}

int CountOf(const std::vector<bool>& marked, const Eigen::Vector3i& corners) {
  return marked[corners[0]] + marked[corners[1]] + marked[corners[2]];
}

double AreaOf(const ConstPoints& x, const Eigen::Vector3i& t) {
  const Eigen::Vector3d a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
  return (b - a).cross(c - a).norm() / 2;
}

// Returns the length of the segment in which the plane x_axis = at cut a triangle at rest, in which its points have
// moved with the material to `x`; 0 if it does not cut it.
double SegmentLength(const ConstPoints& rest, const ConstPoints& x, const Eigen::Vector3i& t, int axis, double at) {
  Eigen::Vector3d ends[2];
  int found = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = t[k], j = t[(k + 1) % 3];
    const double before = rest(axis, i) - at, after = rest(axis, j) - at;
    if ((before < 0) == (after < 0)) continue;
    ends[found++] = x.col(i) + before / (before - after) * (x.col(j) - x.col(i));
  }
  return found == 2 ? (ends[1] - ends[0]).norm() : 0;
}

// The wall at one moment.
class Wall {
 public:
  Wall(const Mesh& mesh, const ConstPoints& x) : x_(x), tree_(x, mesh.triangles) { tree_.Fit(x_, boxes_); }
  // True if a point is within kAtWall.
  bool Touches(const Eigen::Vector3d& point) const { return tree_.Nearest(x_, boxes_, point, kAtWall).triangle >= 0; }

 private:
  const Points x_;
  const TriangleTree tree_;
  TriangleTree::Boxes boxes_;
};

}  // namespace

Fibres::Fibres(const Mesh& rest) : rest_(rest) {
  const std::string from = rest.regions.count("insertion") > 0 ? "insertion" : "rim";
  if (rest.regions.count(from) == 0 || rest.regions.count("tendon") == 0) return;
  const std::vector<bool> tendon = Marked(rest, "tendon");
  const std::vector<bool> openings[] = {Marked(rest, "oesophageal-opening"), Marked(rest, "caval-opening"),
                                        Marked(rest, "aortic-hiatus")};
  const auto closes = [&](const Eigen::Vector3i& corners) {
    return std::any_of(std::begin(openings), std::end(openings),
                       [&](const auto& opening) { return CountOf(opening, corners) == 3; });
  };
  const auto u = HarmonicBetween(rest, Marked(rest, from), tendon);
  if (!u.ok()) return;
  for (const Eigen::Vector3i corners : rest.triangles.colwise()) {
    if (closes(corners)) continue;
    if (CountOf(tendon, corners) >= 2) {
      tendon_.push_back(corners);
    } else {
      AddMuscle(corners, *u);
    }
  }
}

void Fibres::AddMuscle(const Eigen::Vector3i& corners, const Eigen::VectorXd& u) {
  const Points& x = rest_.vertices;
  Eigen::Matrix<double, 3, 2> edges;
  edges << x.col(corners[1]) - x.col(corners[0]), x.col(corners[2]) - x.col(corners[0]);
  const Eigen::Matrix2d metric = edges.transpose() * edges;
  if (metric.determinant() <= 0) return;
  const Eigen::Vector2d slope(u[corners[1]] - u[corners[0]], u[corners[2]] - u[corners[0]]);
  const Eigen::Vector2d gradient = metric.inverse() * slope;  // in the edges' basis
  const double size = (edges * gradient).norm(), area = std::sqrt(metric.determinant()) / 2;
  if (!(size > 0)) return;
  muscle_.push_back({corners, gradient[0] / size, gradient[1] / size, area});
}

double Fibres::StretchAlong(const Triangle& t, const ConstPoints& x) {
  const Eigen::Vector3d origin = x.col(t.corners[0]);
  return (t.first * (x.col(t.corners[1]) - origin) + t.second * (x.col(t.corners[2]) - origin)).norm();
}

double Fibres::Shortening(const ConstPoints& from, const ConstPoints& to) const {
  double before = 0, after = 0;
  for (const Triangle& t : muscle_) {
    before += t.area * StretchAlong(t, from);
    after += t.area * StretchAlong(t, to);
  }
  return before > 0 ? 1 - after / before : kNone;
}

double Fibres::SectionShortening(int axis, double at, const ConstPoints& from, const ConstPoints& to) const {
  double before = 0, after = 0;
  for (const Triangle& t : muscle_) {
    before += SegmentLength(rest_.vertices, from, t.corners, axis, at);
    after += SegmentLength(rest_.vertices, to, t.corners, axis, at);
  }
  return before > 0 ? 1 - after / before : kNone;
}

double Fibres::StrainAcross(double share, const ConstPoints& from, const ConstPoints& to) const {
  std::vector<std::pair<double, double>> strains;  // and area
  double all = 0;
  for (const Triangle& t : muscle_) {
    const double area = AreaOf(to, t.corners) / AreaOf(from, t.corners);
    strains.emplace_back(std::abs(area / (StretchAlong(t, to) / StretchAlong(t, from)) - 1), t.area);
    all += t.area;
  }
  std::sort(strains.begin(), strains.end());
  double so_far = 0;
  for (const auto& [strain, area] : strains) {
    so_far += area;
    if (so_far >= share * all) return strain;
  }
  return kNone;
}

double Fibres::TendonAreaChange(const ConstPoints& from, const ConstPoints& to) const {
  double before = 0, after = 0;
  for (const Eigen::Vector3i& corners : tendon_) before += AreaOf(from, corners), after += AreaOf(to, corners);
  return before > 0 ? std::abs(after / before - 1) : kNone;
}

double Fibres::ThickeningAtWall(const Mesh& wall, const ConstPoints& wall_from, const ConstPoints& wall_to,
                                const ConstPoints& from, const ConstPoints& to) const {
  const Wall before(wall, wall_from), after(wall, wall_to);
  const double middle = (rest_.vertices.row(1).minCoeff() + rest_.vertices.row(1).maxCoeff()) / 2;
  double sum = 0, weight = 0;
  for (const Triangle& t : muscle_) {
    const Eigen::Vector3d at = rest_.vertices(Eigen::all, t.corners).rowwise().mean();
    if (std::abs(at.x()) < kBeside || std::abs(at.y() - middle) > kMidaxillary) continue;
    if (!before.Touches(from(Eigen::all, t.corners).rowwise().mean())) continue;
    if (!after.Touches(to(Eigen::all, t.corners).rowwise().mean())) continue;
    sum += t.area * AreaOf(from, t.corners) / AreaOf(to, t.corners);
    weight += t.area;
  }
  return weight > 0 ? sum / weight : kNone;
}

}  // namespace phrenic::physiology
