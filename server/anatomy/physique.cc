#include "server/anatomy/physique.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"
#include "server/anatomy/meshing/smooth.h"
#include "server/mesh/units.h"
#include "server/schema/physique.h"

namespace phrenic::anatomy {
namespace {

using std::numbers::pi;

constexpr double kAdultHeight = 1.75;                       // [m]
constexpr double kSpineBottom = 100, kSpineTop = 396;       // of the thoracic spine [mm]
constexpr double kReach = 60;                               // L [mm]
constexpr double kFront = -98, kBack = 40, kFollows = 0.3;  // of w: y of the breastbone and of the spine [mm]
constexpr double kRibSlope = 31;                            // of the adult's first ribs [degrees]
constexpr double kTwistShare = 0.25;                        // of the Cobb angle

double Tangent(double degrees) { return std::tan(degrees * pi / 180); }

double Saturated(double distance) { return kReach * std::tanh(distance / kReach); }

// How far a place follows the spine sideways and backwards.
double Following(double y) { return kFollows + (1 - kFollows) * Smooth((y - kFront) / (kBack - kFront)); }

// A curve sin^2 along the thoracic spine, of slope 1 where it is steepest, and its derivative.
struct Bow {
  double value, slope;
};

Bow BowAt(double z) {
  const double t = std::clamp((z - kSpineBottom) / (kSpineTop - kSpineBottom), 0.0, 1.0), sine = std::sin(pi * t);
  return {(kSpineTop - kSpineBottom) / pi * sine * sine, std::sin(2 * pi * t)};
}

// True if the numbers that the map reads are equal. Both are complete.
bool SameShape(v1::Physique a, v1::Physique b) {
  for (v1::Physique* each : {&a, &b}) {
    each->clear_sex();
    each->clear_age();
    each->clear_barrel_chest();
  }
  return a.SerializeAsString() == b.SerializeAsString();
}

// 0 at the domes' rim and at the lungs' apices, 1 at the domes.
double ShareOfDomes(double z) { return Smooth(z < 205 ? (z - 95) / 110 : (330 - z) / 125); }

}  // namespace

PhysiqueMap::PhysiqueMap(const v1::Physique& physique) {
  const v1::Physique full = schema::CompletePhysique(physique);
  identity_ = SameShape(full, schema::CompletePhysique({}));
  scale_ = full.height() / kAdultHeight * Eigen::Vector3d(full.chest_width(), full.chest_depth(), 1);
  right_dome_ = full.right_dome_height() / kMillimetre;
  left_dome_ = full.left_dome_height() / kMillimetre;
  rib_slope_ = Tangent(kRibSlope + full.rib_slope_degrees()) - Tangent(kRibSlope);
  kyphosis_ = Tangent(full.kyphosis_degrees() / 2);
  scoliosis_ = Tangent(full.scoliosis_degrees() / 2);
  twist_ = Tangent(kTwistShare * full.scoliosis_degrees());
}

void PhysiqueMap::RaiseDomes(Eigen::Vector3d& x) const {
  if (right_dome_ == 0 && left_dome_ == 0) return;
  const double share = ShareOfDomes(x.z());
  if (share == 0) return;
  const double q = CageSection(x.z(), kDiaphragmInset).DiscCoordinates(x.head<2>()).squaredNorm();
  if (!(q < 1)) return;
  constexpr double kMiddle = 30;  // over which one dome passes into the other [mm]
  const double left = (1 + std::tanh(x.x() / kMiddle)) / 2;
  x.z() += (right_dome_ + left * (left_dome_ - right_dome_)) * (1 - q * q) * (1 - q * q) * share;
}

void PhysiqueMap::BendBack(Eigen::Vector3d& x) const {
  const double spine = SpineFront(x.z());
  constexpr double kSoft = 10;  // [mm]
  x.z() -= rib_slope_ * kSoft * std::log1p(std::exp((spine - x.y()) / kSoft));
  if (kyphosis_ == 0) return;
  const Bow bow = BowAt(x.z());
  const double behind = x.y() - SpineFront(x.z());
  x.y() += kyphosis_ * bow.value * Following(x.y());
  x.z() -= kyphosis_ * bow.slope * Saturated(behind);
}

void PhysiqueMap::BendAside(Eigen::Vector3d& x) const {
  if (scoliosis_ == 0) return;
  const double z = x.z();
  const Bow bow = BowAt(z);
  const double turn = twist_ * bow.value * pi / (kSpineTop - kSpineBottom), follows = Following(x.y()), aside = x.x();
  x.y() -= turn * x.x();
  x.x() += turn * Saturated(x.y() - SpineFront(z));
  x.x() -= scoliosis_ * bow.value * follows;
  x.z() += scoliosis_ * bow.slope * follows * Saturated(aside);
}

Eigen::Vector3d PhysiqueMap::operator()(const Eigen::Vector3d& adult) const {
  if (identity_) return adult;
  Eigen::Vector3d x = adult;
  RaiseDomes(x);
  BendBack(x);
  BendAside(x);
  return scale_.cwiseProduct(x);
}

}  // namespace phrenic::anatomy
