#include "server/physiology/rows.h"

namespace phrenic::physiology {
namespace {

constexpr const char *kRange = "general knowledge", *kSign = "sign of the effect", *kThird = "about a third of health";
constexpr Needs kAir = Needs::kPressures;

constexpr ChangedBreath kBreaths[] = {
    {"quiet, stiff lungs", "quiet", "lung_compliance: 0.25"},
    {"quiet, narrow airways", "quiet", "airway_resistance: 10"},
    {"sniff, right palsy", "sniff", "right_activation: 0"},
    {"sniff, COPD", "sniff", "lung_compliance: 1.6 trapped_air: 0.0008"},
    {"deep, obesity", "deep", "abdominal_load: 700 abdominal_compliance: 0.6 chest_wall_compliance: 0.6"},
    {"deep, ascites", "deep", "abdominal_load: 1000 abdominal_compliance: 0.4"},
    {"deep, kyphoscoliosis", "deep", "chest_wall_compliance: 0.35 right_cage_compliance: 0.3 cage_tilt: -0.2"},
    {"cough, weak abdominal muscles", "cough", "expiratory_activation: 0.1"},
    {"cough, open glottis", "cough", "glottis_share: 0"},
};

constexpr Row kChangedRows[] = {
    {"sniff, right palsy", "right dome, rise", "mm", 2, 15, &RightRise, Needs::kSheet, kRange},
    {"sniff, right palsy", "transdiaphragmatic pressure of health's", "%", 25, 45, &PdiShare, kAir, kThird, "sniff"},
    {"palsy-both", "both domes, rise at the end of inspiration", "mm", 0.5, 60, &BothRise, Needs::kSheet, kSign},
    {"palsy-both", "abdominal share of volume", "%", -200, 0, &AbdominalShare, kAir, kSign},
    {"sniff, COPD", "ribs 7-10 drawn in", "mm", 0.5, 30, &RibsDrawnIn, kAir, "Hoover's sign"},
    {"copd", "volume at rest over health's", "l", 0.5, 1.5, &VolumeAbove, kAir, kRange, "quiet", Follows::kLungs},
    {"copd", "descent of the right dome, of health's", "%", 40, 80, &DescentShare, kAir, kRange, "quiet"},
    {"upright", "volume at rest over supine", "l", 0.4, 1.0, &VolumeAbove, kAir, kRange, "quiet", Follows::kLungs},
    {"upright", "right dome at rest over supine", "mm", -60, -1, &ApexAbove, kAir, kSign, "quiet"},
    {"upright", "abdominal share below supine", "points", 10, 25, &AbdominalShareLost, kAir, kRange, "quiet"},
    {"obesity", "volume at rest over health's", "l", -0.8, -0.2, &VolumeAbove, kAir, kRange, "quiet", Follows::kLungs},
    {"obesity", "right dome at rest over health's", "mm", 1, 60, &ApexAbove, kAir, kSign, "quiet"},
    {"deep, obesity", "descent of the right dome, of health's", "%", 0, 99, &DescentShare, kAir, kSign, "deep"},
    {"ascites", "volume at rest over health's", "l", -0.8, -0.2, &VolumeAbove, kAir, kRange, "quiet", Follows::kLungs},
    {"ascites", "right dome at rest over health's", "mm", 1, 60, &ApexAbove, kAir, kSign, "quiet"},
    {"deep, ascites", "descent of the right dome, of health's", "%", 0, 99, &DescentShare, kAir, kSign, "deep"},
    {"flail-chest", "right ribs 4-7 drawn in", "mm", 1, 30, &RightRibsIn, kAir, kSign},
    {"flail-chest", "left ribs 4-7 outward", "mm", 0.5, 30, &LeftRibsOut, kAir, kSign},
    {"kyphoscoliosis", "right ribs 4-7 outward, of left ones", "%", -20, 70, &RightRibsShare, kAir, kSign},
    {"deep, kyphoscoliosis", "volume breathed in, of health's", "%", 30, 75, &InspiredShare, kAir, kRange, "deep"},
    {"cough", "greatest flow out", "l/s", 4, 15, &FlowOut, kAir, "peak cough flow of adults"},
    {"cough", "pleural pressure, rise", "cmH2O", 40, 250, &PleuralRise, kAir, kRange},
    {"cough, weak abdominal muscles", "greatest flow out", "l/s", 0, 4.5, &FlowOut, kAir, "under 270 l/min is weak"},
    {"cough, open glottis", "pleural pressure, rise, of the cough's", "1", 0, 0.95, &PleuralRiseShare, kAir, kSign,
     "cough"},
    {"cough, open glottis", "greatest flow out, of the cough's", "1", 0, 0.98, &FlowOutShare, kAir, kSign, "cough"},
    {"quiet, stiff lungs", "tidal volume lost", "%", 25, 60, &TidalVolumeLost, kAir, kRange, "quiet"},
    {"quiet, stiff lungs", "descent of the right dome, of health's", "%", 0, 99, &DescentShare, kAir, kSign, "quiet"},
    {"quiet, narrow airways", "greatest flow in, of health's", "1", 0, 0.95, &FlowShare, kAir, kSign, "quiet"},
    {"quiet, narrow airways", "work of a litre over health's", "1", 1.05, 100, &WorkShare, kAir, kSign, "quiet"},
    {"quiet, narrow airways", "pressure-volume loop over health's", "1", 1.5, 100, &LoopShare, kAir, kSign, "quiet"},
    {"ventilator", "volume breathed in", "l", 0.5, 1.1, &InspiredVolume, kAir, kRange, "", Follows::kLungs},
    {"ventilator", "lesser dome, descent", "mm", 0.5, 60, &LesserDescent, kAir, kSign},
    {"ventilator", "back over front descent", "1", 0, 1, &BackOverFront, kAir, kRange},
    {"mueller", "volume change", "l", 0, 0.05, &TidalVolume, kAir, kRange, "", Follows::kLungs},
    {"mueller", "pleural pressure, fall over a quiet breath's", "1", 1, 50, &PleuralFallShare, kAir, kSign, "quiet"},
    {"mueller", "domes, greatest motion", "mm", 0, 5, &DomeMotion, kAir, "almost still"},
};

}  // namespace

std::span<const ChangedBreath> ChangedBreaths() { return kBreaths; }
std::span<const Row> RowsOfChanges() { return kChangedRows; }

}  // namespace phrenic::physiology
