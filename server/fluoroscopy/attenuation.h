// How tissues absorb X-rays at 70 keV.
//
// Mass attenuation coefficients lie between the values of 60 and 80 keV of Hubbell and Seltzer's tables (NIST Standard
// Reference Database 126; tissues of ICRU Report 44), interpolated in both logarithms. Densities of whole bones are
// those of ICRU Report 46. The page has the same numbers in web/src/fluoroscopy/attenuation.ts.
#ifndef PHRENIC_SERVER_FLUOROSCOPY_ATTENUATION_H_
#define PHRENIC_SERVER_FLUOROSCOPY_ATTENUATION_H_

#include <optional>
#include <string_view>

namespace phrenic::fluoroscopy {

enum class Tissue {
  kWall,  // between the structures: half muscle, half fat
  kRib,   // marrow in a shell of cortical bone
  kCortical,
  kMarrow,
  kVertebra,
  kSternum,
  kCartilage,
  kMuscle,
  kOrgan,
  kBlood,
  kFluid,
  kAirway,
  kAir,
  kLung,
};

// Returns the linear attenuation coefficient of a tissue [1/m]. Requires: not kRib or kLung, which are not one number.
double CoefficientOf(Tissue tissue);

// Returns the coefficient of a lung of this volume [m^3]: its tissue and blood have the mass that they have at rest,
// 0.3 g/cm^3 of the volume at rest; what remains is air [1/m].
double LungCoefficient(double rest_volume, double volume);

// Returns the density of a lung's tissue and blood per volume of lung [g/cm^3].
double LungDensity(double rest_volume, double volume);

// Returns the tissue of a body, from its name and its layer; nullopt for what has none, such as an inner wall.
std::optional<Tissue> TissueOf(std::string_view name, std::string_view layer);

// True for a lobe, by its name, as the page knows no more: beside a lung it is a part of it, and has no tissue of its
// own.
bool IsLobe(std::string_view name);

// True for what the outline of the trunk is drawn around.
bool IsBone(std::optional<Tissue> tissue);

}  // namespace phrenic::fluoroscopy

#endif  // PHRENIC_SERVER_FLUOROSCOPY_ATTENUATION_H_
