#include "server/mechanics/breathing/muscle_law.h"

#include <algorithm>

namespace phrenic {
namespace {

constexpr double kTendonShear = 0.38;  // over its stiffness: 1/(2 (1 + nu)) with nu about 0.3
constexpr double kHill = 4;            // inverse of Hill's a over the isometric force
constexpr double kHalfRise = 0.13;     // of the largest rate: where lengthening fibres have half of their extra force

// Returns the active tension at force-length s = (l/optimal - 1)/width.
TensionAt ActiveAt(const MuscleLaw& law, double active, double stretch) {
  const double s = std::clamp((stretch / law.optimal - 1) / law.width, -1.0, 1.0);
  const double ds = 1 / (law.optimal * law.width);
  const bool overlaps = s > -1 && s < 1;
  return {active * (1 - s * s), overlaps ? -2 * active * s * ds : 0, active * (s - s * s * s / 3) / ds};
}

TensionAt RestingAt(const MuscleLaw& law, double resting, double stretch) {
  const double length = 1 - law.slack, q = std::clamp((stretch - law.slack) / length, 0.0, 1.0);
  const double beyond = std::max(0.0, stretch - 1);
  return {resting * q * q, q < 1 ? 2 * resting * q / length : 0, resting * (q * q * q / 3 * length + beyond)};
}

TensionAt PassiveAt(const MuscleLaw& law, double stretch) {
  const double o = std::clamp(stretch - 1, 0.0, 1.0), beyond = std::max(0.0, stretch - 2);
  const double tension = law.passive * o * (1 + law.growth * o);
  const bool grows = stretch > 1 && stretch < 2;
  return {tension, grows ? law.passive * (1 + 2 * law.growth * o) : 0,
          law.passive * o * o * (0.5 + law.growth * o / 3) + tension * beyond};
}

}  // namespace

MuscleLaw MakeMuscleLaw(const v1::Muscle& scene) {
  const double h = scene.thickness();
  return {.active = scene.active_stress() * h,
          .optimal = scene.optimal_stretch(),
          .width = scene.force_length_width(),
          .slack = scene.slack_stretch(),
          .passive = scene.passive_stiffness(),
          .growth = scene.passive_growth(),
          .across = {scene.modulus_across() * h, scene.compressed_share()},
          .tendon = {scene.tendon_stiffness(), scene.tendon_compressed_share()},
          .shear = scene.shear_modulus() * h,
          .tendon_shear = kTendonShear * scene.tendon_stiffness(),
          .viscosity = scene.viscosity(),
          .tendon_viscosity = scene.tendon_viscosity()};
}

MuscleLaw MuscleLaw::Scaled(double elasticity) const {
  MuscleLaw scaled = *this;
  for (double* each :
       {&scaled.passive, &scaled.across.stiffness, &scaled.tendon.stiffness, &scaled.shear, &scaled.tendon_shear}) {
    *each *= elasticity;
  }
  return scaled;
}

TensionAt LinearAt(const LinearTension& law, double resting, double stretch) {
  const double change = stretch - 1, tension = resting + law.stiffness * change;
  const double share = tension < 0 ? law.compressed : 1;
  // The energy of a linear tension from its zero, so that it is continuous there.
  if (law.stiffness > 0)
    return {share * tension, share * law.stiffness, share * tension * tension / (2 * law.stiffness)};
  return {share * tension, 0, share * tension * change};
}

TensionAt MuscleAt(const MuscleLaw& law, double resting, double active, double stretch) {
  TensionAt sum = ActiveAt(law, active, stretch);
  for (const TensionAt& part : {RestingAt(law, resting, stretch), PassiveAt(law, stretch)}) {
    sum = {sum.tension + part.tension, sum.slope + part.slope, sum.energy + part.energy};
  }
  return sum;
}

HillLaw MakeHillLaw(const v1::Muscle& scene) {
  return {scene.shortening_rate() * scene.optimal_stretch(), scene.lengthening_force()};
}

double HillLaw::At(double rate) const {
  if (shortening_rate == 0) return 1;
  const double u = -rate / shortening_rate;
  if (u > 0) return std::max(0.0, (1 - u) / (1 + kHill * u));
  return 1 + (lengthening - 1) * -u / (kHalfRise - u);
}

}  // namespace phrenic
