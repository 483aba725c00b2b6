#include "server/phantom/hounsfield.h"

namespace phrenic::phantom {
namespace {

using fluoroscopy::CoefficientOf;
using fluoroscopy::Tissue;

constexpr double kWater = 100 * 0.1937;                                              // [1/m]
constexpr double kRibDensity = 1.4, kCorticalDensity = 1.92, kMarrowDensity = 1.02;  // [g/cm^3]

double OfCoefficient(double coefficient) { return 1000 * (coefficient - kWater) / kWater; }

}  // namespace

double HounsfieldOf(Tissue tissue) {
  if (tissue != Tissue::kRib) return OfCoefficient(CoefficientOf(tissue));
  constexpr double kCortical = (kRibDensity - kMarrowDensity) / (kCorticalDensity - kMarrowDensity);
  return OfCoefficient(kCortical * CoefficientOf(Tissue::kCortical) + (1 - kCortical) * CoefficientOf(Tissue::kMarrow));
}

double LungHounsfield(double ratio) { return OfCoefficient(fluoroscopy::LungCoefficient(1, ratio)); }

}  // namespace phrenic::phantom
