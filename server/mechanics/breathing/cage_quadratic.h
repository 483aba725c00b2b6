// Quantities of a free rib cage as quadratic functions of its two coordinates.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_CAGE_QUADRATIC_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_CAGE_QUADRATIC_H_

#include <Eigen/Core>
#include <array>
#include <vector>

namespace phrenic {

// k of the pump handle and of the bucket handle, 0 at rest.
struct CagePosition {
  double pump = 0, bucket = 0;
};

// y = c0 p + c1 b + c2 p^2 + c3 b^2 + c4 p b: a change from rest.
struct CageQuadratic {
  std::array<double, 5> c = {};

  double At(const CagePosition& k) const {
    return k.pump * (c[0] + c[2] * k.pump + c[4] * k.bucket) + k.bucket * (c[1] + c[3] * k.bucket);
  }
  double ByPump(const CagePosition& k) const { return c[0] + 2 * c[2] * k.pump + c[4] * k.bucket; }
  double ByBucket(const CagePosition& k) const { return c[1] + 2 * c[3] * k.bucket + c[4] * k.pump; }
};

// Fits quadratics to values at nine positions, by least squares. Immutable, thread-safe.
class CageFit {
 public:
  CageFit();

  // The nine positions: each coordinate at -0.3, 0.4 and 1.
  static const std::vector<CagePosition>& Positions();
  // Adds the share of the value at Positions()[position], a change from rest, to the fit. After one call for each
  // position `fit`, which was zero, is complete.
  void Add(size_t position, double value, CageQuadratic& fit) const;

 private:
  Eigen::Matrix<double, 5, 9> inverse_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_CAGE_QUADRATIC_H_
