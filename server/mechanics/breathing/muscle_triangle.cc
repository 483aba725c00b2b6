#include "server/mechanics/breathing/muscle_triangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

constexpr double kConstant = 1e-6;  // a height is constant if its gradient is smaller [1/m]
constexpr double kFacing = 0.9;     // cosine of the angle within which a triangle faces an axis
// Of the active tension at force-length 1: its steepest slope in a breath (at a stretch of 0.7), and the tension over
// the stretch at that.
constexpr double kActiveSlope = 2, kActiveTransverse = 0.6;

// One deformed direction.
struct Deformed {
  Eigen::Vector3d at;  // F d
  double stretch;      // regularised as in the kernel
};

Deformed DeformedBy(const MuscleTriangle& triangle, const Eigen::Vector3d& slopes, const ConstPoints& x) {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) at += slopes[i] * x.col(triangle.vertices[i]);
  return {at, std::sqrt(at.squaredNorm() + kLeastSquaredStretch)};
}

// Adds block slopes_i slopes_j for each pair of vertices.
void AddPairs(const MuscleTriangle& triangle, const Eigen::Vector3d& slopes, const Eigen::Matrix3d& block,
              StiffnessSink& sink) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) sink.Add(triangle.vertices[i], triangle.vertices[j], slopes[i] * slopes[j] * block);
  }
}

// Adds the stiffness of one direction: `slope` along it, `tension`/stretch across it.
void AddDirection(const MuscleTriangle& triangle, const Eigen::Vector3d& slopes, const Deformed& direction,
                  double slope, double tension, StiffnessSink& sink) {
  const Eigen::Vector3d unit = direction.at / direction.stretch;
  const Eigen::Matrix3d lengthwise = unit * unit.transpose();
  const double transverse = std::max(0.0, tension) / direction.stretch;
  AddPairs(
      triangle, slopes,
      triangle.area * (std::max(0.0, slope) * lengthwise + transverse * (Eigen::Matrix3d::Identity() - lengthwise)),
      sink);
}

// The shear energy is 1/2 A G s^2, s = F f . F c. Its second derivative is G (ds ds^T + s d2s), d2s with the sign of s
// or against it for the sum and the difference of the two slopes.
void AddShear(const MuscleTriangle& triangle, double shear, const Deformed& f, const Deformed& c, StiffnessSink& sink) {
  const double s = f.at.dot(c.at), weight = triangle.area * shear;
  const Eigen::Vector3d mixed =
      s > 0 ? Eigen::Vector3d(triangle.along + triangle.across) : Eigen::Vector3d(triangle.along - triangle.across);
  Eigen::Matrix3d ds;  // of each vertex
  for (int i = 0; i < 3; ++i) ds.col(i) = triangle.along[i] * c.at + triangle.across[i] * f.at;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Eigen::Matrix3d block = weight * ds.col(i) * ds.col(j).transpose();
      block.diagonal().array() += weight * std::abs(s) / 2 * mixed[i] * mixed[j];
      sink.Add(triangle.vertices[i], triangle.vertices[j], block);
    }
  }
}

TensionAt Along(const MuscleTriangle& triangle, const MuscleLaw& law, double active, double stretch) {
  if (triangle.tissue == Tissue::kMuscle) return MuscleAt(law, triangle.resting_along, active, stretch);
  return LinearAt(law.LinearOf(triangle.tissue), triangle.resting_along, stretch);
}

TensionAt Across(const MuscleTriangle& triangle, const MuscleLaw& law, double stretch) {
  return LinearAt(law.LinearOf(triangle.tissue), triangle.resting_across, stretch);
}

// Returns the unit vector in a plane that is nearest to an axis.
Eigen::Vector3d AlongAxis(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d axis = Eigen::Vector3d::Unit(std::abs(normal.x()) < kFacing ? 0 : 1);
  return (axis - axis.dot(normal) * normal).normalized();
}

}  // namespace

MuscleTriangle MakeMuscleTriangle(const ConstPoints& rest, const Eigen::Vector3i& vertices,
                                  const Eigen::Vector3d& height) {
  MuscleTriangle triangle;
  triangle.vertices = vertices;
  const auto side = [&](int i) {  // opposite vertex i, in the sense of the winding
    return Eigen::Vector3d(rest.col(vertices[(i + 2) % 3]) - rest.col(vertices[(i + 1) % 3]));
  };
  const Eigen::Vector3d twice = side(0).cross(side(1));
  if (twice.norm() == 0) return triangle;
  const Eigen::Vector3d normal = twice.normalized();
  triangle.area = twice.norm() / 2;
  Eigen::Matrix3d gradients;
  for (int i = 0; i < 3; ++i) gradients.col(i) = normal.cross(side(i)) / twice.norm();
  const Eigen::Vector3d uphill = gradients * height;
  triangle.f = uphill.norm() < kConstant ? AlongAxis(normal) : uphill.normalized();
  triangle.c = normal.cross(triangle.f);
  triangle.along = gradients.transpose() * triangle.f;
  triangle.across = gradients.transpose() * triangle.c;
  return triangle;
}

Stretches StretchesOf(const MuscleTriangle& triangle, const ConstPoints& x) {
  return {DeformedBy(triangle, triangle.along, x).stretch, DeformedBy(triangle, triangle.across, x).stretch};
}

double EnergyOf(const MuscleTriangle& triangle, const MuscleLaw& law, double active, const ConstPoints& x) {
  const Deformed f = DeformedBy(triangle, triangle.along, x), c = DeformedBy(triangle, triangle.across, x);
  const double shear = f.at.dot(c.at);
  return triangle.area * (Along(triangle, law, active, f.stretch).energy + Across(triangle, law, c.stretch).energy +
                          law.ShearOf(triangle.tissue) / 2 * shear * shear);
}

void AddStiffnessOf(const MuscleTriangle& triangle, const MuscleLaw& law, double active, const ConstPoints& x,
                    StiffnessSink& sink) {
  const Deformed f = DeformedBy(triangle, triangle.along, x), c = DeformedBy(triangle, triangle.across, x);
  const TensionAt along = Along(triangle, law, active, f.stretch), across = Across(triangle, law, c.stretch);
  AddDirection(triangle, triangle.along, f, along.slope, along.tension, sink);
  AddDirection(triangle, triangle.across, c, across.slope, across.tension, sink);
  AddShear(triangle, law.ShearOf(triangle.tissue), f, c, sink);
}

void AddActiveStiffnessOf(const MuscleTriangle& triangle, double active, const ConstPoints& x, StiffnessSink& sink) {
  if (triangle.tissue != Tissue::kMuscle) return;
  const Deformed f = DeformedBy(triangle, triangle.along, x);
  AddDirection(triangle, triangle.along, f, kActiveSlope * active, kActiveTransverse * active * f.stretch, sink);
}

void AddViscosityOf(const MuscleTriangle& triangle, const MuscleLaw& law, const ConstPoints& x, StiffnessSink& blocks) {
  const double weight = triangle.area * law.ViscosityOf(triangle.tissue);
  if (weight == 0) return;
  for (const Eigen::Vector3d* slopes : {&triangle.along, &triangle.across}) {
    const Deformed direction = DeformedBy(triangle, *slopes, x);
    const Eigen::Vector3d unit = direction.at / direction.stretch;
    AddPairs(triangle, *slopes, weight * unit * unit.transpose(), blocks);
  }
}

}  // namespace phrenic
