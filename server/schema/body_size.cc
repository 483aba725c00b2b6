#include "server/schema/body_size.h"

#include <algorithm>
#include <cmath>

#include "server/schema/physique.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

constexpr double kAdultHeight = 1.75;                      // [m]
constexpr double kLeastHeight = 1.45, kMostHeight = 1.95;  // in whom volumes were measured [m]
constexpr double kMostAge = 70;                            // [years]

// Predicted volumes [l].
struct LungVolumes {
  double total, resting, residual;
};

LungVolumes PredictedVolumes(bool woman, double height, double age) {
  const double within = std::clamp(height, kLeastHeight, kMostHeight), years = std::min(age, kMostAge);
  const LungVolumes at = woman ? LungVolumes{6.60 * within - 5.79, 2.24 * within + 0.001 * years - 1.00,
                                             1.81 * within + 0.016 * years - 2.00}
                               : LungVolumes{7.99 * within - 7.08, 2.34 * within + 0.009 * years - 1.09,
                                             1.31 * within + 0.022 * years - 1.23};
  const double beyond = std::pow(height / within, 3);
  return {beyond * at.total, beyond * at.resting, beyond * at.residual};
}

LungVolumes VolumesOf(const v1::Physique& full) {
  return PredictedVolumes(full.sex() == v1::SEX_FEMALE, full.height(), full.age());
}

double SectionOf(const v1::Physique& full) { return full.chest_width() * full.chest_depth(); }

void ScaleLungs(const BodySize& size, v1::LungPair& lungs) {
  FillDefaults(&lungs);
  lungs.set_room(size.inspired * lungs.room());
  lungs.set_rest_volume(size.resting * lungs.rest_volume());
  lungs.set_resistance(lungs.resistance() / size.resting);
  lungs.set_peripheral_resistance(lungs.peripheral_resistance() / size.resting);
  lungs.set_mediastinal_compliance(size.volume * lungs.mediastinal_compliance());
  lungs.set_mediastinal_inertia(lungs.mediastinal_inertia() / size.volume);
}

void ScaleAbdomen(double volume, v1::Abdomen& abdomen) {
  FillDefaults(&abdomen);
  abdomen.set_compliance(volume * abdomen.compliance());
  abdomen.set_stiffening_volume_out(volume * abdomen.stiffening_volume_out());
  abdomen.set_stiffening_volume_in(volume * abdomen.stiffening_volume_in());
  abdomen.set_resistance(abdomen.resistance() / volume);
}

void ScaleMuscle(double length, v1::Muscle& muscle) {
  FillDefaults(&muscle);
  muscle.set_thickness(length * muscle.thickness());
  muscle.set_resting_tension(length * muscle.resting_tension());
  muscle.set_resting_tension_across(length * muscle.resting_tension_across());
  muscle.set_passive_stiffness(length * muscle.passive_stiffness());
  muscle.set_tendon_tension(length * muscle.tendon_tension());
  muscle.set_tendon_stiffness(length * muscle.tendon_stiffness());
}

}  // namespace

BodySize SizeOf(const v1::Physique& physique) {
  const v1::Physique full = CompletePhysique(physique), adult = CompletePhysique({});
  v1::Physique usual;  // of this sex, with the chest that it chooses
  usual.set_sex(full.sex());
  const double section = SectionOf(full) / SectionOf(CompletePhysique(usual));
  const LungVolumes own = VolumesOf(full), of = VolumesOf(adult);
  BodySize size;
  size.volume = std::pow(full.height() / kAdultHeight, 3) * SectionOf(full);
  size.length = std::cbrt(size.volume);
  size.lungs = section * own.total / of.total;
  size.resting = section * own.resting / of.resting;
  size.inspired = section * (own.total - own.resting) / (of.total - of.resting);
  size.vital = section * (own.total - own.residual) / (of.total - of.residual);
  return size;
}

void ScaleForces(const BodySize& size, v1::Scene* scene) {
  for (v1::Force& force : *scene->mutable_forces()) {
    if (force.has_muscle()) ScaleMuscle(size.length, *force.mutable_muscle());
    if (force.has_thorax_pressures()) {
      ScaleLungs(size, *force.mutable_thorax_pressures()->mutable_lungs());
      ScaleAbdomen(size.volume, *force.mutable_thorax_pressures()->mutable_abdomen());
    }
    if (!force.has_chest_wall()) continue;
    FillDefaults(force.mutable_chest_wall());
    force.mutable_chest_wall()->set_compliance(size.volume * force.chest_wall().compliance());
  }
}

void ScaleForcesToPhysique(v1::Scene* scene) {
  if (!scene->has_physique()) return;
  const BodySize size = SizeOf(scene->physique());
  if (size.volume == 1 && size.resting == 1 && size.inspired == 1) return;
  const auto given = scene->forces();
  ScaleForces(size, scene);
  for (int i = 0; i < given.size(); ++i) {
    v1::Force& force = *scene->mutable_forces(i);
    if (force.has_muscle()) {
      v1::Muscle own = given[i].muscle();
      own.clear_passive_regions();  // a list would be added to itself
      force.mutable_muscle()->MergeFrom(own);
    } else if (force.has_thorax_pressures()) {
      force.mutable_thorax_pressures()->MergeFrom(given[i].thorax_pressures());
    } else if (force.has_chest_wall()) {
      force.mutable_chest_wall()->MergeFrom(given[i].chest_wall());
    }
  }
}

}  // namespace phrenic::schema
