#include "server/mesh/plate_curvature.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "server/mesh/half_edges.h"

namespace phrenic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kFitHinges = 5;              // the edge's own, and four around its triangles
constexpr double kLeastEigenvalue = 1e-4;  // of a fit, relative to the largest: what is smaller is not determined

// The values of x^2/2, y^2/2 and xy.
Vector3d Quadratics(const Vector2d& p) { return {p.x() * p.x() / 2, p.y() * p.y() / 2, p.x() * p.y()}; }

// A vertex r seen from the edge pq: its foot on the edge as a fraction from p to q, and its distance.
struct Apex {
  double foot, height;
};

template <typename Point>
Apex ApexOf(const Point& p, const Point& q, const Point& r) {
  const Point edge = q - p;
  const double foot = edge.dot(r - p) / edge.squaredNorm();
  return {foot, (r - p - foot * edge).norm()};
}

// The slopes, towards r, of the linear interpolations in the triangle pqr of the three quadratics, relative to their
// interpolation on pq.
Vector3d SlopesTowards(const Vector2d& p, const Vector2d& q, const Vector2d& r) {
  const Apex apex = ApexOf(p, q, r);
  return (Quadratics(r) - (1 - apex.foot) * Quadratics(p) - apex.foot * Quadratics(q)) / apex.height;
}

// The part of the first triangle in the angle of a hinge.
struct Split {
  int count = 0;
  std::array<int, kFitHinges> hinges{};
  Eigen::Matrix<double, kFitHinges, 1> first = decltype(first)::Zero();
};

// A side of a hinge: a triangle and the corner opposite the edge.
struct Side {
  int triangle, corner;
};

// The triangles of a sheet and their neighbours.
class Sheet {
 public:
  Sheet(const ConstPoints& vertices, const Triangles& triangles, const std::vector<bool>& held)
      : vertices_(vertices), triangles_(triangles), held_(triangles.cols()) {
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
      held_[t] = held[triangles(0, t)] && held[triangles(1, t)] && held[triangles(2, t)];
    }
    hinge_of_ = Eigen::Matrix3Xi::Constant(3, triangles.cols(), -1);
    const std::vector<HalfEdge> half_edges = SortedHalfEdges(triangles);
    ForEachEdge(half_edges, [&](auto first, auto last) {
      if (last - first == 2 && first->forward != (first + 1)->forward) AddHinge(*first, *(first + 1));
    });
    for (size_t h = 0; h < hinges_.size(); ++h) splits_.push_back(SplitOf(static_cast<int>(h)));
  }

  // Sets `plate` to the triangle's; false if it has no curvature.
  bool Curve(int t, double poissons_ratio, PlateTriangle& plate) const;
  const std::vector<Eigen::Vector4i>& hinges() const { return hinges_; }

 private:
  using Slopes = Eigen::Matrix<double, kPlateHinges, 3>;  // s_e - g_T by hinges, one column per edge of the triangle

  Vector3d At(int vertex) const { return vertices_.col(vertex); }
  Vector3d Corner(const Side& side, int further) const {
    return At(triangles_((side.corner + further) % 3, side.triangle));
  }
  double Area(int t) const {
    const Side side{t, 0};
    return (Corner(side, 1) - Corner(side, 0)).cross(Corner(side, 2) - Corner(side, 0)).norm() / 2;
  }
  void AddHinge(const HalfEdge& first, const HalfEdge& second);
  Side SideOf(const HalfEdge& half_edge) const {
    for (int k = 0; k < 2; ++k) {
      const int vertex = triangles_(k, half_edge.triangle);
      if (vertex != half_edge.low && vertex != half_edge.high) return {half_edge.triangle, k};
    }
    return {half_edge.triangle, 2};
  }
  const Side& Across(int hinge, int triangle) const {
    return sides_[hinge][sides_[hinge][0].triangle == triangle ? 1 : 0];
  }
  Split SplitOf(int hinge) const;
  void AddSlope(int t, int k, PlateTriangle& plate, Slopes& slopes) const;
  static int Column(int hinge, PlateTriangle& plate);
  void NumberVertices(PlateTriangle& plate) const;

  const ConstPoints vertices_;
  const Triangles& triangles_;
  std::vector<bool> held_;  // one per triangle
  std::vector<Eigen::Vector4i> hinges_;
  std::vector<std::array<Side, 2>> sides_;  // one per hinge
  Eigen::Matrix3Xi hinge_of_;               // of the edge opposite each corner; -1 at a border
  std::vector<Split> splits_;               // one per hinge
};

