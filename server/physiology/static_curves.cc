#include "server/physiology/static_curves.h"

#include <algorithm>
#include <cmath>

namespace phrenic::physiology {
namespace {

constexpr int kPoints = 61;
constexpr double kLeastVolume = 0.25;     // of the rest volume
constexpr double kMostRoom = 0.97;        // of what the lungs can take up
constexpr double kLargestPressure = 2e4;  // of the wall [Pa]

// The abdomen's displaced volume at a pressure above rest [m^3], by bisection.
double AbdomenVolume(const v1::Abdomen& abdomen, double compliance, double pressure) {
  const double stiffening = pressure > 0 ? abdomen.stiffening_volume_out() : abdomen.stiffening_volume_in();
  double low = 0, high = std::abs(pressure) * compliance;  // the stiffening only lessens it
  for (int i = 0; i < 60; ++i) {
    const double volume = (low + high) / 2, ratio = volume / stiffening;
    (volume / compliance * (1 + ratio * ratio) < std::abs(pressure) ? low : high) = volume;
  }
  return std::copysign(low, pressure);
}

// The chest wall's volume above rest at a pleural pressure above that at rest [m^3].
double WallVolume(const v1::ThoraxPressures& thorax, const v1::ChestWall* cage, const v1::Parameters& parameters,
                  double pressure) {
  double volume =
      AbdomenVolume(thorax.abdomen(), thorax.abdomen().compliance() * parameters.abdominal_compliance(), pressure);
  if (cage == nullptr) return volume;
  const double stiffening = pressure < 0 ? cage->stiffening_below_rest() : 1;
  return volume + pressure * cage->compliance() * parameters.chest_wall_compliance() / stiffening;
}

double WallPressure(const v1::ThoraxPressures& thorax, const v1::ChestWall* cage, const v1::Parameters& parameters,
                    double volume) {
  double low = -kLargestPressure, high = kLargestPressure;
  for (int i = 0; i < 60; ++i) {
    const double pressure = (low + high) / 2;
    (WallVolume(thorax, cage, parameters, pressure) < volume ? low : high) = pressure;
  }
  return thorax.pleural_pressure() + low;
}

double LungPressure(const v1::ThoraxPressures& thorax, const v1::Parameters& parameters, double volume) {
  const v1::LungPair& lungs = thorax.lungs();
  const double recoil = std::log(lungs.room() / (lungs.room() - volume)) / lungs.recoil_rate();
  return (thorax.pleural_pressure() - recoil) / parameters.lung_compliance();
}

const v1::ChestWall* ChestWallOf(const v1::Scene& scene) {
  for (const v1::Force& force : scene.forces()) {
    if (force.has_chest_wall()) return &force.chest_wall();
  }
  return nullptr;
}

}  // namespace

const v1::ThoraxPressures* ThoraxPressuresOf(const v1::Scene& scene) {
  for (const v1::Force& force : scene.forces()) {
    if (force.has_thorax_pressures()) return &force.thorax_pressures();
  }
  return nullptr;
}

std::vector<v1::StaticCurve> StaticCurves(const v1::Scene& scene, const v1::Parameters& parameters) {
  const v1::ThoraxPressures* thorax = ThoraxPressuresOf(scene);
  if (thorax == nullptr) return {};
  const v1::ChestWall* cage = ChestWallOf(scene);
  std::vector<v1::StaticCurve> curves(2);
  curves[0].set_kind(v1::StaticCurve::KIND_LUNG_RECOIL);
  curves[1].set_kind(v1::StaticCurve::KIND_CHEST_WALL);
  const double rest = thorax->lungs().rest_volume();
  const double least = (kLeastVolume - 1) * rest, most = kMostRoom * thorax->lungs().room();
  for (int i = 0; i < kPoints; ++i) {
    const double volume = least + (most - least) * i / (kPoints - 1);
    curves[0].add_pressures(LungPressure(*thorax, parameters, volume));
    curves[1].add_pressures(WallPressure(*thorax, cage, parameters, volume));
    for (v1::StaticCurve& curve : curves) curve.add_volumes(rest + volume);
  }
  return curves;
}

}  // namespace phrenic::physiology
