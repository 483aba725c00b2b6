#include "server/imaging/patient/template_parts.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/anatomy/anatomy.h"
#include "server/imaging/label_surface.h"
#include "server/imaging/voxelise.h"
#include "server/mesh/nearest.h"
#include "server/mesh/units.h"

namespace phrenic::imaging {
namespace {

constexpr double kPartResolution = 5;  // of the template's surfaces [mm]
constexpr int kRibs = 12, kVertebrae = 15, kCartilages = 10;
constexpr double kMostGrown = 3e8;     // voxels of the grown grid
constexpr double kNearFilled = 15e-3;  // of marked vertices from a filled part [m]

// A part of the template that the volume lacks.
struct Missing {
  std::string name;
  v1::Anatomy anatomy;
  v1::Organ organ = v1::ORGAN_UNSPECIFIED;
  bool soft() const { return organ != v1::ORGAN_UNSPECIFIED || anatomy.structure() == v1::STRUCTURE_LUNG; }
};

v1::Anatomy AnatomyOf(v1::Structure structure, int number, v1::Side side) {
  v1::Anatomy anatomy;
  anatomy.set_structure(structure);
  if (number > 0) anatomy.set_number(number);
  if (side != v1::SIDE_UNSPECIFIED) anatomy.set_side(side);
  return anatomy;
}

bool Has(const std::vector<Part>& parts, v1::Structure structure, int number, v1::Side side) {
  return std::any_of(parts.begin(), parts.end(), [&](const Part& part) {
    return part.Is(structure) && (number == 0 || part.anatomy.number() == number) &&
           (side == v1::SIDE_UNSPECIFIED || part.anatomy.side() == side);
  });
}

const char* WordOf(v1::Side side) { return side == v1::SIDE_LEFT ? "left" : "right"; }

// Adds the missing ones of a structure that has numbers and sides.
int AddOfSides(const std::vector<Part>& parts, v1::Structure structure, const char* name, int last,
               std::vector<Missing>& missing) {
  const std::size_t before = missing.size();
  for (const v1::Side side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    for (int number = 1; number <= last; ++number) {
      if (Has(parts, structure, number, side)) continue;
      missing.push_back({absl::StrFormat("%s-%d-%s", name, number, WordOf(side)), AnatomyOf(structure, number, side)});
    }
  }
  return static_cast<int>(missing.size() - before);
}

void AddFront(const std::vector<Part>& parts, std::vector<Missing>& missing) {
  const auto any = v1::SIDE_UNSPECIFIED;
  const bool sternum = Has(parts, v1::STRUCTURE_STERNUM_BODY, 0, any) || Has(parts, v1::STRUCTURE_MANUBRIUM, 0, any);
  if (!sternum) {
    missing.push_back({"manubrium", AnatomyOf(v1::STRUCTURE_MANUBRIUM, 0, any)});
    missing.push_back({"sternum-body", AnatomyOf(v1::STRUCTURE_STERNUM_BODY, 0, any)});
    missing.push_back({"xiphoid", AnatomyOf(v1::STRUCTURE_XIPHOID, 0, any)});
  }
  if (Has(parts, v1::STRUCTURE_COSTAL_CARTILAGE, 0, any)) return;
  AddOfSides(parts, v1::STRUCTURE_COSTAL_CARTILAGE, "cartilage", kCartilages, missing);
}

std::vector<Missing> FindMissing(const std::vector<Part>& parts) {
  std::vector<Missing> missing;
  const int ribs = AddOfSides(parts, v1::STRUCTURE_RIB, "rib", kRibs, missing);
  if (ribs > kRibs) AddFront(parts, missing);
  for (const v1::Side side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    if (Has(parts, v1::STRUCTURE_LUNG, 0, side)) continue;
    missing.push_back({absl::StrCat("lung-", WordOf(side)), AnatomyOf(v1::STRUCTURE_LUNG, 0, side)});
  }
  for (int number = 1; !Has(parts, v1::STRUCTURE_VERTEBRA, 0, v1::SIDE_UNSPECIFIED) && number <= kVertebrae; ++number) {
    missing.push_back({number > 12 ? absl::StrCat("l", number - 12) : absl::StrCat("t", number),
                       AnatomyOf(v1::STRUCTURE_VERTEBRA, number, v1::SIDE_UNSPECIFIED)});
  }
  const bool heart = std::any_of(parts.begin(), parts.end(), [](const Part& part) {
    return part.organ == v1::ORGAN_HEART || part.Is(v1::STRUCTURE_DIAPHRAGM);
  });
  if (!heart) missing.push_back({"heart", AnatomyOf(v1::STRUCTURE_HEART, 0, v1::SIDE_UNSPECIFIED), v1::ORGAN_HEART});
  return missing;
}

// Takes the voxels of the parts out of a mask.
void TakeAway(const std::vector<Part>& parts, Mask& mask) {
  for (const Part& part : parts) {
    if (part.filled) continue;
    const Eigen::Vector3i low = mask.low.cwiseMax(part.mask.low);
    const Eigen::Vector3i high = (mask.low + mask.size).cwiseMin(part.mask.low + part.mask.size);
    for (int k = low.z(); k < high.z(); ++k) {
      for (int j = low.y(); j < high.y(); ++j) {
        for (int i = low.x(); i < high.x(); ++i) {
          const Eigen::Vector3i at = Eigen::Vector3i(i, j, k) - part.mask.low,
                                own = Eigen::Vector3i(i, j, k) - mask.low;
          if (part.mask.inside[part.mask.Index(at.x(), at.y(), at.z())] != 1) continue;
          mask.inside[mask.Index(own.x(), own.y(), own.z())] = 0;
        }
      }
    }
  }
}

// Returns the part in the volume's grid; nothing if nothing is left of it.
std::optional<Part> PartFrom(const Missing& missing, const TemplateFit& fit, const LabelVolume& volume,
                             const std::vector<Part>& seen) {
  absl::StatusOr<Mesh> mesh = anatomy::Generate(missing.anatomy, kPartResolution);
  if (!mesh.ok()) return std::nullopt;
  for (Eigen::Index i = 0; i < mesh->vertices.cols(); ++i) {
    mesh->vertices.col(i) = kMillimetre * fit.ToPerson(mesh->vertices.col(i) / kMillimetre);
  }
  Part part;
  part.name = missing.name;
  part.organ = missing.organ;
  if (part.organ == v1::ORGAN_UNSPECIFIED) part.anatomy = missing.anatomy;
  part.filled = true;
  part.mask = VoxeliseMask(*mesh, volume, SurfaceMargin(volume));
  if (missing.soft()) {
    TakeAway(seen, part.mask);
  } else {
    Close(part.mask, 1);  // a bone may be thinner than a voxel
    part.surface = *std::move(mesh);
  }
  std::vector<Mask> pieces = ConnectedComponents(part.mask, SurfaceMargin(volume));
  if (pieces.empty()) return std::nullopt;
  part.mask = std::move(pieces.front());
  return part;
}

// Moves the grid's borders so that it contains every part. Keeps it if it would be too large.
void Grow(FilledParts& filled) {
  Eigen::Vector3i low = Eigen::Vector3i::Zero(), high = filled.volume.size;
  for (const Part& part : filled.parts) {
    if (!part.filled) continue;
    low = low.cwiseMin(part.mask.low);
    high = high.cwiseMax(part.mask.low + part.mask.size);
  }
  if ((high - low).cast<double>().prod() > kMostGrown) low.setZero(), high = filled.volume.size;
  filled.volume.size = high - low;
  filled.volume.to_patient = filled.volume.to_patient * Eigen::Translation3d(low.cast<double>());
  filled.volume.labels.assign(static_cast<std::size_t>((high - low).cast<std::int64_t>().prod()), 0);
  for (Part& part : filled.parts) part.mask.low -= low;
}

void ReportFit(const TemplateFit& fit, v1::TemplateFill& report) {
  report.set_residual_mm(fit.residual);
  for (int axis = 0; axis < 3; ++axis) report.add_scale(fit.scale[axis]);
}

// Returns the centres of the voxels of these parts that have a neighbour outside [m].
Points SurfaceVoxels(const FilledParts& filled, bool from_template) {
  std::vector<Eigen::Vector3d> found;
  for (const Part& part : filled.parts) {
    if (part.filled != from_template) continue;
    const Mask& mask = part.mask;
    const std::size_t row = mask.size.x(), slice = row * mask.size.y();
    for (std::size_t at = slice; at + slice < mask.inside.size(); ++at) {
      if (mask.inside[at] != 1) continue;
      const int around = mask.inside[at - 1] + mask.inside[at + 1] + mask.inside[at - row] + mask.inside[at + row] +
                         mask.inside[at - slice] + mask.inside[at + slice];
      if (around < 6) found.push_back(kMillimetre * mask.Position(filled.volume, at));
    }
  }
  Points points(3, static_cast<Eigen::Index>(found.size()));
  for (std::size_t i = 0; i < found.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = found[i];
  return points;
}

}  // namespace

FilledParts FillFromTemplate(const LabelVolume& volume, std::vector<Part> parts, const TemplateFit* given) {
  FilledParts filled;
  filled.volume = volume;
  filled.parts = std::move(parts);
  const std::vector<Missing> missing = FindMissing(filled.parts);
  if (missing.empty()) return filled;
  const absl::StatusOr<TemplateFit> bones =
      given != nullptr ? absl::StatusOr<TemplateFit>(*given) : FitTemplate(volume, filled.parts, false);
  const absl::StatusOr<TemplateFit> soft =
      given != nullptr ? absl::StatusOr<TemplateFit>(*given) : FitTemplate(volume, filled.parts, true);
  if (!bones.ok() || !soft.ok()) {
    filled.report.set_not_filled(std::string((bones.ok() ? soft : bones).status().message()));
    return filled;
  }
  ReportFit(*bones, filled.report);
  const std::vector<Part> seen = filled.parts;
  for (const Missing& one : missing) {
    std::optional<Part> part = PartFrom(one, one.soft() ? *soft : *bones, volume, seen);
    if (!part.has_value()) continue;
    filled.report.add_parts(part->name);
    filled.parts.push_back(*std::move(part));
  }
  Grow(filled);
  return filled;
}

double MarkFilled(const FilledParts& filled, Mesh& sheet) {
  const Points from_template = SurfaceVoxels(filled, true), from_volume = SurfaceVoxels(filled, false);
  if (from_template.cols() == 0) return 0;
  const NearestSearch near_filled(from_template), near_seen(from_volume);
  std::vector<int> marked;
  for (int i = 0; i < static_cast<int>(sheet.vertices.cols()); ++i) {
    const double distance = near_filled.Nearest(sheet.vertices.col(i), kNearFilled).distance;
    if (distance > kNearFilled || near_seen.Nearest(sheet.vertices.col(i), distance).vertex >= 0) continue;
    marked.push_back(i);
  }
  const double share = static_cast<double>(marked.size()) / static_cast<double>(sheet.vertices.cols());
  if (!marked.empty()) sheet.regions[kFromTemplate] = std::move(marked);
  return share;
}

}  // namespace phrenic::imaging
