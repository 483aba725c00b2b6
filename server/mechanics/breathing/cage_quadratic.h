// Quantities of a free rib cage as functions of its coordinates: quadratic in the two that all ribs share, and in the
// departures of its parts.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_CAGE_QUADRATIC_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_CAGE_QUADRATIC_H_

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace phrenic {

// Parts of the cage whose ribs can depart from the two coordinates that all ribs share: by w u in both, u the part's
// own coordinate and w a weight: of the sides 1 right and -1 left, of a segment 1 for its ribs and 0 for the others.
enum CagePart : size_t { kCageSides, kRightSegment, kLeftSegment, kCageParts };

// k of the pump handle and of the bucket handle, and u of the parts; 0 at rest.
struct CagePosition {
  double pump = 0, bucket = 0;
  std::array<double, kCageParts> parts = {};

  // True if what is computed from one is that of the other to the bit, also if a coordinate is a negative zero.
  bool SameBits(const CagePosition& other) const {
    using Bits = std::array<std::uint64_t, 2 + kCageParts>;
    return std::bit_cast<Bits>(*this) == std::bit_cast<Bits>(other);
  }
  bool departs() const { return parts != std::array<double, kCageParts>{}; }
  // Returns the two coordinates of a place where the parts have these weights.
  CagePosition Of(const std::array<double, kCageParts>& weights) const {
    double departure = 0;
    for (size_t i = 0; i < kCageParts; ++i) departure += weights[i] * parts[i];
    return {pump + departure, bucket + departure};
  }
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

// y = u (c0 + c1 p + c2 b + c3 u): what a part adds.
struct PartQuadratic {
  std::array<double, 4> c = {};

  double At(const CagePosition& k, double u) const { return u * (Slope(k) + c[3] * u); }
  double ByPart(const CagePosition& k, double u) const { return Slope(k) + 2 * c[3] * u; }
  double Slope(const CagePosition& k) const { return c[0] + c[1] * k.pump + c[2] * k.bucket; }
};

// The sum of what the shared coordinates and the parts do.
struct CageFunction {
  CageQuadratic shared;
  std::array<PartQuadratic, kCageParts> parts;

  double At(const CagePosition& k) const {
    double sum = shared.At(k);
    for (size_t i = 0; i < kCageParts; ++i) sum += parts[i].At(k, k.parts[i]);
    return sum;
  }
  double ByPump(const CagePosition& k) const {
    double sum = shared.ByPump(k);
    for (size_t i = 0; i < kCageParts; ++i) sum += parts[i].c[1] * k.parts[i];
    return sum;
  }
  double ByBucket(const CagePosition& k) const {
    double sum = shared.ByBucket(k);
    for (size_t i = 0; i < kCageParts; ++i) sum += parts[i].c[2] * k.parts[i];
    return sum;
  }
  double ByPart(const CagePosition& k, size_t part) const { return parts[part].ByPart(k, k.parts[part]); }
  // The rate of change at the rate of the coordinates.
  double RateAt(const CagePosition& k, const CagePosition& rate) const {
    double sum = ByPump(k) * rate.pump + ByBucket(k) * rate.bucket;
    for (size_t i = 0; i < kCageParts; ++i) sum += ByPart(k, i) * rate.parts[i];
    return sum;
  }
};

// Fits quadratics to values at nine positions, by least squares. Immutable, thread-safe.
class CageFit {
 public:
  CageFit();

  // The nine positions: each coordinate at -0.3, 0.4 and 1.
  static const std::vector<CagePosition>& Positions();
  // The four positions at which a part's values are read: its own coordinate at -0.4 and 0.4 with the others at 0, and
  // at -0.4 with either of the others at 1.
  static std::array<CagePosition, 4> PositionsOf(CagePart part);
  // Returns the function through changes at these positions from what they are with the part at 0.
  static PartQuadratic Through(const std::array<double, 4>& changes);

  // Adds the share of the value at Positions()[position], a change from rest, to the fit. After one call for each
  // position `fit`, which was zero, is complete.
  void Add(size_t position, double value, CageQuadratic& fit) const;

 private:
  Eigen::Matrix<double, 5, 9> inverse_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_CAGE_QUADRATIC_H_
