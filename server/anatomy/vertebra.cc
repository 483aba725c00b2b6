#include "server/anatomy/vertebra.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/meshing/implicit_surface.h"
#include "server/anatomy/meshing/smooth.h"

namespace phrenic::anatomy {
namespace {

// The left joint between the articular processes of two vertebrae, in the local frame of one of them: the superior
// process of the lower vertebra is on the negative side of the plane, the inferior one of the upper vertebra on the
// other.
struct FacetJoint {
  Eigen::Vector3d at, normal;
};

struct Shape {
  double width, depth, height;  // of the body
  double transverse, backward;  // extent of the transverse processes, lateral and posterior
  double spine, slope;          // length of the spinous process and its slope below the horizontal [rad]
  double canal;                 // half width of the vertebral canal
  Eigen::Vector3d along_spine;  // unit direction of the spinous process
  double lamina;                // half height of the laminae
  FacetJoint above, below;      // with the next vertebrae

  bool Lumbar() const { return canal > 10; }
};

constexpr double kFacetGap = 1;  // of a joint, for its cartilage [mm]

// Returns the map from the local frame of Distance: the vertebra tilts with the curve of the spine.
Eigen::Isometry3d FrameOf(int number) {
  const double middle = BodyOfVertebra(number).Middle();
  Eigen::Isometry3d frame(Eigen::AngleAxisd(-std::atan(SpineSlope(middle)), Eigen::Vector3d::UnitX()));
  frame.translation() = Eigen::Vector3d(0, SpineFront(middle), middle);
  return frame;
}

// Returns the joint below vertebra 0 to 15, in the common frame; those at the ends of the column have no partner.
// Thoracic facets face backwards and a little up and outwards, lumbar ones inwards and backwards.
FacetJoint JointBelow(int number) {
  const VertebralBody upper = BodyOfVertebra(std::max(1, number));
  const VertebralBody lower = BodyOfVertebra(std::min(kVertebrae, number + 1));
  const double z = number == 0            ? upper.top + 2
                   : number == kVertebrae ? lower.bottom - 4
                                          : (upper.bottom + lower.top) / 2;
  const bool lumbar = number >= 12;
  const Eigen::Vector3d behind(lumbar ? 15 : 12.5, (upper.depth + lower.depth) / 2 + (lumbar ? 16 : 14), 0);
  const Eigen::AngleAxisd tilt(-std::atan(SpineSlope(z)), Eigen::Vector3d::UnitX());
  const Eigen::Vector3d normal = lumbar ? Eigen::Vector3d(-0.8, 0.58, 0.1) : Eigen::Vector3d(0.2, 0.9, 0.38);
  return {Eigen::Vector3d(0, SpineFront(z), z) + tilt * behind, tilt * normal.normalized()};
}

FacetJoint InFrame(const Eigen::Isometry3d& to_local, const FacetJoint& joint) {
  return {to_local * joint.at, to_local.linear() * joint.normal};
}

// Half the height of the laminae, which leave room for those of the next vertebrae [mm].
double LaminaOf(int number) {
  const double spacing = number == 1 ? BodyOfVertebra(1).Middle() - BodyOfVertebra(2).Middle()
                                     : BodyOfVertebra(number - 1).Middle() - BodyOfVertebra(number).Middle();
  return std::min(9.6, 0.4 * spacing);
}

Shape ShapeOf(int number) {
  const Eigen::Isometry3d to_local = FrameOf(number).inverse();
  const VertebralBody body = BodyOfVertebra(number);
  const bool lumbar = number > 12;
  const double middle = std::exp(-(number - 6.5) * (number - 6.5) / 10.0);  // 1 at T6 and T7, 0 at T1 and T12
  const double transverse = lumbar ? 36 + (number - 13) * 2.0 : 36 - 13 * Smooth((number - 8.5) / 4);
  const double slope = lumbar ? 0.12 : 0.35 + 0.75 * middle;
  return {body.width,
          body.depth,
          body.top - body.bottom,
          transverse,
          lumbar ? 4.0 : 14.0,
          lumbar ? 26.0 : 27 + 7 * middle,
          slope,
          lumbar ? 11.0 : 9.0,
          {0, std::cos(slope), -std::sin(slope)},
          LaminaOf(number),
          InFrame(to_local, JointBelow(number - 1)),
          InFrame(to_local, JointBelow(number))};
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

// How far a point is beyond the faces of the joints, near them: the processes of the next vertebrae are there.
double BeyondFacets(const Shape& s, const Eigen::Vector3d& x) {
  constexpr double kOfFacet = 11, kRoundedFacet = 3;  // where the other process ends, around the joint [mm]
  const auto beyond = [&x](const FacetJoint& joint, double side) {
    const double from_face = kFacetGap / 2 + side * joint.normal.dot(x - joint.at);
    return SmoothMin(from_face, kOfFacet - (x - joint.at).norm(), kRoundedFacet);
  };
  return std::max(beyond(s.above, 1), beyond(s.below, -1));
}

// Signed distance to the superior and the inferior articular process of the left half, which end in the flat faces of
// their joints.
double ArticularProcesses(const Shape& s, const Eigen::Vector3d& x) {
  constexpr double kInside = 2.2;  // of the middle of a process from its face [mm]
  const double side = s.canal + 4.5, back = s.depth + 10, thick = s.Lumbar() ? 5.6 : 4.7;
  const Eigen::Vector3d superior = s.above.at - kInside * s.above.normal,
                        inferior = s.below.at + kInside * s.below.normal;
  const Eigen::Vector3d root(side, back + 1, s.height * 0.15), lamina(side - 2, back + 5, -s.height * 0.15);
  return SmoothMin(Capsule(x, root, superior, 5, thick), Capsule(x, lamina, inferior, 4.8, thick), 4);
}

// Signed distance to the vertebral arch, in the local frame of Distance, for the left half.
double Arch(const Shape& s, const Eigen::Vector3d& x) {
  const double side = s.canal + 4.5, back = s.depth + 10, high = s.height / 2;
  const bool lumbar = s.Lumbar();
  const double stout = lumbar ? 1.25 : 1.0;
  const double pedicle =
      Capsule(x, {side - 1, s.depth - 5, high * 0.4}, {side, back, high * 0.3}, 4.6 * stout, 4.8 * stout);
  Eigen::Vector3d plate = x;  // makes the laminae higher than thick
  plate.z() *= 4.8 / s.lamina;
  const double lamina = 1.2 * Capsule(plate, {side, back + 1, 0}, {0, s.depth + 22, -3}, 4.8, 5.2);
  const Eigen::Vector3d root(side, back + 1, high * 0.25);
  const Eigen::Vector3d end(s.transverse - 4, back + s.backward, high * 0.25 + (lumbar ? 1.0 : 6.0));
  const double transverse = Capsule(x, root, end, 5.4, lumbar ? 3.8 : 5.2);
  return SmoothMin(SmoothMin(pedicle, lamina, 4), SmoothMin(transverse, ArticularProcesses(s, x), 4), 4);
}

// Signed distance to the vertebra. Local frame: +y posterior from the body's front, z along the spine. Symmetric in x.
double Distance(const Shape& s, Eigen::Vector3d x) {
  x.x() = std::abs(x.x());
  if (x.y() < s.depth - 18) return BodyDistance(s, x);  // too far from arch and process to blend with them
  const double arch = SmoothMin(Arch(s, x), SpinousProcess(s, x), 6);
  return SmoothMin(BodyDistance(s, x), SmoothMax(arch, BeyondFacets(s, x), 1.2), 4);
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
