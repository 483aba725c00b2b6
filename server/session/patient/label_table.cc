#include "server/session/patient/label_table.h"

#include <google/protobuf/stubs/common.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/mask.h"

namespace phrenic::session {
namespace {

using imaging::Extent;
using imaging::LabelVolume;

constexpr std::size_t kMostLabels = 1000;
constexpr std::size_t kLongestLabelName = 64;  // [bytes]
constexpr int kPairsOfRibs = 12, kFirstPairNotExpected = 11;
constexpr int kVertebrae = 17;  // T1 to L5

// Returns a name of a file as protobuf sends text: valid UTF-8, cut to the longest length.
std::string Sendable(std::string name) {
  if (!google::protobuf::internal::IsStructurallyValidUTF8(name)) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !absl::ascii_isascii(c); }, '?');
  }
  if (name.size() <= kLongestLabelName) return name;
  std::size_t end = kLongestLabelName;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) --end;
  return name.substr(0, end);
}

v1::Vector ToProto(const Eigen::Vector3d& at) {
  v1::Vector vector;
  vector.set_x(at.x());
  vector.set_y(at.y());
  vector.set_z(at.z());
  return vector;
}

bool IsAtBorder(const LabelVolume& volume, const Extent& extent) {
  return (extent.low.array() == 0).any() || (extent.high.array() == volume.size.array() - 1).any();
}

void DescribeFrame(const LabelVolume& volume, const std::map<imaging::Label, Extent>& extents,
                   v1::InspectLabelsResponse& table) {
  table.mutable_voxels()->set_i(volume.size.x());
  table.mutable_voxels()->set_j(volume.size.y());
  table.mutable_voxels()->set_k(volume.size.z());
  *table.mutable_spacing_mm() = ToProto(volume.Spacing());
  Eigen::AlignedBox3d box;
  for (const auto& [number, extent] : extents) {
    const Eigen::AlignedBox3d voxels(extent.low.cast<double>(), extent.high.cast<double>());
    for (int corner = 0; corner < 8; ++corner) {
      box.extend(volume.to_patient * voxels.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    }
  }
  if (box.isEmpty()) return;
  *table.mutable_low_mm() = ToProto(box.min());
  *table.mutable_high_mm() = ToProto(box.max());
}

// What the proposed meanings of a table show of a thorax.
class Shown {
 public:
  explicit Shown(const v1::InspectLabelsResponse& table) {
    for (const v1::FoundLabel& label : table.labels()) {
      if (!label.has_proposed()) continue;
      organs_.insert(label.proposed().organ());
      const v1::Anatomy& anatomy = label.proposed().anatomy();
      structures_.insert(anatomy.structure());
      sides_.emplace(anatomy.structure(), anatomy.side());
      if (anatomy.structure() == v1::STRUCTURE_RIB) ribs_.emplace(anatomy.side(), anatomy.number());
    }
  }
  bool Has(v1::Structure structure) const { return structures_.contains(structure); }
  bool Has(v1::Structure structure, v1::Side side) const { return sides_.contains({structure, side}); }
  bool Has(v1::Organ organ) const { return organs_.contains(organ); }
  // True if all ribs have one label.
  bool HasRibsInOne() const { return ribs_.contains({v1::SIDE_UNSPECIFIED, 0}); }
  bool HasRib(v1::Side side, int number) const { return ribs_.contains({side, number}); }
  bool HasRibs() const { return !ribs_.empty(); }

 private:
  std::set<v1::Organ> organs_;
  std::set<v1::Structure> structures_;
  std::set<std::pair<v1::Structure, v1::Side>> sides_;
  std::set<std::pair<v1::Side, int>> ribs_;
};

v1::MissingStructure& AddMissing(v1::Structure structure, bool needed, v1::InspectLabelsResponse& table) {
  v1::MissingStructure& missing = *table.add_missing();
  missing.set_structure(structure);
  missing.set_needed(needed);
  return missing;
}

void AddMissingRibs(const Shown& shown, v1::InspectLabelsResponse& table) {
  if (!shown.HasRibs()) AddMissing(v1::STRUCTURE_RIB, true, table);
  if (!shown.HasRibs() || shown.HasRibsInOne()) return;
  for (const v1::Side side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    v1::MissingStructure ribs;
    for (int number = 1; number <= kPairsOfRibs; ++number) {
      if (number < kFirstPairNotExpected && !shown.HasRib(side, number)) ribs.add_numbers(number);
    }
    if (ribs.numbers().empty()) continue;
    ribs.set_structure(v1::STRUCTURE_RIB);
    ribs.set_side(side);
    *table.add_missing() = ribs;
  }
}

void AddAllMissing(v1::InspectLabelsResponse& table) {
  const Shown shown(table);
  for (const v1::Side side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    const bool needed = !shown.Has(v1::STRUCTURE_LUNG);
    if (!shown.Has(v1::STRUCTURE_LUNG, side)) AddMissing(v1::STRUCTURE_LUNG, needed, table).set_side(side);
  }
  AddMissingRibs(shown, table);
  if (!shown.Has(v1::STRUCTURE_VERTEBRA)) AddMissing(v1::STRUCTURE_VERTEBRA, true, table);
  if (!shown.Has(v1::STRUCTURE_STERNUM_BODY)) AddMissing(v1::STRUCTURE_STERNUM_BODY, false, table);
  if (shown.Has(v1::STRUCTURE_DIAPHRAGM)) return;  // the organs beside it are its evidence otherwise
  for (const v1::Organ organ : {v1::ORGAN_HEART, v1::ORGAN_LIVER, v1::ORGAN_STOMACH, v1::ORGAN_SPLEEN}) {
    if (!shown.Has(organ)) table.add_missing()->set_organ(organ);
  }
}

void AddTools(const imaging::LabelInput& input, v1::InspectLabelsResponse& table) {
  table.set_map(input.tool);
  for (const imaging::MapFit& fit : input.tools) {
    v1::LabelTool& tool = *table.add_tools();
    tool.set_name(fit.name);
    tool.set_title(fit.map.tool());
    tool.set_agree(fit.agree);
    tool.set_differ(fit.differ);
  }
}

// True for what the making of a patient knows: a rib has a side and a number, or neither; a vertebra has a number.
bool IsKnownAnatomy(const v1::Anatomy& anatomy) {
  const bool sided = anatomy.side() != v1::SIDE_UNSPECIFIED;
  switch (anatomy.structure()) {
    case v1::STRUCTURE_RIB:
      return sided ? anatomy.number() >= 1 && anatomy.number() <= kPairsOfRibs : anatomy.number() == 0;
    case v1::STRUCTURE_VERTEBRA:
      return anatomy.number() >= 1 && anatomy.number() <= kVertebrae;
    case v1::STRUCTURE_LUNG:
      return sided;
    case v1::STRUCTURE_MANUBRIUM:
    case v1::STRUCTURE_STERNUM_BODY:
    case v1::STRUCTURE_XIPHOID:
    case v1::STRUCTURE_COSTAL_CARTILAGE:
    case v1::STRUCTURE_DIAPHRAGM:
      return true;
    default:
      return false;
  }
}

absl::Status CheckMeaning(const v1::LabelMeaning& label, int at) {
  const auto wrong = [at](const std::string& problem) {
    return absl::InvalidArgumentError(absl::StrCat("labels[", at, "]: ", problem));
  };
  const bool named = std::all_of(label.name().begin(), label.name().end(), [](char c) {
    return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == ' ';
  });
  if (label.name().empty() || label.name().size() > kLongestLabelName || !named) {
    return wrong("the name needs 1 to 64 letters, digits, \"_\", \"-\" and spaces");
  }
  const bool organ = label.organ() != v1::ORGAN_UNSPECIFIED;
  if (organ || IsKnownAnatomy(label.anatomy())) return absl::OkStatus();
  return wrong(
      "say which organ it is, or which lung, rib, vertebra, part of the sternum, cartilage or diaphragm, with the side "
      "and the number of a rib");
}

}  // namespace

