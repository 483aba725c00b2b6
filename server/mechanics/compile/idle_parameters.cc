#include "server/mechanics/compile/idle_parameters.h"

#include <algorithm>
#include <initializer_list>

#include "server/mechanics/lungs/mode_parameters.h"

namespace phrenic {
namespace {

template <typename Elements, typename Condition>
bool Any(const Elements& elements, const Condition& condition) {
  return std::any_of(elements.begin(), elements.end(), condition);
}

}  // namespace

void ReportIdleParameters(const v1::Scene& scene, v1::CompileReport& report) {
  const auto idle_unless = [&report](bool used, std::initializer_list<const char*> names) {
    if (used) return;
    for (const char* name : names) report.add_idle_parameters(name);
  };
  const auto has_force = [&scene](const auto& condition) { return Any(scene.forces(), condition); };
  const auto has_line = [&](v1::Side side) {
    return has_force([side](const v1::Force& force) { return force.action_line().side() == side; });
  };
  const bool ribs = Any(scene.motions(), [](const v1::Motion& motion) { return motion.has_ribs(); });
  const bool driven =
      Any(scene.motions(), [](const v1::Motion& motion) { return motion.has_ribs() && !motion.ribs().has_free(); });
  const bool muscle = has_force([](const v1::Force& force) { return force.has_muscle(); });
  const bool cage = has_force([](const v1::Force& force) { return force.has_chest_wall(); });
  const bool thorax = has_force([](const v1::Force& force) { return force.has_thorax_pressures(); });
  const bool lines = has_force([](const v1::Force& force) { return force.has_action_line() || force.has_fibres(); });
  const bool air = has_force([](const v1::Force& force) { return force.action_line().air_load() > 0; });
  idle_unless(ribs, {"rib_motion", "pump_handle", "bucket_handle"});
  idle_unless(lines || muscle || cage, {"apply_muscles"});
  idle_unless(driven || air, {"hyperinflation"});
  idle_unless(muscle, {"diaphragm_activation"});
  idle_unless(cage, {"intercostal_activation", "chest_wall_compliance"});
  const auto has_cage = [&scene](const auto& condition) {
    return Any(scene.motions(), [&](const v1::Motion& motion) { return condition(motion.ribs().free()); });
  };
  idle_unless(
      cage && has_cage([](const v1::FreeCage& free) { return free.has_sides(); }),
      {"right_intercostals", "left_intercostals", "right_cage_compliance", "left_cage_compliance", "cage_tilt"});
  idle_unless(cage && has_cage([](const v1::FreeCage& free) { return free.has_segments(); }),
              {"flail_right", "flail_left"});
  idle_unless(muscle || cage || thorax, {"muscle_strength"});
  idle_unless(cage || thorax, {"expiratory_activation"});
  idle_unless(thorax, {"airway_resistance", "lung_compliance", "abdominal_compliance", "abdominal_load",
                       "airway_pressure", "ventilator_pressure", "airway_closed", "trapped_air", "pneumothorax_right",
                       "pneumothorax_left", "pleural_fluid_right", "pleural_fluid_left", "posture"});
  if (!Any(scene.motions(), [](const v1::Motion& motion) { return motion.has_lung_modes(); })) {
    for (const ModeParameter& parameter : ModeParameters()) report.add_idle_parameters(parameter.name);
  }
  idle_unless(muscle || has_line(v1::SIDE_RIGHT), {"right_activation"});
  idle_unless(muscle || has_line(v1::SIDE_LEFT), {"left_activation"});
  const bool shares = scene.breath().waveform() == v1::WAVEFORM_RAISED_COSINE;
  idle_unless(shares, {"inspiratory_share", "pause_share"});
  idle_unless(shares && thorax, {"glottis_share"});
  idle_unless(lines || muscle || cage || driven || thorax, {"waxing"});
  idle_unless(!scene.constraints().empty(), {"apply_links"});
}

}  // namespace phrenic
