#include "server/anatomy/rib.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/meshing/smooth.h"

namespace phrenic::anatomy {
namespace {

constexpr double kRadian = 3.14159265358979323846 / 180;

double SagittalSlope(int number) { return std::tan((31 - 0.8 * (number - 1)) * kRadian); }

double FrontalSlope(int number) { return std::tan(std::min(50.0, 7 + 0.46 * (number - 1) * (number - 1)) * kRadian); }

// Azimuth of the anterior end, measured from the front [degrees].
double EndAzimuth(int number) { return number == 1 ? 40 : 26 + 0.98 * (number - 2) * (number - 2); }

// End points of the rib's neck [mm].
struct Neck {
  Eigen::Vector3d head, tubercle;
};

Neck NeckOf(int number) {
  const VertebralBody body = BodyOfVertebra(number);
  const bool own_level = number == 1 || number >= 11;
  const double z = own_level ? body.Middle() + 3 : body.top - 4;
  const double lower = Smooth((number - 9) / 3.0);  // the heads of the last ribs are at the pedicles
  const double x = body.width / 2 + 2 + 5 * lower;
  const Eigen::Vector3d head(x, SpineFront(z) + 1.02 * body.depth + 15 * lower, z);
  const double drop = 2 - 13 * Smooth((number - 5) / 5.0);
  return {head, head + Eigen::Vector3d(number == 1 ? 22 : 17, number == 1 ? 6 : number == 12 ? 11 : 13, drop)};
}

// Returns the point of the cage at this azimuth in the rib's plane, by damped fixed-point iteration in z.
Eigen::Vector3d OnCage(int number, const Eigen::Vector3d& tubercle, double degrees) {
  constexpr int kRounds = 40;
  Eigen::Vector3d point = tubercle;
  for (int i = 0; i < kRounds; ++i) {
    const Eigen::Vector2d xy =
        CageSection(point.z(), 0).Point({std::sin(degrees * kRadian), -std::cos(degrees * kRadian)});
    const double z =
        tubercle.z() + SagittalSlope(number) * (xy.y() - tubercle.y()) - FrontalSlope(number) * (xy.x() - tubercle.x());
    point = {xy.x(), xy.y(), (point.z() + z) / 2};
  }
  return point;
}

// Returns the azimuth of the rib's angle, where it reaches the cage lateral to the tubercle [degrees].
double AngleAzimuth(int number, const Eigen::Vector3d& tubercle) {
  double degrees = 165;
  while (degrees > EndAzimuth(number) + 20 && OnCage(number, tubercle, degrees).x() < tubercle.x() + 13) --degrees;
  return degrees;
}

// Semi-axes of the cross-section of one part of a rib [mm].
struct Girth {
  double broad, thin;
};

Girth Blend(const Girth& from, const Girth& to, double t) {
  return {from.broad + t * (to.broad - from.broad), from.thin + t * (to.thin - from.thin)};
}

// The girths of a rib: head, neck, shaft and anterior end.
struct RibGirths {
  Girth head, neck, shaft, end;
};

RibGirths GirthsOf(int number) {
  if (number == 1) return {{4.6, 4.2}, {3.6, 3.2}, {8.1, 2.7}, {8.3, 3.2}};
  if (number == 2) return {{5.0, 4.6}, {4.0, 3.3}, {6.4, 2.8}, {6.8, 3.3}};
  if (number == 11) return {{5.0, 4.6}, {4.2, 3.5}, {5.8, 2.9}, {3.0, 2.0}};
  if (number == 12) return {{4.6, 4.2}, {4.0, 3.2}, {4.6, 2.6}, {2.4, 1.7}};
  return {{5.6, 5.0}, {4.4, 3.5}, {6.2, 3.1}, {6.8, 3.5}};
}

// Returns the centreline, with the bends at the tubercle made round: a tube cannot follow one that is sharper than it
// is thick. Beyond 60 mm from the head it is the smooth curve through the control points.
Curve RoundedPath(const Curve& through) {
  constexpr double kStep = 3, kRounded = 60;  // [mm]
  constexpr int kPasses = 8;
  Curve curve = SmoothCurve(through, 2 + static_cast<int>(Length(through) / kStep));
  const auto last = std::min(curve.size() - 1, static_cast<size_t>(kRounded / kStep));
  for (int pass = 0; pass < kPasses; ++pass) {
    const Curve before = curve;
    for (size_t i = 1; i < last; ++i) curve[i] = (before[i - 1] + 2 * before[i] + before[i + 1]) / 4;
  }
  return curve;
}

// A rib's length and how far its tubercle is from its head, along it [mm].
struct RibMeasures {
  double length, tubercle;
};

RibMeasures MeasuresOf(const Curve& through, const Curve& path) {
  return {Length(path), Length({through[0], through[1], through[2]})};
}

// Returns the direction of the thin axis: at the neck horizontal, further on the normal of the cage, so that the shaft
// twists with it. The first ribs lie flat, with the thin axis upwards.
Eigen::Vector3d ThinAxis(int number, double past_tubercle, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d out = OutOfCage(centre);
  const Eigen::Vector3d level = Eigen::Vector3d(out.x(), out.y(), 0).normalized();
  const double flat = std::max(0.0, 80 - 32.0 * (number - 1)) * kRadian;
  Eigen::Vector3d first = std::cos(flat) * level + std::sin(flat) * Eigen::Vector3d::UnitZ();
  if (number == 1) return first;
  return first + (out - first) * Smooth(past_tubercle / 60) * std::min(1.0, (number - 1) / 2.0);
}

TubeSection Section(int number, const RibMeasures& rib, double s, const Eigen::Vector3d& centre) {
  const RibGirths shape = GirthsOf(number);
  const double at = s * rib.length, past = at - rib.tubercle;  // along the rib [mm]
  const double end_length = number >= 11 ? 50 : 25;
  Girth girth = Blend(shape.head, shape.neck, Smooth((at - 2) / 9));
  girth = Blend(girth, shape.shaft, Smooth((past + 4) / (number == 1 ? 40 : 30)));
  girth = Blend(girth, shape.end, Smooth((at - rib.length + end_length) / end_length));
  const double tubercle = number >= 11 ? 0 : 2.4 * std::exp(-past * past / 30);
  const double shaft = Smooth(past / 25);
  return {girth.broad, girth.thin, ThinAxis(number, past, centre), 0.2 * shaft, 0.12 * shaft, tubercle};
}

}  // namespace

Eigen::Vector3d OutOfCage(const Eigen::Vector3d& point) {
  const CageSection section(point.z(), 0);
  Eigen::Vector2d q = section.DiscCoordinates(point.head<2>());
  q = q.norm() > 1e-6 ? Eigen::Vector2d(q.normalized()) : Eigen::Vector2d(0, -1);
  constexpr double kStep = 1e-3, kRise = 0.5;
  const Eigen::Vector2d turned(-q.y(), q.x());
  const Eigen::Vector2d along = section.Point((q + kStep * turned).normalized()) - section.Point(q);
  const Eigen::Vector2d up = CageSection(point.z() + kRise, 0).Point(q) - CageSection(point.z() - kRise, 0).Point(q);
  return Eigen::Vector3d(along.x(), along.y(), 0).cross(Eigen::Vector3d(up.x(), up.y(), 2 * kRise)).normalized();
}

Curve LeftRibPath(int number) {
  const Neck neck = NeckOf(number);
  Curve path = {neck.head, (neck.head + neck.tubercle) / 2, neck.tubercle};
  const double from = AngleAzimuth(number, neck.tubercle), to = EndAzimuth(number);
  const int steps = std::max(3, static_cast<int>(std::lround((from - to) / 9)));
  for (int i = 0; i <= steps; ++i) path.push_back(OnCage(number, neck.tubercle, from + (to - from) * i / steps));
  return path;
}

Mesh LeftRib(int number, double edge_length) {
  const Curve through = LeftRibPath(number), path = RoundedPath(through);
  const RibMeasures measures = MeasuresOf(through, path);
  const auto section = [&](double s, const Eigen::Vector3d& centre) { return Section(number, measures, s, centre); };
  const TubeSection end = section(1, path.back());
  return Tube({.through = path,
               .section = section,
               .last = number <= 10 ? TubeEnd::kStraight : TubeEnd::kRound,
               .radius = number <= 10 ? (end.half_broad + end.half_thin) / 2 : 0},
              edge_length);
}

RibEnd LeftRibEnd(int number) {
  const Curve through = LeftRibPath(number), path = RoundedPath(through);
  constexpr int kSamples = 2000;
  const Curve fine = SmoothCurve(path, kSamples);
  const Eigen::Vector3d along = (fine[kSamples - 1] - fine[kSamples - 2]).normalized();
  return {path.back(), along, Section(number, MeasuresOf(through, path), 1, path.back())};
}

}  // namespace phrenic::anatomy
