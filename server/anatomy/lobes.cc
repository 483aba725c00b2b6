#include "server/anatomy/lobes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/anatomy/lung.h"
#include "server/anatomy/meshing/implicit_surface.h"

namespace phrenic::anatomy {
namespace {

constexpr double kHalfGap = 0.6;         // between a lobe and the middle of its fissure [mm]
constexpr double kRoundedEdge = 2.5;     // of a lobe, so that the fissure is a groove [mm]
constexpr double kOutsideLung = 0.2;     // how far a fissure's sheet ends outside of the lung [mm]
constexpr double kHighestFissure = 345;  // z of the fissures [mm]

// Returns z of the oblique fissure [mm]; that of the left lung begins half a vertebra higher.
double ObliqueAt(double x, double y, bool left) {
  return (left ? 272 : 268) + 0.874 * y - 0.176 * std::abs(x) + 4 * std::sin(std::numbers::pi * (y - 12) / 100);
}

// Returns z of the horizontal fissure [mm].
double HorizontalAt(double x, double y) { return 267 - 0.06 * (std::abs(x) - 40) - 6e-4 * (y + 40) * (y + 40); }

// Return how far a point is above a fissure [mm].
double AboveOblique(const Eigen::Vector3d& x, bool left) {
  constexpr double kSteep = 1.35;  // length of the gradient of z - ObliqueAt
  return (x.z() - ObliqueAt(x.x(), x.y(), left)) / kSteep;
}
double AboveHorizontal(const Eigen::Vector3d& x) { return x.z() - HorizontalAt(x.x(), x.y()); }

double LobeField(Lobe lobe, bool left, const Eigen::Vector3d& x) {
  const double oblique = AboveOblique(x, left);
  double beyond = kHalfGap + (lobe == Lobe::kLower ? oblique : -oblique);
  if (!left && lobe == Lobe::kUpper) beyond = SmoothMax(beyond, kHalfGap - AboveHorizontal(x), kRoundedEdge);
  if (lobe == Lobe::kMiddle) beyond = SmoothMax(beyond, kHalfGap + AboveHorizontal(x), kRoundedEdge);
  constexpr double kFar = 12;
  return beyond > kFar ? beyond : SmoothMax(beyond, LungField(x, left), kRoundedEdge);
}

Box LungBox(bool left, double low, double high) {
  return {{left ? 0.0 : -135.0, -105, low}, {left ? 135.0 : 0.0, 110, high}};
}

}  // namespace

Mesh LungLobe(Lobe lobe, bool left, double edge_length) {
  constexpr double kMaxEdge = 10, kDetail = 3.5;
  const Field field = [lobe, left](const Eigen::Vector3d& x) { return LobeField(lobe, left, x); };
  const Box box = lobe == Lobe::kUpper    ? LungBox(left, left ? 150 : 230, 405)
                  : lobe == Lobe::kMiddle ? LungBox(left, 150, 275)
                                          : LungBox(left, 95, kHighestFissure + 10);
  return ImplicitSurface(field, box, std::min(edge_length, kMaxEdge), kDetail);
}

// The sheet is polygonised in the coordinates (x, y, s), s the height above the fissure, stretched so that the sheet is
// as thick as its triangles are long.
Mesh LungFissure(Fissure fissure, bool left, double edge_length) {
  constexpr double kMaxEdge = 6, kDetail = 4, kThick = 1.2, kRim = 2;
  const double edge = std::min(edge_length, kMaxEdge), half = std::max(kDetail, 0.7 * edge);
  const bool oblique = fissure == Fissure::kOblique;
  const double steep = oblique ? 1.35 : 1;  // z per thickness
  const auto place = [&](const Eigen::Vector3d& p) {
    const double z = oblique ? ObliqueAt(p.x(), p.y(), left) : HorizontalAt(p.x(), p.y());
    return Eigen::Vector3d(p.x(), p.y(), z + p.z() * steep * kThick / 2 / half);
  };
  const Field field = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d x = place(p);
    double outside = LungField(x, left) - kOutsideLung;
    if (!oblique) outside = SmoothMax(outside, 1 - AboveOblique(x, left), kRim);
    return SmoothMax(outside, std::abs(p.z()) - half, kRim);
  };
  const double reach = half + 2 * kDetail;
  Mesh mesh = ImplicitSurface(field, LungBox(left, -reach, reach), edge, kDetail);
  for (auto vertex : mesh.vertices.colwise()) vertex = place(vertex);
  return mesh;
}

}  // namespace phrenic::anatomy
