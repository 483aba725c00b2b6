// A person made of another law than the fit's: lungs of another shape, moved by smooth functions of the place, with
// noise.
#ifndef PHRENIC_TESTS_FIT_SYNTHETIC_PERSON_H_
#define PHRENIC_TESTS_FIT_SYNTHETIC_PERSON_H_

#include <cmath>
#include <random>

#include "server/fit/landmarks.h"
#include "tests/fit/template_lungs.h"

namespace phrenic::fit {

// Returns points inside a lung, about `count`, in the template's frame. Deterministic.
inline Points PointsInside(Side side, int count) {
  const LungTemplate& lung = GeneratedLungs()[side];
  std::mt19937_64 random(side == kLeft ? 7 : 11);
  const auto draw = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Points points(3, count);
  for (int i = 0; i < count;) {
    const Eigen::Vector3d at =
        lung.box().min() + Eigen::Vector3d(draw(), draw(), draw()).cwiseProduct(lung.box().sizes());
    if (lung.DistanceAt(at) < -0.003) points.col(i++) = at;
  }
  return points;
}

// The shape: scaled, and bent backwards with the height.
inline Eigen::Vector3d Shaped(const Eigen::Vector3d& p) {
  return {1.1 * p.x(), 0.95 * p.y() + 0.4 * p.z() * p.z(), 1.05 * p.z()};
}

// Tissue moves down, by 2 mm at the top and `descent` at the bottom, more at the back; a little forwards and outwards.
inline Eigen::Vector3d Moved(const Eigen::Vector3d& xi_eta_zeta, double outwards, double descent) {
  const double depth = std::pow(1 - xi_eta_zeta.z(), 1.5), back = xi_eta_zeta.y();
  return {outwards * 0.001 * depth, -0.0015 * depth * (1 - back), -(0.002 + descent * depth) * (1 + 0.35 * back)};
}

inline Landmarks SyntheticPerson(int count = 800, double descent = 0.011, double noise = 0.0005) {
  Landmarks person = {Points(3, 2 * count), Points(3, 2 * count)};
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, noise);
  for (const Side side : {kRight, kLeft}) {
    const Eigen::AlignedBox3d& box = GeneratedLungs()[side].box();
    const Points points = PointsInside(side, count);
    for (int i = 0; i < count; ++i) {
      const double outwards = side == kLeft ? 1 : -1;
      Eigen::Vector3d place = (2 * points.col(i) - box.min() - box.max()).cwiseQuotient(box.sizes());
      place.x() *= outwards;
      place.z() = (place.z() + 1) / 2;
      const int at = side * count + i;
      person.exhale.col(at) = Shaped(points.col(i));
      person.motion.col(at) = Moved(place, outwards, descent);
      for (double& value : person.motion.col(at)) value += normal(random);
    }
  }
  return person;
}

}  // namespace phrenic::fit

#endif  // PHRENIC_TESTS_FIT_SYNTHETIC_PERSON_H_