absl::StatusOr<v1::InspectLabelsResponse> DescribeLabels(const imaging::LabelInput& input, const v1::LabelMap& names) {
  const LabelVolume& volume = input.volume;
  const std::map<imaging::Label, Extent> extents = imaging::Extents(volume);
  if (extents.size() > kMostLabels) {
    return absl::InvalidArgumentError(absl::StrCat("it has ", extents.size(), " values, and ", kMostLabels,
                                                   " labels are the most; is it an image? Give its segmentation"));
  }
  v1::InspectLabelsResponse table;
  std::map<int, v1::LabelMeaning> proposed;
  for (const v1::LabelMeaning& label : input.meanings.labels()) proposed.emplace(label.number(), label);
  const double voxel_ml = std::abs(volume.to_patient.linear().determinant()) / 1000;
  for (const auto& [number, extent] : extents) {
    v1::FoundLabel& label = *table.add_labels();
    label.set_number(number);
    if (const auto name = volume.names.find(number); name != volume.names.end()) label.set_name(Sendable(name->second));
    label.set_volume_ml(voxel_ml * static_cast<double>(extent.voxels));
    label.set_at_border(IsAtBorder(volume, extent));
    if (const auto known = proposed.find(number); known != proposed.end()) *label.mutable_proposed() = known->second;
  }
  DescribeFrame(volume, extents, table);
  AddAllMissing(table);
  for (const std::string& remark : volume.remarks) table.add_remarks(Sendable(remark));
  *table.mutable_choices() = names.labels();
  AddTools(input, table);
  return table;
}

absl::StatusOr<v1::LabelMap> ApplyLabels(const google::protobuf::RepeatedPtrField<v1::LabelMeaning>& labels,
                                         LabelVolume& volume) {
  v1::LabelMap map;
  std::set<int> named;
  for (int l = 0; l < labels.size(); ++l) {
    const v1::LabelMeaning& label = labels[l];
    if (absl::Status status = CheckMeaning(label, l); !status.ok()) return status;
    if (!named.insert(label.number()).second) {
      return absl::InvalidArgumentError(absl::StrCat("labels[", l, "]: label ", label.number(), " is named twice"));
    }
    *map.add_labels() = label;
  }
  volume.names.clear();
  volume.meanings.clear();
  return imaging::UniteLabels(map, volume);
}

}  // namespace phrenic::session
