#include "server/anatomy/vertebra.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/implicit_surface.h"

namespace phrenic::anatomy {
namespace {

struct Shape {
  double width, depth, height;  // of the body
  double transverse, backward;  // reach of the transverse processes sideways and backwards
  double spine, slope;          // length of the spinous process and its slope below the horizontal [rad]
  double canal;                 // half width of the vertebral canal
};

Shape ShapeOf(int number) {
  const VertebralBody body = BodyOfVertebra(number);
  const bool lumbar = number > 12;
  const double middle = std::exp(-(number - 6.5) * (number - 6.5) / 10.0);  // 1 at T6 and T7, 0 at T1 and T12
  const double transverse = lumbar ? 36 + (number - 13) * 2.0 : 35 - 0.11 * (number - 1) * (number - 1);
  return {body.width,
          body.depth,
          body.top - body.bottom,
          transverse,
          lumbar ? 4.0 : 12.0,
          lumbar ? 26.0 : 27 + 7 * middle,
          lumbar ? 0.12 : 0.35 + 0.75 * middle,
          lumbar ? 11.0 : 9.0};
}

// The body: an elliptic cylinder, narrower at its waist, hollowed a little at the canal.
double BodyDistance(const Shape& s, const Eigen::Vector3d& x) {
  const double up = 2 * x.z() / s.height;
  const double waist = 1 - 0.1 * std::max(0.0, 1 - up * up);
  const double a = s.width / 2 * waist, b = s.depth / 2 * waist;
  const double radial = (std::hypot(x.x() / a, (x.y() - s.depth / 2) / b) - 1) * std::min(a, b);
  return -SmoothMin(-radial, s.height / 2 - std::abs(x.z()), 3.5);
}

double SpinousProcess(const Shape& s, const Eigen::Vector3d& x) {
  const double root = s.depth + 17;
  const Eigen::Vector3d from(0, root, -1);
  const Eigen::Vector3d to = from + s.spine * Eigen::Vector3d(0, std::cos(s.slope), -std::sin(s.slope));
  const bool lumbar = s.canal > 10;
  Eigen::Vector3d flat = x;
  flat.x() *= 1.35;  // higher than wide
  return Capsule(flat, from, to, lumbar ? 7.5 : 5.6, lumbar ? 7.0 : 4.4) / 1.15;
}

// Local frame: y backwards from the body's front, z along the spine, x mirrored.
double Distance(const Shape& s, Eigen::Vector3d x) {
  x.x() = std::abs(x.x());
  const double side = s.canal + 3, back = s.depth + 11, high = s.height / 2;
  const bool lumbar = s.canal > 10;
  const double pedicle =
      Capsule(x, {side - 1, s.depth - 5, high * 0.35}, {side, back, high * 0.3}, lumbar ? 6 : 4.6, lumbar ? 6 : 4.6);
  const double lamina = Capsule(x, {side, back, 1}, {0, s.depth + 18, -3}, 5.0, 4.8);
  const double transverse =
      Capsule(x, {side, back, high * 0.25}, {s.transverse - 3, back + s.backward, high * 0.25 + 2}, lumbar ? 5.0 : 5.4,
              lumbar ? 3.8 : 4.6);
  const double facets = Capsule(x, {side, back + 2, high + 4}, {side, back + 5, -high - 4}, 4.2, 4.2);
  double distance = SmoothMin(BodyDistance(s, x), pedicle, 4);
  distance = SmoothMin(distance, lamina, 4);
  distance = SmoothMin(distance, transverse, 4);
  distance = SmoothMin(distance, facets, 3);
  return SmoothMin(distance, SpinousProcess(s, x), 5);
}

}  // namespace

Mesh Vertebra(int number, double edge_length) {
  const Shape shape = ShapeOf(number);
  const VertebralBody body = BodyOfVertebra(number);
  const Field field = [&](const Eigen::Vector3d& x) { return Distance(shape, x); };
  const double half = shape.transverse + 12, below = shape.height / 2 + 14 + shape.spine * std::sin(shape.slope);
  const Box box{{-half, -8, -below}, {half, shape.depth + 32 + shape.spine, shape.height / 2 + 14}};
  Mesh mesh = ImplicitSurface(field, box, edge_length);
  const double tilt = std::atan(SpineSlope(body.Middle()));
  const Eigen::AngleAxisd turn(-tilt, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d front(0, SpineFront(body.Middle()), body.Middle());
  mesh.vertices = (turn.toRotationMatrix() * mesh.vertices).colwise() + front;
  return mesh;
}

}  // namespace phrenic::anatomy
