#include "server/imaging/segmented_parts.h"

#include <algorithm>
#include <set>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "server/imaging/label_surface.h"

namespace phrenic::imaging {
namespace {

constexpr double kSmallestPiece = 300;  // minimum volume of a component of a divided label [mm^3]
constexpr double kWhole = 0.9;          // minimum share of a label's voxels in its largest component

const char* SideWord(v1::Side side) { return side == v1::SIDE_LEFT ? "left" : "right"; }

std::string NameOf(const std::string& label, const v1::Anatomy& anatomy) {
  switch (anatomy.structure()) {
    case v1::STRUCTURE_RIB:
      return absl::StrCat("rib-", anatomy.number(), "-", SideWord(anatomy.side()));
    case v1::STRUCTURE_VERTEBRA:
      return anatomy.number() > 12 ? absl::StrCat("l", anatomy.number() - 12) : absl::StrCat("t", anatomy.number());
    default:
      return absl::StrReplaceAll(label, {{"_", "-"}, {" ", "-"}});
  }
}

// True if the label may hold several ribs or cartilages.
bool IsMany(const v1::Anatomy& anatomy) {
  const bool divisible =
      anatomy.structure() == v1::STRUCTURE_RIB || anatomy.structure() == v1::STRUCTURE_COSTAL_CARTILAGE;
  return divisible && anatomy.number() == 0;
}

double VoxelVolume(const LabelVolume& volume) { return std::abs(volume.to_patient.linear().determinant()); }

Eigen::Vector3d Centroid(const LabelVolume& volume, const Mask& mask) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t at = 0; at < mask.inside.size(); ++at) {
    if (mask.inside[at] == 1) sum += mask.Position(volume, at), ++count;
  }
  return sum / count;
}

// Returns the height of the end beside the spine [mm].
double HeadHeight(const LabelVolume& volume, const Mask& mask, double middle) {
  constexpr double kHead = 12;                     // [mm]
  const double back = Centroid(volume, mask).y();  // excludes the anterior end, which may be as close to the midplane
  double nearest = 1e9, sum = 0, count = 0;
  for (const bool nearest_known : {false, true}) {
    for (std::size_t at = 0; at < mask.inside.size(); ++at) {
      if (mask.inside[at] != 1) continue;
      const Eigen::Vector3d position = mask.Position(volume, at);
      const double beside = std::abs(position.x() - middle);
      if (position.y() < back) continue;
      if (!nearest_known) nearest = std::min(nearest, beside);
      if (nearest_known && beside <= nearest + kHead) sum += position.z(), ++count;
    }
  }
  return sum / count;
}

// Returns x of the midsagittal plane [mm]: the mean of the vertebrae, else of the ribs.
double Middle(const LabelVolume& volume, const std::vector<Part>& parts, const std::vector<Mask>& ribs) {
  double sum = 0, count = 0;
  for (const Part& part : parts) {
    if (part.Is(v1::STRUCTURE_VERTEBRA)) sum += Centroid(volume, part.mask).x(), ++count;
  }
  if (count > 0) return sum / count;
  for (const Mask& rib : ribs) sum += Centroid(volume, rib).x(), ++count;
  return count > 0 ? sum / count : 0;
}

bool HasRibs(const std::vector<Part>& parts, v1::Side side) {
  return std::any_of(parts.begin(), parts.end(),
                     [side](const Part& part) { return part.Is(v1::STRUCTURE_RIB) && part.anatomy.side() == side; });
}

void AddNumberedRibs(const LabelVolume& volume, const std::vector<Mask>& ribs, std::vector<Part>& parts,
                     Fallbacks& fallbacks) {
  const double middle = Middle(volume, parts, ribs);
  for (const auto side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    if (HasRibs(parts, side)) {
      fallbacks.push_back({absl::StrCat("ribs on the ", SideWord(side),
                                        ": a label of ribs without a number was left out, because others have numbers"),
                           v1::ASSUMPTION_KIND_RIBS_LEFT_OUT,
                           {SideWord(side)}});
      continue;
    }
    std::vector<std::pair<double, const Mask*>> found;
    for (const Mask& rib : ribs) {
      const bool left = Centroid(volume, rib).x() > middle;
      if (left == (side == v1::SIDE_LEFT)) found.emplace_back(-HeadHeight(volume, rib, middle), &rib);
    }
    std::sort(found.begin(), found.end());
    found.resize(std::min<std::size_t>(found.size(), 12));
    for (std::size_t r = 0; r < found.size(); ++r) {
      Part& part = parts.emplace_back();
      part.anatomy.set_structure(v1::STRUCTURE_RIB);
      part.anatomy.set_number(static_cast<int>(r) + 1);
      part.anatomy.set_side(side);
      part.mask = *found[r].second;
      part.label_voxels = part.mask.Count();
      part.name = NameOf("", part.anatomy);
    }
    fallbacks.push_back({absl::StrFormat("ribs on the %s: one label, divided into %d and numbered from the top%s",
                                         SideWord(side), found.size(), found.size() == 12 ? "" : "; 12 are expected"),
                         v1::ASSUMPTION_KIND_RIBS_DIVIDED,
                         {SideWord(side)},
                         {static_cast<double>(found.size())}});
  }
}

