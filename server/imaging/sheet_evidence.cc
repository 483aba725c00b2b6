#include "server/imaging/sheet_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace phrenic::imaging {
namespace {

enum Tissue : std::uint8_t { kNothing, kThorax, kAbdomen, kBone, kSheet };

constexpr int kRays = 121;          // along each axis of the grid
constexpr double kNear = 14;        // maximum distance between organs on opposite sides of the sheet [mm]
constexpr double kBelowLung = 3.5;  // distance of the middle surface below a lung or the heart [mm]
constexpr double kOffBone = 4;      // distance of the middle surface from a bone's inner face [mm]
constexpr double kMaxDepth = 260;   // of a ray [mm]

Tissue TissueOf(const Part& part) {
  if (part.organ != v1::ORGAN_UNSPECIFIED) return part.organ == v1::ORGAN_HEART ? kThorax : kAbdomen;
  switch (part.anatomy.structure()) {
    case v1::STRUCTURE_LUNG:
      return kThorax;
    case v1::STRUCTURE_VERTEBRA:
      return part.anatomy.number() >= 11 ? kBone : kNothing;
    case v1::STRUCTURE_DIAPHRAGM:
      return kSheet;
    default:
      return kBone;
  }
}

// Returns the height above which the part is no evidence [mm]: there, sternum and cartilages are in front of the heart.
double CeilingOf(const Part& part, const CageFrame& frame) {
  constexpr double kInsertion = 12;  // [mm]
  const bool in_front = part.Is(v1::STRUCTURE_STERNUM_BODY) || part.Is(v1::STRUCTURE_COSTAL_CARTILAGE) ||
                        part.Is(v1::STRUCTURE_MANUBRIUM) || part.Is(v1::STRUCTURE_XIPHOID);
  return in_front ? frame.sternum_end + kInsertion : std::numeric_limits<double>::infinity();
}

// Returns the tissue of each voxel of the volume. The diaphragm's own label wins over what it overlaps but bone.
std::vector<Tissue> ClassifyVoxels(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame) {
  std::vector<Tissue> tissues(volume.labels.size(), kNothing);
  const auto rank = [](const Part* part) { return TissueOf(*part) == kBone ? 2 : TissueOf(*part) == kSheet ? 1 : 0; };
  std::vector<const Part*> ordered;
  ordered.reserve(parts.size());
  for (const Part& part : parts) ordered.push_back(&part);
  std::ranges::stable_sort(ordered, {}, rank);
  for (const Part* each : ordered) {
    const Part& part = *each;
    const Tissue tissue = TissueOf(part);
    const Mask& mask = part.mask;
    const double ceiling = CeilingOf(part, frame);
    std::size_t at = 0;
    for (int k = 0; k < mask.size.z(); ++k) {
      for (int j = 0; j < mask.size.y(); ++j) {
        for (int i = 0; i < mask.size.x(); ++i, ++at) {
          const Eigen::Vector3i voxel = mask.low + Eigen::Vector3i(i, j, k);
          if (mask.inside[at] != 1 || !volume.Contains(voxel)) continue;
          if (mask.Position(volume, at).z() < ceiling) tissues[volume.Index(voxel)] = tissue;
        }
      }
    }
  }
  return tissues;
}

struct Observation {
  Source source = Source::kNone;
  double depth = 0;  // [mm]
};

// Casts a ray outwards.
Observation CastRay(const LabelVolume& volume, const std::vector<Tissue>& tissues, const Eigen::Affine3d& to_voxel,
                    const Ray& ray) {
  const double step = volume.Spacing().minCoeff() / 3;
  double abdomen = -1, sheet = -1;
  for (double depth = step; depth < kMaxDepth; depth += step) {
    const Eigen::Vector3i voxel = (to_voxel * ray.At(depth)).array().round().cast<int>();
    if (!volume.Contains(voxel)) break;
    const Tissue tissue = tissues[volume.Index(voxel)];
    if (tissue == kSheet && sheet < 0) sheet = depth;
    if (sheet > 0 && tissue != kSheet) return {Source::kLabel, (sheet + depth - step) / 2};
    if (tissue == kAbdomen) abdomen = depth;
    if (tissue == kBone) return {Source::kOnBone, depth - kOffBone};
    if (tissue != kThorax) continue;
    if (abdomen > 0 && depth - abdomen < kNear) return {Source::kBetween, (depth + abdomen) / 2};
    return {Source::kBesideOne, depth - kBelowLung};
  }
  return {};
}

// Returns the observation of a horizontal ray, which meets the sheet on the wall if it meets no organ before.
Observation OnWall(const Observation& observed, const Ray& ray, const FittedCage& cage) {
  if (observed.source != Source::kOnBone && observed.source != Source::kNone) return observed;
  const double azimuth = std::atan2(ray.direction.x(), -ray.direction.y());
  return {observed.source == Source::kNone ? Source::kOnWall : Source::kOnBone, cage.Radius(azimuth, ray.origin.z())};
}

}  // namespace

SheetEvidence CollectEvidence(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame,
                              const FittedCage& cage) {
  const std::vector<Tissue> tissues = ClassifyVoxels(volume, parts, frame);
  const Eigen::Affine3d to_voxel = volume.to_patient.inverse();
  const bool labelled = std::ranges::find(tissues, kSheet) != tissues.end();
  SheetEvidence evidence;
  evidence.count = kRays;
  evidence.source.assign(kRays * kRays, Source::kNone);
  evidence.depth.assign(kRays * kRays, 0);
  for (int j = 0; j < kRays; ++j) {
    for (int i = 0; i < kRays; ++i) {
      const Eigen::Vector2d p = evidence.Plane(i, j);
      if (p.norm() > kPlaneReach) continue;
      const Ray ray = frame.RayOf(p);
      Observation observation = CastRay(volume, tissues, to_voxel, ray);
      if (labelled && observation.source != Source::kLabel) observation = {};  // through an opening
      if (p.norm() > 1) observation = OnWall(observation, ray, cage);
      evidence.source[evidence.Index(i, j)] = observation.source;
      evidence.depth[evidence.Index(i, j)] = observation.depth;
    }
  }
  return evidence;
}

}  // namespace phrenic::imaging
