#include "server/imaging/labels/label_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/labels/label_words.h"
#include "server/imaging/mask.h"

namespace phrenic::imaging {
namespace {

// Volumes of a structure in adults and children, whole or cut by the border [ml].
struct VolumeRange {
  double least, most;
};

VolumeRange RangeOf(const v1::LabelMeaning& label) {
  switch (label.organ()) {
    case v1::ORGAN_HEART:
      return {15, 1500};  // also one of its chambers
    case v1::ORGAN_LIVER:
      return {200, 4500};
    case v1::ORGAN_SPLEEN:
      return {20, 1200};
    case v1::ORGAN_STOMACH:
      return {20, 3000};
    default:
      break;
  }
  switch (label.anatomy().structure()) {
    case v1::STRUCTURE_RIB:
      return {0.5, 60};
    case v1::STRUCTURE_VERTEBRA:
      return {2, 130};
    case v1::STRUCTURE_LUNG:
      return {50, 5000};
    case v1::STRUCTURE_STERNUM_BODY:
      return {5, 200};
    default:
      return {1, 600};
  }
}

// A label of a volume, as a map has it.
struct Placed {
  v1::LabelMeaning label;
  double volume_ml;
  Eigen::Vector3d centre;  // of its box, LPS [mm]
};

bool IsNumbered(const Placed& one) { return one.label.anatomy().number() > 0; }

// True if one is above the next of its kind, or right of its mirror image.
bool IsMisplaced(const Placed& one, const Placed& other) {
  const v1::Anatomy &a = one.label.anatomy(), &b = other.label.anatomy();
  if (!IsNumbered(one) || !IsNumbered(other) || a.structure() != b.structure()) return false;
  if (a.side() == b.side()) return b.number() == a.number() + 1 && one.centre.z() < other.centre.z();
  const bool pair = a.number() == b.number() && a.side() == v1::SIDE_LEFT && b.side() == v1::SIDE_RIGHT;
  return pair && one.centre.x() < other.centre.x();
}

bool Agrees(const Placed& one, const std::vector<Placed>& all) {
  const VolumeRange range = RangeOf(one.label);
  if (one.volume_ml < range.least || one.volume_ml > range.most) return false;
  return std::none_of(all.begin(), all.end(), [&one](const Placed& other) { return IsMisplaced(one, other); });
}

void Judge(const LabelVolume& volume, const std::map<Label, Extent>& extents, MapFit& fit) {
  const double voxel_ml = std::abs(volume.to_patient.linear().determinant()) / 1000;
  std::vector<Placed> all;
  for (const v1::LabelMeaning& label : fit.map.labels()) {
    const auto found = extents.find(static_cast<Label>(label.number()));
    if (found == extents.end()) continue;
    const Extent& extent = found->second;
    const Eigen::Vector3d middle = 0.5 * (extent.low + extent.high).cast<double>();
    all.push_back({label, voxel_ml * static_cast<double>(extent.voxels), volume.to_patient * middle});
  }
  fit.agree = fit.differ = 0;
  for (const Placed& one : all) ++(Agrees(one, all) ? fit.agree : fit.differ);
}

std::string WordsFor(const MapFit& fit) {
  return absl::StrFormat("%s (%d of %d labels have the size and the place of their structure)", fit.name, fit.agree,
                         fit.agree + fit.differ);
}

}  // namespace

std::vector<MapFit> RankMaps(const LabelVolume& volume, std::string_view file_name, std::vector<MapFit> maps) {
  const std::map<Label, Extent> extents = Extents(volume);
  const std::vector<std::string> listed = PlainWords(file_name);
  const std::set<std::string> words(listed.begin(), listed.end());
  for (MapFit& fit : maps) {
    Judge(volume, extents, fit);
    const auto& own = fit.map.file_words();
    fit.named = std::any_of(own.begin(), own.end(), [&words](const std::string& word) {
      const std::vector<std::string> plain = PlainWords(word);
      return std::all_of(plain.begin(), plain.end(), [&words](const std::string& w) { return words.contains(w); });
    });
  }
  std::stable_sort(maps.begin(), maps.end(), [](const MapFit& a, const MapFit& b) {
    const auto key = [](const MapFit& fit) { return std::tuple(fit.named && fit.Score() > 0, fit.Score()); };
    return key(a) > key(b);
  });
  return maps;
}

absl::StatusOr<std::vector<MapFit>> ReadMaps(const std::string& choice) {
  std::vector<MapFit> maps;
  const std::string family = choice + "-";
  for (const std::string& name : InstalledLabelMaps()) {
    if (!choice.empty() && name != choice && !absl::StartsWith(name, family)) continue;
    absl::StatusOr<v1::LabelMap> map = ReadLabelMap(name);
    if (!map.ok()) return map.status();
    maps.push_back({name, *std::move(map)});
  }
  if (!maps.empty()) return maps;
  absl::StatusOr<v1::LabelMap> map = ReadLabelMap(choice.empty() ? kNamesMap : choice);
  if (!map.ok()) return map.status();
  maps.push_back({choice, *std::move(map)});
  return maps;
}

absl::StatusOr<MapFit> ChooseMap(const LabelVolume& volume, std::string_view file_name, const std::string& choice,
                                 std::vector<std::string>& remarks) {
  absl::StatusOr<std::vector<MapFit>> maps = ReadMaps(choice);
  if (!maps.ok()) return maps.status();
  MapFit best = RankMaps(volume, file_name, *std::move(maps)).front();
  if (choice.empty()) {
    remarks.push_back(absl::StrCat("the labels have numbers and no names; they were read by the map ", WordsFor(best)));
    return best;
  }
  absl::StatusOr<std::vector<MapFit>> all = ReadMaps("");
  if (!all.ok()) return all.status();
  const MapFit other = RankMaps(volume, file_name, *std::move(all)).front();
  if (other.Score() > best.Score() && other.name != best.name) {
    remarks.push_back(absl::StrCat("the labels were read by the map ", WordsFor(best),
                                   "; their numbers fit another better: ", WordsFor(other)));
  }
  return best;
}

}  // namespace phrenic::imaging
