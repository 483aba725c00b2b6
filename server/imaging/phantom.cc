#include "server/imaging/phantom.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "absl/strings/str_cat.h"
#include "server/anatomy/anatomy.h"
#include "server/imaging/phantom_organs.h"
#include "server/imaging/voxelise.h"
#include "server/mesh/units.h"

namespace phrenic::imaging {
namespace {

const Eigen::Vector3d kLow(-145, -125, -12), kHigh(145, 160, 405);  // bounds of the generated thorax [mm]

// Returns the share of the flattening at a height, in [0, 1]: 0 at the rim and at the lungs' apices, 1 at the domes.
double Share(double z) {
  const double up = z < 205 ? (z - 95) / 110 : (330 - z) / 125;
  const double t = std::clamp(up, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

bool IsSoft(v1::Structure structure) { return structure == v1::STRUCTURE_LUNG || structure == v1::STRUCTURE_DIAPHRAGM; }

// Returns the bounds of the box that the body's map makes of the generated thorax' box [mm].
Eigen::AlignedBox3d PlacedBox(const PhantomBody& body) {
  Eigen::AlignedBox3d bounds;
  const int parts = body.physique == nullptr ? 1 : 12;
  for (int k = 0; k <= parts; ++k) {
    for (int j = 0; j <= parts; ++j) {
      for (int i = 0; i <= parts; ++i) {
        const Eigen::Vector3d at = kLow + (kHigh - kLow).cwiseProduct(Eigen::Vector3d(i, j, k)) / parts;
        bounds.extend(1e3 * body.FromGenerated(kMillimetre * at, false));
      }
    }
  }
  return bounds;
}

LabelVolume EmptyVolume(const PhantomBody& body, double voxel) {
  const Eigen::AlignedBox3d bounds = PlacedBox(body);
  const Eigen::Vector3d &low = bounds.min(), &high = bounds.max();
  LabelVolume volume;
  volume.size = ((high - low) / voxel).array().ceil().cast<int>() + 1;
  // The usual scanner orientation: i to the patient's right, j anterior, k superior.
  volume.to_patient.linear() = Eigen::Vector3d(-voxel, -voxel, voxel).asDiagonal();
  volume.to_patient.translation() = Eigen::Vector3d(high.x(), high.y(), low.z());
  volume.labels.assign(static_cast<std::size_t>(volume.size.x()) * volume.size.y() * volume.size.z(), 0);
  return volume;
}

template <typename Visit>
void ForEachVoxel(const Eigen::Vector3i& size, const Visit& visit) {
  for (int k = 0; k < size.z(); ++k) {
    for (int j = 0; j < size.y(); ++j) {
      for (int i = 0; i < size.x(); ++i) visit(Eigen::Vector3i(i, j, k));
    }
  }
}

void AddOrgans(const PhantomBody& body, const v1::LabelMap& map, LabelVolume& volume) {
  std::vector<v1::LabelMeaning> organs;
  std::copy_if(map.labels().begin(), map.labels().end(), std::back_inserter(organs),
               [](const v1::LabelMeaning& label) { return label.has_organ(); });
  std::optional<anatomy::PhysiqueInverse> inverse;
  if (body.physique != nullptr) inverse.emplace(*body.physique);
  ForEachVoxel(volume.size, [&](const Eigen::Vector3i& at) {
    Label& voxel = volume.labels[volume.Index(at)];
    if (voxel != 0) return;
    const Eigen::Vector3d placed = kMillimetre * (volume.to_patient * at.cast<double>());
    const Eigen::Vector3d point = 1e3 * body.ToGenerated(placed, true, inverse ? &*inverse : nullptr);
    if (point.z() < 60 || point.z() > 310) return;
    for (const v1::LabelMeaning& organ : organs) {
      if (!InOrgan(organ.organ(), point)) continue;
      voxel = static_cast<Label>(organ.number());
      return;
    }
  });
}

// Returns the generated structures of a label: all ribs, all cartilages or the three parts of the sternum if the map
// has one label for them.
std::vector<v1::Anatomy> PartsOf(const v1::Anatomy& anatomy) {
  std::vector<v1::Anatomy> parts;
  if (anatomy.structure() == v1::STRUCTURE_STERNUM_BODY) {
    for (const auto part : {v1::STRUCTURE_STERNUM_BODY, v1::STRUCTURE_MANUBRIUM, v1::STRUCTURE_XIPHOID}) {
      parts.emplace_back().set_structure(part);
    }
    return parts;
  }
  if (anatomy.structure() != v1::STRUCTURE_COSTAL_CARTILAGE && anatomy.structure() != v1::STRUCTURE_RIB) {
    return {anatomy};
  }
  if (anatomy.number() != 0) return {anatomy};
  const int last = anatomy.structure() == v1::STRUCTURE_RIB ? 12 : 10;
  for (const auto side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    for (int number = 1; number <= last; ++number) {
      v1::Anatomy& part = parts.emplace_back(anatomy);
      part.set_number(number);
      part.set_side(side);
    }
  }
  return parts;
}

bool IsGenerated(const v1::Anatomy& part) { return part.structure() != v1::STRUCTURE_VERTEBRA || part.number() <= 15; }

absl::Status AddSurfaces(const PhantomBody& body, const v1::LabelMap& map, double voxel, LabelVolume& volume) {
  std::vector<std::string> made;
  for (const v1::LabelMeaning& label : map.labels()) {
    if (!label.has_anatomy()) continue;
    for (const v1::Anatomy& part : PartsOf(label.anatomy())) {
      const std::string key = part.SerializeAsString();
      if (!IsGenerated(part) || std::find(made.begin(), made.end(), key) != made.end()) continue;
      made.push_back(key);
      const absl::StatusOr<Mesh> mesh = PhantomPart(body, part, std::max(5.0, voxel));
      if (!mesh.ok()) return mesh.status();
      Voxelise(*mesh, static_cast<Label>(label.number()), volume);
    }
  }
  return absl::OkStatus();
}

// Replaces random voxels at label borders by a neighbour's label, to simulate disagreement between segmentations.
void Roughen(double share, std::mt19937& random, LabelVolume& volume) {
  const std::vector<Label> before = volume.labels;
  std::uniform_real_distribution<double> chance(0, 1);
  std::uniform_int_distribution<int> step(-1, 1);
  ForEachVoxel(volume.size, [&](const Eigen::Vector3i& at) {
    const Eigen::Vector3i to = at + Eigen::Vector3i(step(random), step(random), step(random));
    if (!volume.Contains(to) || before[volume.Index(to)] == before[volume.Index(at)]) return;
    // A border voxel draws a neighbour of another label about a third of the time.
    if (chance(random) < 3 * share) volume.labels[volume.Index(at)] = before[volume.Index(to)];
  });
}

// Clears the labels in random balls of 3 mm radius.
void Pierce(int holes, double voxel, std::mt19937& random, LabelVolume& volume) {
  std::vector<std::size_t> labelled;
  for (std::size_t at = 0; at < volume.labels.size(); ++at) {
    if (volume.labels[at] != 0) labelled.push_back(at);
  }
  std::uniform_int_distribution<std::size_t> any(0, labelled.size() - 1);
  const int reach = std::max(1, static_cast<int>(std::lround(3 / voxel)));
  for (int hole = 0; hole < holes; ++hole) {
    const std::size_t at = labelled[any(random)];
    const Eigen::Vector3i centre(static_cast<int>(at % volume.size.x()),
                                 static_cast<int>(at / volume.size.x() % volume.size.y()),
                                 static_cast<int>(at / volume.size.x() / volume.size.y()));
    ForEachVoxel(Eigen::Vector3i::Constant(2 * reach + 1), [&](const Eigen::Vector3i& by) {
      const Eigen::Vector3i offset = by.array() - reach;
      if (offset.squaredNorm() <= reach * reach && volume.Contains(centre + offset)) {
        volume.labels[volume.Index(centre + offset)] = 0;
      }
    });
  }
}

}  // namespace

Eigen::Vector3d PhantomBody::FromGenerated(const Eigen::Vector3d& generated, bool soft) const {
  Eigen::Vector3d placed = generated;
  if (physique != nullptr) placed = kMillimetre * (*physique)(generated / kMillimetre);
  if (soft) placed.z() -= kMillimetre * flattening * Share(generated.z() / kMillimetre);
  return scale.cwiseProduct(placed) + kMillimetre * shift;
}

Eigen::Vector3d PhantomBody::ToGenerated(const Eigen::Vector3d& placed, bool soft,
                                         anatomy::PhysiqueInverse* inverse) const {
  const Eigen::Vector3d lowered = (placed - kMillimetre * shift).cwiseQuotient(scale);
  if (inverse != nullptr) return kMillimetre * (*inverse)(lowered / kMillimetre);
  if (physique != nullptr) return kMillimetre * anatomy::PhysiqueInverse(*physique)(lowered / kMillimetre);
  Eigen::Vector3d generated = lowered;
  constexpr int kRounds = 20;  // fixed-point iteration; a contraction, since d(flattening)/dz < 1
  for (int i = 0; soft && i < kRounds; ++i) {
    generated.z() = lowered.z() + kMillimetre * flattening * Share(generated.z() / kMillimetre);
  }
  return generated;
}

absl::StatusOr<PhantomBody> FindPhantomBody(std::string_view name) {
  const std::vector<PhantomBody> bodies = {
      {"adult"}, {"small", {0.85, 0.85, 0.84}}, {"tall", {1.04, 1.02, 1.12}}, {"flat", {1.02, 1.08, 1.0}, 22}};
  for (const PhantomBody& body : bodies) {
    if (body.name == name) return body;
  }
  return absl::NotFoundError(
      absl::StrCat("there is no body \"", std::string(name), "\"; there are adult, small, tall and flat"));
}

PhantomBody PhantomBodyOf(const v1::Physique& physique) {
  PhantomBody body{.name = "person"};
  const auto map = std::make_shared<const anatomy::PhysiqueMap>(physique);
  if (!map->IsIdentity()) body.physique = map;
  return body;
}

absl::StatusOr<Mesh> PhantomPart(const PhantomBody& body, const v1::Anatomy& part, double resolution_mm) {
  absl::StatusOr<Mesh> mesh = anatomy::Generate(part, resolution_mm);
  if (!mesh.ok()) return mesh;
  const bool soft = IsSoft(part.structure());
  for (Eigen::Index i = 0; i < mesh->vertices.cols(); ++i) {
    mesh->vertices.col(i) = body.FromGenerated(mesh->vertices.col(i), soft);
  }
  return mesh;
}

absl::StatusOr<LabelVolume> MakePhantom(const PhantomBody& body, const PhantomOptions& options,
                                        const v1::LabelMap& map) {
  LabelVolume volume = EmptyVolume(body, options.voxel);
  if (absl::Status status = AddSurfaces(body, map, options.voxel, volume); !status.ok()) return status;
  AddOrgans(body, map, volume);
  std::mt19937 random(options.seed);
  Roughen(options.noise, random, volume);
  Pierce(options.holes, options.voxel, random, volume);
  for (const v1::LabelMeaning& label : map.labels()) volume.names[label.number()] = label.name();
  return volume;
}

}  // namespace phrenic::imaging
