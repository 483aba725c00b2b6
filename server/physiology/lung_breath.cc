#include "server/physiology/lung_breath.h"

#include <algorithm>
#include <utility>

#include "server/mechanics/motions/lung_modes.h"

namespace phrenic::physiology {
namespace {

constexpr double kSample = 0.006;  // distance of the points that regions are averaged over [m]

struct MeanOf {
  double sum = 0, count = 0;
  void Add(double value) { sum += value, count += 1; }
  double Value() const { return count > 0 ? sum / count : kNone; }
};

double VolumeGained(const LungTissue& tissue, const Points& nodes) {
  double volume = 0;
  for (Eigen::Index p = 0; p < tissue.areas().size(); ++p) {
    const Eigen::Vector3d shift = tissue.DisplacementAt(nodes, tissue.points().col(p));
    volume += tissue.areas()[p] * tissue.normals().col(p).dot(shift);
  }
  return volume;
}

// The sums of one lung.
struct RegionSums {
  std::array<MeanOf, kLungRegions> caudal, gained;
  MeanOf back, front, upwards;

  // `at` is the place in the lung's box, 0..1.
  void Add(const Eigen::Vector3d& at, double descent, double ventilation) {
    const int third = std::clamp(static_cast<int>(3 * at.z()), 0, 2);
    const int depth = at.y() > 2.0 / 3 ? kLungBack : kLungFront;
    const bool is_between = at.y() > 1.0 / 3 && at.y() <= 2.0 / 3;
    upwards.Add(descent < 0 ? 1 : 0);
    for (const int region : {kLungBase + third, depth}) {
      if (region == depth && is_between) continue;
      caudal[region].Add(descent);
      gained[region].Add(ventilation);
    }
    if (at.z() < 0.5 && !is_between) (depth == kLungBack ? back : front).Add(descent);
  }
};

LungReading ReadLung(const LungMotion& lung, const LungField& field) {
  RegionSums sums;
  const Eigen::AlignedBox3d& box = lung.tissue.box();
  for (Eigen::Index i = 0; i < field.ventilation.size(); ++i) {
    if (field.lung[i] == 0) continue;
    const Eigen::Vector3d at = (field.PointAt(i) - box.min()).cwiseQuotient(box.sizes());
    sums.Add(at, -field.displacement(2, i), field.ventilation[i]);
  }
  LungReading reading;
  reading.volume = VolumeGained(lung.tissue, lung.nodes);
  for (int r = 0; r < kLungRegions; ++r) {
    reading.caudal[r] = sums.caudal[r].Value();
    reading.gained[r] = sums.gained[r].Value();
  }
  reading.back_over_front = sums.back.Value() / sums.front.Value();
  reading.upwards = sums.upwards.Value();
  return reading;
}

}  // namespace

absl::StatusOr<BreathingLungs> BreathingLungs::Make(const Subject& subject, const LungElasticity& elasticity,
                                                    LungCauses causes) {
  const Parts& parts = subject.parts;
  if (parts.lungs.empty() || parts.muscle < 0 || parts.wall < 0) {
    return absl::FailedPreconditionError(
        "the scene lacks lungs, a deformable diaphragm or an inner wall of the cage, so that nothing moves lung "
        "tissue");
  }
  std::vector<std::string> names;
  for (const int b : parts.lungs) names.push_back(subject.model.bodies[static_cast<size_t>(b)].name);
  absl::StatusOr<std::vector<LungTissue>> tissues = MakeLungs(subject.model, parts, elasticity, causes);
  if (!tissues.ok()) return tissues.status();
  LungDrive drive(subject.model, parts, *tissues, causes);
  return BreathingLungs(std::move(names), *std::move(tissues), std::move(drive));
}

std::vector<LungMotion> BreathingLungs::Motions(const Recording& breath) const {
  const LungDrive::Moment base = drive_.At(breath.base, breath.parameters),
                          peak = drive_.At(breath.peak, breath.parameters);
  const LungWeight weight = drive_.WeightIn(breath.parameters.posture());
  std::vector<PressedLung> lungs;
  std::array<double, 2> followed = {}, pressed = {};
  for (size_t i = 0; i < tissues_.size(); ++i) {
    lungs.push_back(tissues_[i].Under(weight).SolvePressed(peak.displacement[i] - base.displacement[i]));
    followed[drive_.side(i)] += VolumeGained(tissues_[i], lungs[i].followed);
    pressed[drive_.side(i)] += VolumeGained(tissues_[i], lungs[i].pressed);
  }
  const std::array<double, 2> opened = {peak.space[0] - base.space[0], peak.space[1] - base.space[1]};
  const std::array<double, 2> pressures = FillingPressures(opened, followed, pressed);
  std::vector<LungMotion> motions;
  motions.reserve(tissues_.size());
  for (size_t i = 0; i < tissues_.size(); ++i) {
    motions.push_back({tissues_[i], lungs[i].followed + pressures[drive_.side(i)] * lungs[i].pressed});
  }
  return motions;
}

std::vector<LungReading> BreathingLungs::Readings(const std::vector<LungMotion>& motions) const {
  std::vector<LungReading> readings = ReadingsOf(motions);
  for (size_t i = 0; i < readings.size(); ++i) readings[i].lung = names_[i];
  return readings;
}

std::vector<LungReading> ReadingsOf(const std::vector<LungMotion>& motions) {
  std::vector<LungReading> readings;
  for (const LungMotion& motion : motions) {
    const absl::StatusOr<LungField> field = SampleLungs(std::span(&motion, 1), kSample);
    readings.push_back(field.ok() ? ReadLung(motion, *field) : LungReading());
  }
  return readings;
}

absl::StatusOr<std::vector<LungMotion>> MotionsOfModes(const Model& model, const v1::Parameters& parameters) {
  std::vector<LungMotion> motions;
  const LungModes* modes = LungModes::Find(model);
  if (modes == nullptr) return motions;
  const State state = model.InitialState();
  const auto amplitudes_at = [&](double phase) {
    return LungModes::AmplitudesAt(MakeEvalContext(model, parameters, state, state.time, phase, {}));
  };
  constexpr int kSamples = 400;
  Eigen::Vector<double, kModeParameters> least = amplitudes_at(0), most = least;
  for (int i = 1; i < kSamples; ++i) {
    const Eigen::Vector<double, kModeParameters> now = amplitudes_at(static_cast<double>(i) / kSamples);
    if (now.squaredNorm() < least.squaredNorm()) least = now;
    if (now.squaredNorm() > most.squaredNorm()) most = now;
  }
  for (const LungModes::Inside& lung : modes->insides()) {
    absl::StatusOr<LungTissue> tissue = LungTissue::Make(model.bodies[static_cast<size_t>(lung.body)].mesh);
    if (!tissue.ok()) return tissue.status();
    const Eigen::VectorXd nodes = lung.shapes * (most - least);
    motions.push_back({*std::move(tissue), nodes.reshaped(3, lung.grid.nodes().cols())});
  }
  return motions;
}

LoweredPoints LoweredInBreath(const Recording& breath) {
  const auto lungs = BreathingLungs::Make(*breath.subject);
  if (!lungs.ok()) return LoweredLungs(breath.subject->model, breath.subject->parts, breath.base, breath.peak);
  LoweredPoints lowered;
  for (const LungMotion& motion : lungs->Motions(breath)) {
    const absl::StatusOr<LungField> field = SampleLungs(std::span(&motion, 1), kSample);
    if (!field.ok()) return {};
    for (Eigen::Index i = 0; i < field->ventilation.size(); ++i) {
      if (field->lung[i] == 0) continue;
      lowered.rest.push_back(field->PointAt(i));
      lowered.by.push_back(-field->displacement(2, i));
    }
  }
  return lowered;
}

}  // namespace phrenic::physiology