// Divides a label into ribs. Tries the components of the label closed by one voxel, of the label itself, and of the
// label with 6-connectivity (for ribs that touch). Returns the first division with 24 components, else the closest.
std::vector<Mask> RibsOf(const LabelVolume& volume, const Mask& label, int margin) {
  constexpr int kExpectedRibs = 24;
  std::vector<Mask> best;
  const auto off = [](const std::vector<Mask>& ribs) {
    return std::abs(static_cast<int>(ribs.size()) - kExpectedRibs);
  };
  for (const auto& [reach, connectivity] :
       {std::pair(1, Connectivity::kCorners), {0, Connectivity::kCorners}, {0, Connectivity::kFaces}}) {
    Mask mask = label;
    Close(mask, reach);
    std::vector<Mask> pieces = ConnectedComponents(mask, margin, connectivity);
    std::erase_if(pieces, [&](const Mask& p) { return p.Count() * VoxelVolume(volume) < kSmallestPiece; });
    if (best.empty() || off(pieces) < off(best)) best = std::move(pieces);
    if (off(best) == 0) break;
  }
  for (Mask& rib : best) {
    Close(rib, 1);
    FillCavities(rib);
  }
  return best;
}

// Returns the largest component's share of all voxels.
double LargestShare(const std::vector<Mask>& pieces) {
  std::size_t all = 0;
  for (const Mask& piece : pieces) all += piece.Count();
  return static_cast<double>(pieces.front().Count()) / static_cast<double>(all);
}

// Adds a label as one part: the largest component after closing by one voxel, or by up to three until it is connected.
void AddWhole(const LabelVolume& volume, const v1::LabelMeaning& label, const Extent& extent, std::vector<Part>& parts,
              Fallbacks& fallbacks) {
  constexpr int kFurthest = 3;
  const int margin = SurfaceMargin(volume);
  std::vector<Mask> pieces;
  int reach = 0;
  do {
    Mask mask = ExtractMask(volume, static_cast<Label>(label.number()), extent, margin);
    Close(mask, ++reach);
    FillCavities(mask);
    pieces = ConnectedComponents(mask, margin);
  } while (LargestShare(pieces) < kWhole && reach < kFurthest);
  const std::string name = NameOf(label.name(), label.anatomy());
  parts.push_back({name, label.anatomy(), label.organ(), std::move(pieces.front()), extent.voxels});
  if (reach > 1) {
    fallbacks.push_back({absl::StrFormat("%s: label %d had gaps; gaps of up to %d voxels were closed and the largest "
                                         "component was used",
                                         name, label.number(), 2 * reach),
                         v1::ASSUMPTION_KIND_GAPS_CLOSED,
                         {name},
                         {static_cast<double>(label.number()), 2.0 * reach}});
  }
}

}  // namespace

// Bodies, and the files of their surfaces, are named after labels.
absl::Status CheckLabelName(const v1::LabelMeaning& label) {
  const std::string& name = label.name();
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == ' ';
  });
  if (plain && !name.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("label ", label.number(), ": the name \"", absl::CHexEscape(name),
                                                 "\" needs letters, digits, \"_\", \"-\" and spaces; correct the map"));
}

absl::StatusOr<std::vector<Part>> FindParts(const LabelVolume& volume, const v1::LabelMap& map, Fallbacks& fallbacks) {
  const std::map<Label, Extent> extents = Extents(volume);
  const int margin = SurfaceMargin(volume);
  std::vector<Part> parts;
  std::vector<Mask> ribs;
  for (const v1::LabelMeaning& label : map.labels()) {
    const auto extent = extents.find(static_cast<Label>(label.number()));
    if (extent == extents.end()) continue;
    if (absl::Status status = CheckLabelName(label); !status.ok()) return status;
    if (!IsMany(label.anatomy())) {
      AddWhole(volume, label, extent->second, parts, fallbacks);
      continue;
    }
    Mask mask = ExtractMask(volume, extent->first, extent->second, margin);
    if (label.anatomy().structure() == v1::STRUCTURE_RIB) {
      std::vector<Mask> found = RibsOf(volume, mask, margin);
      std::move(found.begin(), found.end(), std::back_inserter(ribs));
      continue;
    }
    Close(mask, 1);
    FillCavities(mask);
    std::vector<Mask> pieces = ConnectedComponents(mask, margin);
    std::erase_if(pieces, [&](const Mask& p) { return p.Count() * VoxelVolume(volume) < kSmallestPiece; });
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      const std::size_t voxels = pieces[p].Count();
      parts.push_back(
          {absl::StrCat("cartilage-", p + 1), label.anatomy(), v1::ORGAN_UNSPECIFIED, std::move(pieces[p]), voxels});
    }
  }
  if (!ribs.empty()) AddNumberedRibs(volume, ribs, parts, fallbacks);
  if (parts.empty()) {
    return absl::FailedPreconditionError("the volume has none of the labels in the label map; is it the right map?");
  }
  return parts;
}

}  // namespace phrenic::imaging