void Sheet::AddHinge(const HalfEdge& first, const HalfEdge& second) {
  if (Area(first.triangle) == 0 || Area(second.triangle) == 0) return;
  const Side left = SideOf(first.forward ? first : second), right = SideOf(first.forward ? second : first);
  for (const Side& side : {left, right}) hinge_of_(side.corner, side.triangle) = static_cast<int>(hinges_.size());
  hinges_.emplace_back(first.low, first.high, triangles_(left.corner, left.triangle),
                       triangles_(right.corner, right.triangle));
  sides_.push_back({left, right});
}

// Finds coefficients c with c t(q) = slope of the first triangle (q) for all quadratics q about the middle of the edge,
// whose own slope is 0 there, as close as possible to a division by the heights of the triangles.
Split Sheet::SplitOf(int hinge) const {
  const Vector3d a = At(hinges_[hinge][0]), b = At(hinges_[hinge][1]);
  const double length = (b - a).norm();
  const std::array<Vector2d, 2> ends = {Vector2d(-0.5, 0), Vector2d(0.5, 0)};
  std::array<Vector2d, 2> apices;
  std::array<double, 2> heights{};
  for (int s = 0; s < 2; ++s) {
    const Apex apex = ApexOf(a, b, At(hinges_[hinge][2 + s]));
    heights[s] = apex.height;
    apices[s] = {apex.foot - 0.5, (s == 0 ? 1 : -1) * apex.height / length};
  }
  Eigen::Matrix<double, 3, kFitHinges> angles = decltype(angles)::Zero();
  Split split;
  const auto add = [&](int which, const Vector3d& angle) {
    split.hinges[split.count] = which;
    angles.col(split.count++) = angle;
  };
  const Vector3d slope = SlopesTowards(ends[0], ends[1], apices[0]);
  add(hinge, slope + SlopesTowards(ends[0], ends[1], apices[1]));
  for (int s = 0; s < 2; ++s) {
    const Side& side = sides_[hinge][s];
    const std::array<Vector2d, 3> corners = {apices[s], ends[s], ends[1 - s]};
    for (int d = 1; d < 3; ++d) {  // the edge opposite corner d
      const int other = hinge_of_((side.corner + d) % 3, side.triangle);
      if (other < 0) continue;
      const Side& outer = Across(other, side.triangle);
      if (held_[outer.triangle]) continue;  // its curvature is not that of the plate
      const Vector2d &p = corners[(d + 1) % 3], &q = corners[(d + 2) % 3], &inner = corners[d];
      const Apex apex = ApexOf(Corner(side, d + 1), Corner(side, d + 2), Corner(outer, 0));
      const Vector2d edge = q - p, normal = Vector2d(edge.y(), -edge.x()).normalized();
      const Vector2d out = p + apex.foot * edge + apex.height / length * (normal.dot(inner - p) > 0 ? -1 : 1) * normal;
      add(other, SlopesTowards(p, q, inner) + SlopesTowards(p, q, out));
    }
  }
  split.first[0] = heights[0] / (heights[0] + heights[1]);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> gram(angles * angles.transpose());
  const double least = kLeastEigenvalue * gram.eigenvalues()[2];
  const Vector3d inverse =
      gram.eigenvalues().unaryExpr([least](double value) { return value > least ? 1 / value : 0; });
  const Vector3d residual = gram.eigenvectors().transpose() * (slope - angles * split.first);
  split.first += angles.transpose() * (gram.eigenvectors() * inverse.cwiseProduct(residual));
  return split;
}

int Sheet::Column(int hinge, PlateTriangle& plate) {
  const auto end = plate.hinges.begin() + plate.count;
  const auto found = std::find(plate.hinges.begin(), end, hinge);
  if (found == end) plate.hinges[plate.count++] = hinge;
  return static_cast<int>(found - plate.hinges.begin());
}

// Sets the column of edge k, opposite corner k: the angle between the triangle and the plate's normal at its middle.
void Sheet::AddSlope(int t, int k, PlateTriangle& plate, Slopes& slopes) const {
  const int hinge = hinge_of_(k, t);
  const bool is_first = sides_[hinge][0].triangle == t;
  const int own = Column(hinge, plate);
  if (held_[Across(hinge, t).triangle]) {
    slopes(own, k) = 1;
    return;
  }
  const Split& split = splits_[hinge];
  if (!is_first) slopes(own, k) = 1;
  for (int i = 0; i < split.count; ++i) {
    slopes(Column(split.hinges[i], plate), k) += (is_first ? 1 : -1) * split.first[i];
  }
}

