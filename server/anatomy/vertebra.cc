#include "server/anatomy/vertebra.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/implicit_surface.h"
#include "server/anatomy/smooth.h"

namespace phrenic::anatomy {
namespace {

struct Shape {
  double width, depth, height;  // of the body
  double transverse, backward;  // extent of the transverse processes, lateral and posterior
  double spine, slope;          // length of the spinous process and its slope below the horizontal [rad]
  double canal;                 // half width of the vertebral canal
  Eigen::Vector3d along_spine;  // unit direction of the spinous process

  bool Lumbar() const { return canal > 10; }
};

Shape ShapeOf(int number) {
  const VertebralBody body = BodyOfVertebra(number);
  const bool lumbar = number > 12;
  const double middle = std::exp(-(number - 6.5) * (number - 6.5) / 10.0);  // 1 at T6 and T7, 0 at T1 and T12
  const double transverse = lumbar ? 36 + (number - 13) * 2.0 : 36 - 13 * Smooth((number - 8.5) / 4);
  const double slope = lumbar ? 0.12 : 0.35 + 0.75 * middle;
  return {body.width, body.depth,          body.top - body.bottom,
          transverse, lumbar ? 4.0 : 14.0, lumbar ? 26.0 : 27 + 7 * middle,
          slope,      lumbar ? 11.0 : 9.0, {0, std::cos(slope), -std::sin(slope)}};
}

// Signed distance to the body: an elliptic cylinder, narrower at its waist.
double BodyDistance(const Shape& s, const Eigen::Vector3d& x) {
  const double up = 2 * x.z() / s.height;
  const double waist = 1 - 0.1 * std::max(0.0, 1 - up * up);
  const double a = s.width / 2 * waist, b = s.depth / 2 * waist;
  const double radial = (Eigen::Vector2d(x.x() / a, (x.y() - s.depth / 2) / b).norm() - 1) * std::min(a, b);
  return -SmoothMin(-radial, s.height / 2 - std::abs(x.z()), 3.5);
}

double SpinousProcess(const Shape& s, const Eigen::Vector3d& x) {
  const double root = s.depth + 20;
  const Eigen::Vector3d from(0, root, -1);
  const Eigen::Vector3d to = from + s.spine * s.along_spine;
  const bool lumbar = s.Lumbar();
  Eigen::Vector3d flat = x;
  flat.x() *= 1.35;  // makes it higher than wide
  return Capsule(flat, from, to, lumbar ? 8.5 : 6.2, lumbar ? 8.0 : 4.8) / 1.15;
}

// Signed distance to the vertebral arch, in the local frame of Distance, for the left half.
double Arch(const Shape& s, const Eigen::Vector3d& x) {
  const double side = s.canal + 4.5, back = s.depth + 10, high = s.height / 2;
  const bool lumbar = s.Lumbar();
  const double stout = lumbar ? 1.25 : 1.0;
  const double pedicle =
      Capsule(x, {side - 1, s.depth - 5, high * 0.4}, {side, back, high * 0.3}, 4.6 * stout, 4.8 * stout);
  Eigen::Vector3d plate = x;  // makes the laminae higher than thick
  plate.z() /= 2;
  const double lamina = 1.2 * Capsule(plate, {side, back + 1, 0}, {0, s.depth + 22, -3}, 4.8, 5.2);
  const Eigen::Vector3d root(side, back + 1, high * 0.25);
  const Eigen::Vector3d end(s.transverse - 4, back + s.backward, high * 0.25 + (lumbar ? 1.0 : 6.0));
  const double transverse = Capsule(x, root, end, 5.4, lumbar ? 3.8 : 5.2);
  const double facets =
      Capsule(x, {side, back + 1, high + 6}, {side - 1, back + 5, -high - 7}, 4.6 * stout, 4.4 * stout);
  return SmoothMin(SmoothMin(pedicle, lamina, 4), SmoothMin(transverse, facets, 4), 4);
}

// Signed distance to the vertebra. Local frame: +y posterior from the body's front, z along the spine. Symmetric in x.
double Distance(const Shape& s, Eigen::Vector3d x) {
  x.x() = std::abs(x.x());
  if (x.y() < s.depth - 18) return BodyDistance(s, x);  // too far from arch and process to blend with them
  return SmoothMin(SmoothMin(BodyDistance(s, x), Arch(s, x), 4), SpinousProcess(s, x), 6);
}

// Returns the map from the local frame of Distance: the vertebra tilts with the curve of the spine.
Eigen::Isometry3d FrameOf(int number) {
  const double middle = BodyOfVertebra(number).Middle();
  Eigen::Isometry3d frame(Eigen::AngleAxisd(-std::atan(SpineSlope(middle)), Eigen::Vector3d::UnitX()));
  frame.translation() = Eigen::Vector3d(0, SpineFront(middle), middle);
  return frame;
}

}  // namespace

Field VertebralBodyField(int number) {
  const Eigen::Isometry3d to_local = FrameOf(number).inverse();
  return [shape = ShapeOf(number), to_local](const Eigen::Vector3d& x) { return BodyDistance(shape, to_local * x); };
}

Mesh Vertebra(int number, double edge_length) {
  const Shape shape = ShapeOf(number);
  const Field field = [&](const Eigen::Vector3d& x) { return Distance(shape, x); };
  const double half = shape.transverse + 12, below = shape.height / 2 + 18 + shape.spine * std::sin(shape.slope);
  constexpr double kDetail = 3, kMaxEdge = 8;  // the arch is about 9 mm thick
  const Box box{{-half, -8, -below}, {half, shape.depth + 32 + shape.spine, shape.height / 2 + 18}};
  Mesh mesh = ImplicitSurface(field, box, std::min(edge_length, kMaxEdge), kDetail);
  const Eigen::Isometry3d frame = FrameOf(number);
  mesh.vertices = (frame.linear() * mesh.vertices).colwise() + frame.translation();
  return mesh;
}

Mesh Disc(int number, double edge_length) {
  constexpr double kBulge = 0.7, kGap = 0.3, kRounded = 2, kOverlap = 1.5, kMaxEdge = 3.4, kDetail = 2,
                   kFar = 4;  // [mm]
  const VertebralBody above = BodyOfVertebra(number), below = BodyOfVertebra(number + 1);
  const double middle = (above.bottom + below.top) / 2, half_height = (above.bottom - below.top) / 2 + kOverlap;
  const double a = (above.width + below.width) / 4 + kBulge, b = (above.depth + below.depth) / 4 + kBulge;
  const Eigen::AngleAxisd upright(std::atan(SpineSlope(middle)), Eigen::Vector3d::UnitX());
  const Eigen::Vector3d front(0, SpineFront(middle), middle);
  const Eigen::Vector3d centre = front + upright.inverse() * Eigen::Vector3d(0, b - kBulge, 0);
  const Field upper = VertebralBodyField(number), lower = VertebralBodyField(number + 1);
  const Field field = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d x = upright * (point - centre);
    const double radial = (Eigen::Vector2d(x.x() / a, x.y() / b).norm() - 1) * std::min(a, b);
    const double disc = SmoothMax(radial, std::abs(x.z()) - half_height, kRounded);
    return disc > kFar ? disc : SmoothMax(disc, kGap - std::min(upper(point), lower(point)), kRounded);
  };
  const double rise = half_height + b * std::abs(SpineSlope(middle)) + 2;
  const Eigen::Vector3d reach(a + 2, b + 4, rise);
  return ImplicitSurface(field, {centre - reach, centre + reach}, std::min(edge_length, kMaxEdge), kDetail);
}

}  // namespace phrenic::anatomy
