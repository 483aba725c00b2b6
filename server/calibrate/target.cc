#include "server/calibrate/target.h"

namespace phrenic::calibrate {
namespace {

using physiology::Needs;
namespace ph = physiology;

constexpr Target kTargets[] = {
    {"tidal-volume", "l", "greatest minus least volume of the lungs", 0.01, 8, 0.1, 1, &ph::TidalVolume,
     Needs::kPressures},
    {"inspired-volume", "l", "greatest volume of the lungs minus that at the beginning of the breath", 0.01, 8, 0.1, 1,
     &ph::InspiredVolume, Needs::kPressures},
    {"lung-volume-at-rest", "l", "volume of the lungs at the beginning of the breath", 0.1, 8, 0.1, 1,
     &ph::VolumeAtRest, Needs::kPressures},
    {"abdominal-share", "1", "part of the inspired volume that the abdominal wall makes room for", -2, 2, 0.1, 0.01,
     &ph::AbdominalShare, Needs::kLungs},
    {"transdiaphragmatic-pressure", "cmH2O", "swing of the transdiaphragmatic pressure", 0.1, 300, 1, 1, &ph::PdiSwing,
     Needs::kPressures},
    {"pleural-fall", "cmH2O", "fall of the pleural pressure", 0.1, 300, 1, 1, &ph::PleuralFall, Needs::kPressures},
    {"right-dome", "mm", "descent of the right dome at its apex", 0.1, 150, 1, 1, &ph::RightApex, Needs::kSheet},
    {"left-dome", "mm", "descent of the left dome at its apex", 0.1, 150, 1, 1, &ph::LeftApex, Needs::kSheet},
    {"right-dome-rise", "mm", "rise of the right dome at its apex", 0.1, 150, 1, 1, &ph::RightRise, Needs::kSheet},
    {"left-dome-rise", "mm", "rise of the left dome at its apex", 0.1, 150, 1, 1, &ph::LeftRise, Needs::kSheet},
    {"shortening", "%", "shortening of the muscle in the coronal section", 0.1, 80, 1, 1, &ph::CoronalShortening,
     Needs::kFibres},
    {"sternum-forward", "mm", "forward motion of the sternum", 0.1, 100, 0.5, 1, &ph::SternumVentral, Needs::kBones},
    {"ribs-outward", "mm", "outward motion of ribs 7 to 10", 0.1, 100, 0.5, 1, &ph::RibsOutward, Needs::kBones},
};

}  // namespace

std::span<const Target> Targets() { return kTargets; }

}  // namespace phrenic::calibrate
