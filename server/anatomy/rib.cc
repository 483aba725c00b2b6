#include "server/anatomy/rib.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/smooth.h"

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

TubeSection Section(int number, double s, const Eigen::Vector3d& centre) {
  // Thick head, round neck, flat and high shaft; ribs 11 and 12 end pointed, the others slightly broader.
  const double head = 1 - Smooth(s / 0.06);
  const double shaft = number == 1 ? Smooth((s - 0.3) / 0.25) : Smooth((s - 0.08) / 0.2);
  const double tip = Smooth((s - 0.75) / 0.25);
  const bool floating = number >= 11;
  const double height = number == 1 ? 8.0 : number == 12 ? 5.0 : 6.6;  // half height of the shaft
  const double broad = 4.4 + 1.4 * head + (height - 4.4) * shaft + (floating ? -2.5 : 0.6) * tip;
  const double thin = 3.9 + 1.2 * head - (number == 1 ? 0.9 : 0.3) * shaft + (floating ? -0.9 : 0.3) * tip;
  // The upper ribs lie flat, with the thin axis upwards.
  const double flat = std::max(0.0, 80 - 32.0 * (number - 1)) * kRadian;
  const Eigen::Vector3d out = OutOfCage(centre);
  return {broad, thin, std::cos(flat) * out + std::sin(flat) * Eigen::Vector3d::UnitZ()};
}

}  // namespace

Eigen::Vector3d OutOfCage(const Eigen::Vector3d& point) {
  const CageSection section(point.z(), 0);
  Eigen::Vector2d q = section.DiscCoordinates(point.head<2>());
  q = q.norm() > 1e-6 ? Eigen::Vector2d(q.normalized()) : Eigen::Vector2d(0, -1);
  constexpr double kStep = 1e-3;
  const Eigen::Vector2d turned(-q.y(), q.x());
  const Eigen::Vector2d along = section.Point((q + kStep * turned).normalized()) - section.Point(q);
  return Eigen::Vector3d(along.y(), -along.x(), 0).normalized();
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
  const auto section = [number](double s, const Eigen::Vector3d& centre) { return Section(number, s, centre); };
  return Tube(LeftRibPath(number), section, edge_length);
}

}  // namespace phrenic::anatomy