void Sheet::NumberVertices(PlateTriangle& plate) const {
  for (int h = 0; h < plate.count; ++h) {
    for (int k = 0; k < 4; ++k) {
      const int vertex = hinges_[plate.hinges[h]][k];
      const auto end = plate.vertices.begin() + plate.vertex_count;
      const auto found = std::find(plate.vertices.begin(), end, vertex);
      if (found == end) plate.vertices[plate.vertex_count++] = vertex;
      plate.ends[h][k] = static_cast<int>(found - plate.vertices.begin());
    }
  }
}

// The square root of the energy's form, of k = slope n n^T: |result|^2 = A ((1 - nu) k:k + nu tr(k)^2).
Vector3d RootOf(double area, double poissons_ratio, double slope, const Vector2d& n) {
  const double scale = std::sqrt(area) * slope, nu = poissons_ratio;
  return scale * Vector3d(std::sqrt((1 + nu) / 2), std::sqrt((1 - nu) / 2) * (n.x() * n.x() - n.y() * n.y()),
                          std::sqrt(2 * (1 - nu)) * n.x() * n.y());
}

// One column per edge opposite each corner: the root of |e|/A n n^T.
Eigen::Matrix3d RootsOfEdges(const std::array<Vector3d, 3>& corners, double area, double poissons_ratio) {
  const Vector3d along = (corners[1] - corners[0]).normalized();
  const Apex apex = ApexOf(corners[0], corners[1], corners[2]);
  const double base = (corners[1] - corners[0]).norm();
  const std::array<Vector2d, 3> flat = {Vector2d(0, 0), Vector2d(base, 0),
                                        Vector2d((corners[2] - corners[0]).dot(along), apex.height)};
  Eigen::Matrix3d roots;
  for (int k = 0; k < 3; ++k) {
    const Vector2d edge = flat[(k + 2) % 3] - flat[(k + 1) % 3];
    const double length = edge.norm();
    roots.col(k) = RootOf(area, poissons_ratio, length / area, Vector2d(edge.y(), -edge.x()) / length);
  }
  return roots;
}

// Returns the columns of `roots` with the slopes of border edges eliminated: what the others leave of the energy's root
// is its part orthogonal to the columns of the border.
Eigen::Matrix3d WithoutBorder(Eigen::Matrix3d roots, const std::array<bool, 3>& border) {
  for (int pass = 0; pass < 3; ++pass) {  // Gram-Schmidt
    if (!border[pass]) continue;
    const Vector3d axis = roots.col(pass).normalized();
    roots -= (axis * (axis.transpose() * roots)).eval();
  }
  return roots;
}

bool Sheet::Curve(int t, double poissons_ratio, PlateTriangle& plate) const {
  const double area = Area(t);
  if (held_[t] || area == 0 || hinge_of_.col(t).maxCoeff() < 0) return false;
  plate.triangle = t;
  Slopes slopes = Slopes::Zero();
  std::array<bool, 3> border{};
  for (int k = 0; k < 3; ++k) {
    border[k] = hinge_of_(k, t) < 0;
    if (!border[k]) AddSlope(t, k, plate, slopes);
  }
  const Side side{t, 0};
  const Eigen::Matrix3d roots = RootsOfEdges({Corner(side, 0), Corner(side, 1), Corner(side, 2)}, area, poissons_ratio);
  plate.bend = WithoutBorder(roots, border) * slopes.transpose();
  NumberVertices(plate);
  return true;
}

// Leaves out hinges that no triangle uses.
Plate Compacted(const std::vector<Eigen::Vector4i>& hinges, std::vector<PlateTriangle> triangles) {
  std::vector<int> number(hinges.size(), -1);
  Plate plate;
  for (PlateTriangle& triangle : triangles) {
    for (int i = 0; i < triangle.count; ++i) {
      int& index = number[triangle.hinges[i]];
      if (index < 0) {
        index = static_cast<int>(plate.hinges.size());
        plate.hinges.push_back(hinges[triangle.hinges[i]]);
      }
      triangle.hinges[i] = index;
    }
  }
  plate.triangles = std::move(triangles);
  return plate;
}

}  // namespace

Plate MakePlate(const ConstPoints& vertices, const Triangles& triangles, const std::vector<bool>& held,
                const std::vector<bool>& taken, double poissons_ratio) {
  const Sheet sheet(vertices, triangles, held);
  std::vector<PlateTriangle> plates;
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    if (!taken[t]) continue;
    PlateTriangle plate;
    if (sheet.Curve(t, poissons_ratio, plate)) plates.push_back(plate);
  }
  return Compacted(sheet.hinges(), std::move(plates));
}

}  // namespace phrenic
