#include <algorithm>

#include "server/physiology/bones.h"
#include "server/physiology/lung_breath.h"
#include "server/physiology/measures.h"

namespace phrenic::physiology {
namespace {

constexpr double kMillimetresOfMetre = 1e3, kPercent = 100;

Points MuscleAt(const Recording& r, const State& state) {
  const Parts& parts = r.subject->parts;
  return Placed(r.subject->model, state, parts.muscle < 0 ? parts.sheet : parts.muscle);
}

Eigen::Vector3d Sternum(const Recording& r) {
  return kMillimetresOfMetre * SternumShift(r.subject->model, r.subject->parts, r.base, r.peak);
}

double Section(const Recording& r, int axis) {
  const double at = r.subject->columns.At(Columns::kRightApex)[axis];
  return kPercent * r.subject->fibres.SectionShortening(axis, at, MuscleAt(r, r.base), MuscleAt(r, r.peak));
}

double Across(const Recording& r, double share) {
  return kPercent * r.subject->fibres.StrainAcross(share, MuscleAt(r, r.base), MuscleAt(r, r.peak));
}

LungShift Lungs(const Recording& r) { return ShiftOf(LoweredInBreath(r)); }

// Returns how far ribs move out between the beginning and the peak [mm].
double OutwardBy(const Recording& r, Quantity ribs) {
  return kMillimetresOfMetre * (r.of[ribs][r.peak_sample] - r.of[ribs].front());
}

}  // namespace

double Shortening(const Recording& r, const Recording&) {
  return kPercent * r.subject->fibres.Shortening(MuscleAt(r, r.base), MuscleAt(r, r.peak));
}
double CoronalShortening(const Recording& r, const Recording&) { return Section(r, 1); }
double SagittalShortening(const Recording& r, const Recording&) { return Section(r, 0); }
double AcrossMedian(const Recording& r, const Recording&) { return Across(r, 0.5); }
double AcrossNearlyAll(const Recording& r, const Recording&) { return Across(r, 0.95); }

double TendonArea(const Recording& r, const Recording&) {
  return kPercent * r.subject->fibres.TendonAreaChange(MuscleAt(r, r.base), MuscleAt(r, r.peak));
}

double Thickening(const Recording& r, const Recording&) {
  const Parts& parts = r.subject->parts;
  // The thickness follows from the area where the middle surface is simulated.
  if (parts.wall < 0 || parts.muscle < 0 || parts.muscle == parts.sheet) return kNone;
  const Model& model = r.subject->model;
  return r.subject->fibres.ThickeningAtWall(model.bodies[parts.wall].mesh, Placed(model, r.base, parts.wall),
                                            Placed(model, r.peak, parts.wall), MuscleAt(r, r.base),
                                            MuscleAt(r, r.peak));
}

double SternumVentral(const Recording& r, const Recording&) { return -Sternum(r).y(); }
double SternumCranial(const Recording& r, const Recording&) { return Sternum(r).z(); }

double RibsOutward(const Recording& r, const Recording&) { return OutwardBy(r, kLowerRibs); }

double RibsDrawnIn(const Recording& r, const Recording&) {
  const auto& out = r.of[kLowerRibs];
  return kMillimetresOfMetre * (out.front() - *std::min_element(out.begin(), out.end()));
}

double RightRibsIn(const Recording& r, const Recording&) { return -OutwardBy(r, kRightRibs); }
double LeftRibsOut(const Recording& r, const Recording&) { return OutwardBy(r, kLeftRibs); }
double RightRibsShare(const Recording& r, const Recording&) {
  return kPercent * OutwardBy(r, kRightRibs) / OutwardBy(r, kLeftRibs);
}

double LungLeast(const Recording& r, const Recording&) { return kMillimetresOfMetre * Lungs(r).least; }
double LungApex(const Recording& r, const Recording&) { return kMillimetresOfMetre * Lungs(r).apex; }
double LungBase(const Recording& r, const Recording&) { return kMillimetresOfMetre * Lungs(r).base; }
double LungBackOverFront(const Recording& r, const Recording&) { return Lungs(r).back_over_front; }

}  // namespace phrenic::physiology
