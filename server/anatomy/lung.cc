#include "server/anatomy/lung.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"
#include "server/anatomy/meshing/implicit_surface.h"

namespace phrenic::anatomy {
namespace {

constexpr double kPleura = 5;       // distance of the lung from the ribs' centrelines [mm]
constexpr double kAboveDome = 3.5;  // distance of the base from the diaphragm's middle surface [mm]
constexpr double kTop = 393;        // z of the apex [mm]

// The fields below are approximate signed distances [mm], negative where lung may be.

// Inside the chest wall, which narrows to the pleural cupola.
double InsideCage(const Eigen::Vector3d& x) {
  const double pleura = kPleura + 4 * std::clamp((x.z() - 315) / 40, 0.0, 1.0);  // wider where the first ribs lie flat
  thread_local LastCageSection last;
  const Eigen::Vector2d q = last.At(std::min(x.z(), kTop + 2), pleura).DiscCoordinates(x.head<2>());
  const double narrowing = std::clamp((kTop - x.z()) / 120, 0.3, 1.0);
  return SmoothMax((q.norm() - 1) * 80 * narrowing, x.z() - kTop, 14);
}

// Above the diaphragm: the height difference to the dome, divided by the gradient's magnitude.
double AboveDiaphragm(const Eigen::Vector3d& x) {
  constexpr double kStep = 0.01, kRadius = 105, kRecess = 0.93;
  if (x.z() > 260) return 230 - x.z();
  const double z = std::clamp(x.z(), 100.0, 230.0);
  thread_local LastCageSection last;
  const Eigen::Vector2d q = last.At(z, kDiaphragmInset).DiscCoordinates(x.head<2>());
  const double r = std::clamp(q.norm(), kStep, 1 - 2 * kStep);
  const Eigen::Vector2d unit = q / std::max(q.norm(), 1e-9);
  const double slope = (DomeHeight((r - kStep) * unit) - DomeHeight((r + kStep) * unit)) / (2 * kStep * kRadius);
  const double above = kAboveDome + (DomeHeight(q) - x.z()) / std::hypot(1.0, slope);
  return SmoothMax(above, DomeHeight(kRecess * unit) - x.z(), 6);  // leaves the costophrenic recess empty
}

// Outside the heart, which reaches the chest wall on the left (cardiac notch of the left lung).
double BesideHeart(const Eigen::Vector3d& x, bool left) {
  const Eigen::Vector3d centre = left ? Eigen::Vector3d(20, -42, 238) : Eigen::Vector3d(8, -26, 248);
  const Eigen::Vector3d reach = left ? Eigen::Vector3d(46, 50, 56) : Eigen::Vector3d(40, 28, 54);
  return (1 - (x - centre).cwiseQuotient(reach).norm()) * 46;
}

// Outside heart, great vessels and spine.
double OutsideMediastinum(const Eigen::Vector3d& x, bool left) {
  const double in_front = std::clamp((10 - x.y()) / 60, 0.0, 1.0);
  const double wall = 19 - 11 * in_front - (left ? x.x() : -x.x());
  const double spine = 25 - std::hypot(x.x(), x.y() - SpineFront(x.z()) - 16);
  return SmoothMax(SmoothMax(wall, BesideHeart(x, left), 14), spine, 10);
}

Mesh Lung(bool left, double edge_length) {
  const Field field = [left](const Eigen::Vector3d& x) { return LungField(x, left); };
  constexpr double kDetail = 5;
  const Box box{{left ? 0.0 : -135.0, -105, 95}, {left ? 135.0 : 0.0, 110, 405}};
  return ImplicitSurface(field, box, edge_length, kDetail);
}

}  // namespace

double LungField(const Eigen::Vector3d& x, bool left) {
  return SmoothMax(SmoothMax(InsideCage(x), AboveDiaphragm(x), 8), OutsideMediastinum(x, left), 16);
}

Mesh LeftLung(double edge_length) { return Lung(true, edge_length); }

Mesh RightLung(double edge_length) { return Lung(false, edge_length); }

}  // namespace phrenic::anatomy
