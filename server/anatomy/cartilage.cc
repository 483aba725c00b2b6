#include "server/anatomy/cartilage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/meshing/smooth.h"
#include "server/anatomy/rib.h"
#include "server/anatomy/sternum.h"

namespace phrenic::anatomy {
namespace {

constexpr int kTrueRibs = 7;
constexpr double kStraight = 5;  // length over which a cartilage keeps the direction of its rib [mm]

// Semi-axes at the medial end [mm].
struct MedialEnd {
  double broad, thin;
};

MedialEnd MedialEndOf(int number) {
  if (number == 1) return {6.2, 3.8};
  return number <= kTrueRibs ? MedialEnd{5.2, 4.0} : MedialEnd{4.2, 2.4};
}

// Where cartilages 1 to 7 meet the sternum.
Eigen::Vector3d SternalEnd(int number) {
  const double z = SternalNotch(number);
  return {SternumHalfWidth(z) + 1.5, SternumLine(z) + 1, z};
}

double AzimuthOf(const Eigen::Vector3d& point) {
  const Eigen::Vector2d q = CageSection(point.z(), 0).DiscCoordinates(point.head<2>());
  return std::atan2(q.x(), -q.y());
}

// The cubic with the values and slopes of its ends at t = 0 and 1.
double Hermite(double from, double from_slope, double to, double to_slope, double t) {
  const double u = 1 - t;
  return from * (1 + 2 * t) * u * u + from_slope * t * u * u + to * t * t * (3 - 2 * t) - to_slope * t * t * u;
}

struct PathEnd {
  Eigen::Vector3d at;
  double slope;  // rise per horizontal distance, forwards
};

// Appends the points between two ends: on the cage, or on the way from it to the sternum.
void AppendBetween(const PathEnd& from, const PathEnd& to, bool leaves_cage, Curve& path) {
  constexpr int kSteps = 7;
  const double from_azimuth = AzimuthOf(from.at), to_azimuth = AzimuthOf(to.at);
  const double run = (to.at - from.at).head<2>().norm();
  for (int i = 1; i < kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    const double azimuth = from_azimuth + (to_azimuth - from_azimuth) * t;
    const double z = Hermite(from.at.z(), run * from.slope, to.at.z(), run * to.slope, t);
    const Eigen::Vector2d on_cage = CageSection(z, 0).Point({std::sin(azimuth), -std::cos(azimuth)});
    const Eigen::Vector2d straight = (from.at + (to.at - from.at) * t).head<2>();
    const Eigen::Vector2d xy = on_cage + (leaves_cage ? t * t : 0.0) * (straight - on_cage);
    path.emplace_back(xy.x(), xy.y(), z);
  }
}

// A true cartilage rises to the sternum; the lower ones the more steeply.
Curve TruePath(int number, Curve path, const PathEnd& from) {
  const Eigen::Vector3d end = SternalEnd(number);
  const double mean = (end.z() - from.at.z()) / (end - from.at).head<2>().norm();
  AppendBetween(from, {end, number >= 4 ? 1.25 * mean : 0.6 * mean}, true, path);
  path.push_back(end);
  return path;
}

// A false cartilage merges into the lower edge of the one above and follows it.
Curve FalsePath(int number, Curve path, const PathEnd& from) {
  constexpr int kSamples = 101;
  const Curve above = SmoothCurve(LeftCartilagePath(number - 1), kSamples);
  const double step = Length(above) / (kSamples - 1);
  const int first = number == kTrueRibs + 1 ? 40 : 36;
  const auto beside = [&](double further, double below) {
    const int at = std::min(kSamples - 2, first + static_cast<int>(std::lround(further / step)));
    const Eigen::Vector3d along = (above[at + 1] - above[at - 1]).normalized();
    return Eigen::Vector3d(above[at] + below * OutOfCage(above[at]).cross(along).normalized());
  };
  const Eigen::Vector3d join = beside(0, 9), next = beside(9, 6.8), rise = beside(4.5, 9) - beside(-4.5, 9);
  AppendBetween(from, {join, rise.z() / rise.head<2>().norm()}, false, path);
  path.insert(path.end(), {join, next, beside(18, 3.5), beside(27, 0.2)});
  return path;
}

}  // namespace

Curve LeftCartilagePath(int number) {
  const RibEnd rib = LeftRibEnd(number);
  const Eigen::Vector3d straight = rib.centre + kStraight * rib.along;
  const PathEnd from{straight, std::max(-0.8, rib.along.z() / rib.along.head<2>().norm())};
  return number <= kTrueRibs ? TruePath(number, {rib.centre, straight}, from)
                             : FalsePath(number, {rib.centre, straight}, from);
}

Mesh LeftCartilage(int number, double edge_length) {
  const RibEnd rib = LeftRibEnd(number);
  const MedialEnd end = MedialEndOf(number);
  const auto section = [&](double s, const Eigen::Vector3d& centre) {
    TubeSection at = rib.section;
    const double t = Smooth(1.1 * s - 0.1);
    const double keep = 1 - (number == 1 ? 0.6 : 1) * Smooth(s / 0.6);  // the first one stays oblique
    at.half_broad += t * (end.broad - at.half_broad);
    at.half_thin += t * (end.thin - at.half_thin);
    at.thin = keep * rib.section.thin.normalized() + (1 - keep) * OutOfCage(centre);
    at.taper *= keep;
    return at;
  };
  return Tube({.through = LeftCartilagePath(number),
               .section = section,
               .first = TubeEnd::kStraight,
               .start = rib.along,
               .radius = (rib.section.half_broad + rib.section.half_thin) / 2},
              edge_length);
}

}  // namespace phrenic::anatomy
