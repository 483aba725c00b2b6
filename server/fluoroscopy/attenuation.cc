#include "server/fluoroscopy/attenuation.h"

#include <algorithm>
#include <cstdlib>

#include "absl/strings/ascii.h"

namespace phrenic::fluoroscopy {
namespace {

// [cm^2/g]
constexpr double kCorticalBone = 0.2616, kSoft = 0.1924, kAdipose = 0.1879, kBlood = 0.193, kLungTissue = 0.1928,
                 kDryAir = 0.1758, kWater = 0.1937;

// [1/m], of a coefficient [cm^2/g] and a density [g/cm^3].
constexpr double Linear(double coefficient, double density) { return 100 * coefficient * density; }

constexpr double kAirCoefficient = Linear(kDryAir, 0.0012), kSoftCoefficient = Linear(kSoft, 1.06);
constexpr double kMarrowCoefficient = Linear(kSoft, 1.02);
constexpr double kLungDensityAtRest = 0.3;  // [g/cm^3], CT's -700 HU

// A whole bone of this density [g/cm^3] as a mixture of cortical bone and marrow.
constexpr double Bone(double density) {
  const double cortical = (density - 1.02) / (1.92 - 1.02);
  return cortical * Linear(kCorticalBone, 1.92) + (1 - cortical) * kMarrowCoefficient;
}

bool HasAny(std::string_view text, std::initializer_list<std::string_view> parts) {
  return std::any_of(parts.begin(), parts.end(), [&](auto part) { return text.find(part) != text.npos; });
}

bool StartsWithAny(std::string_view text, std::initializer_list<std::string_view> parts) {
  return std::any_of(parts.begin(), parts.end(), [&](auto part) { return text.starts_with(part); });
}

// True for "t1" and "l12".
bool IsVertebraNumber(std::string_view name) {
  return name.size() > 1 && (name[0] == 't' || name[0] == 'l') &&
         std::all_of(name.begin() + 1, name.end(), [](char c) { return absl::ascii_isdigit(c); });
}

std::optional<Tissue> TissueOfName(std::string_view name) {
  if (HasAny(name, {"cartilage"}) || StartsWithAny(name, {"disc"})) return Tissue::kCartilage;
  if (HasAny(name, {"lung", "lobe"})) return Tissue::kLung;
  if (HasAny(name, {"effusion", "fluid"})) return Tissue::kFluid;
  if (HasAny(name, {"pneumothorax", "bubble"}) || StartsWithAny(name, {"air-"})) return Tissue::kAir;
  if (StartsWithAny(name, {"heart", "aorta"}) || HasAny(name, {"cava", "vein", "vessel"})) return Tissue::kBlood;
  if (StartsWithAny(name, {"liver", "spleen", "stomach", "kidney"})) return Tissue::kOrgan;
  if (HasAny(name, {"airway", "trachea"})) return Tissue::kAirway;
  if (HasAny(name, {"sternum", "manubrium", "xiphoid"})) return Tissue::kSternum;
  if (StartsWithAny(name, {"rib"})) return Tissue::kRib;
  if (HasAny(name, {"spine", "vertebra"}) || IsVertebraNumber(name)) return Tissue::kVertebra;
  if (HasAny(name, {"diaphragm", "muscle", "oesophagus"})) return Tissue::kMuscle;
  return std::nullopt;
}

}  // namespace

double CoefficientOf(Tissue tissue) {
  switch (tissue) {
    case Tissue::kWall:
      return (kSoftCoefficient + Linear(kAdipose, 0.95)) / 2;
    case Tissue::kCortical:
      return Linear(kCorticalBone, 1.92);
    case Tissue::kMarrow:
      return kMarrowCoefficient;
    case Tissue::kVertebra:
      return Bone(1.33);
    case Tissue::kSternum:
      return Bone(1.25);
    case Tissue::kCartilage:
      return Linear(kSoft, 1.1);
    case Tissue::kMuscle:
      return Linear(kSoft, 1.05);
    case Tissue::kOrgan:
      return kSoftCoefficient;
    case Tissue::kBlood:
      return Linear(kBlood, 1.06);
    case Tissue::kFluid:
      return Linear(kWater, 1.015);
    case Tissue::kAirway:  // a third wall, two thirds air
      return kSoftCoefficient / 3 + 2 * kAirCoefficient / 3;
    case Tissue::kAir:
      return kAirCoefficient;
    case Tissue::kRib:
    case Tissue::kLung:
      break;
  }
  std::abort();
}

double LungDensity(double rest_volume, double volume) { return kLungDensityAtRest * rest_volume / volume; }

double LungCoefficient(double rest_volume, double volume) {
  const double density = LungDensity(rest_volume, volume);
  return Linear(kLungTissue, density) + kAirCoefficient * std::max(0.0, 1 - density / 1.05);
}

std::optional<Tissue> TissueOf(std::string_view name, std::string_view layer) {
  if (layer == "mechanics") return std::nullopt;
  const std::optional<Tissue> tissue = TissueOfName(name);
  return tissue ? tissue : TissueOfName(layer);
}

bool IsLobe(std::string_view name) { return name.starts_with("lobe-"); }

bool IsBone(std::optional<Tissue> tissue) {
  return tissue == Tissue::kRib || tissue == Tissue::kSternum || tissue == Tissue::kVertebra;
}

}  // namespace phrenic::fluoroscopy
