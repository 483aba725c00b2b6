#include "server/anatomy/sternum.h"

#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/smooth.h"
#include "server/anatomy/tube.h"

namespace phrenic::anatomy {
namespace {

constexpr double kAngle = 317;    // sternal angle, where manubrium and body meet [mm]
constexpr double kBodyEnd = 214;  // z where the xiphoid begins [mm]
constexpr double kNotch = 358;    // z of the jugular notch [mm]
constexpr double kXiphoidTip = 186;

Mesh Plate(double bottom, double top, double thickness, double edge_length) {
  Curve line;
  constexpr int kPoints = 9;
  for (int i = 0; i < kPoints; ++i) {
    const double z = bottom + (top - bottom) * i / (kPoints - 1);
    line.emplace_back(0, SternumLine(z), z);
  }
  const auto section = [&](double, const Eigen::Vector3d& centre) {
    return TubeSection{SternumHalfWidth(centre.z()), thickness / 2, Eigen::Vector3d(0, -1, 0)};
  };
  return Tube(line, section, edge_length);
}

}  // namespace

double SternumHalfWidth(double z) {
  if (z > kAngle) {  // manubrium: 14 mm at the angle, 28 mm below the clavicular notches, narrower at the top
    const double up = std::min(1.0, (z - kAngle) / (kNotch - kAngle));
    return 13 + 17 * Smooth(up / 0.75) - 8 * Smooth((up - 0.78) / 0.22);
  }
  if (z > kBodyEnd) {  // body: widest a third from its lower end
    const double up = (z - kBodyEnd) / (kAngle - kBodyEnd);
    return 10 + 3 * Smooth(up / 0.1) + 40 * up * (1 - up) * (1 - up) + 0.5 * up;
  }
  const double down = std::min(1.0, (kBodyEnd - z) / (kBodyEnd - kXiphoidTip));
  return 9.5 - 4 * down;
}

double SternalNotch(int number) { return 342 - 25.5 * (number - 1) + 0.85 * (number - 1) * (number - 1); }

Mesh Manubrium(double edge_length) { return Plate(kAngle + 6, kNotch - 5, 11, edge_length); }

Mesh SternumBody(double edge_length) { return Plate(kBodyEnd + 5, kAngle - 5, 10, edge_length); }

Mesh Xiphoid(double edge_length) { return Plate(kXiphoidTip + 3, kBodyEnd - 3, 5.5, edge_length); }

}  // namespace phrenic::anatomy
