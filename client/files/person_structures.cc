#include "client/files/person_structures.h"

#include <algorithm>
#include <array>

#include "absl/strings/str_cat.h"
#include "client/files/whole_file.h"
#include "server/fit/surface_residuals.h"
#include "server/imaging/label_file.h"
#include "server/imaging/label_surface.h"
#include "server/imaging/labels/label_map.h"

namespace phrenic::client {
namespace {

constexpr std::array<const char*, 3> kStructures = {"lung-right", "lung-left", "diaphragm"};
constexpr double kLungEdge = 6;  // [mm] of the triangles of a labelled lung

// Returns the volume with 1 in the right lung, 2 in the left one, and 0 elsewhere.
imaging::LabelVolume LungsAlone(imaging::LabelVolume volume, const v1::LabelMap& map) {
  std::array<imaging::Label, 65536> side = {};
  for (const v1::LabelMeaning& label : map.labels()) {
    if (label.anatomy().structure() != v1::STRUCTURE_LUNG || label.number() < 1 || label.number() > 65535) continue;
    side[static_cast<size_t>(label.number())] = label.anatomy().side() == v1::SIDE_LEFT ? 2 : 1;
  }
  for (imaging::Label& label : volume.labels) label = side[label];
  return volume;
}

}  // namespace

absl::Status CheckStructure(const std::string& text) {
  const size_t at = text.find('=');
  const std::string name = text.substr(0, at);
  const bool known = std::find(kStructures.begin(), kStructures.end(), name) != kStructures.end();
  if (at != std::string::npos && known) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("\"", text, "\" is not NAME=FILE with a name of lung-right, lung-left, diaphragm"));
}

absl::StatusOr<std::vector<fit::PersonStructure>> ReadStructures(const std::vector<std::string>& texts) {
  std::vector<fit::PersonStructure> structures;
  for (const std::string& text : texts) {
    if (absl::Status status = CheckStructure(text); !status.ok()) return status;
    const size_t at = text.find('=');
    const std::string name = text.substr(0, at), file = text.substr(at + 1);
    for (const fit::PersonStructure& other : structures) {
      if (other.name == name) return absl::InvalidArgumentError(absl::StrCat(name, ": two files were given"));
    }
    const absl::StatusOr<std::string> bytes = ReadWhole(file, "the surface of " + name);
    if (!bytes.ok()) return bytes.status();
    absl::StatusOr<Mesh> surface = fit::ParseBreathSurface(file, *bytes);
    if (!surface.ok()) return surface.status();
    structures.push_back({name, file, *std::move(surface)});
  }
  return structures;
}

absl::StatusOr<std::vector<fit::PersonStructure>> ReadLabelledLungs(const std::string& volume, const std::string& map) {
  absl::StatusOr<imaging::LabelVolume> labels = imaging::ReadLabels(volume);
  if (!labels.ok()) return labels.status();
  const absl::StatusOr<v1::LabelMap> meanings = imaging::ReadLabelMap(map);
  if (!meanings.ok()) return meanings.status();
  std::vector<std::string> remarks;
  const v1::LabelMap resolved = imaging::Resolve(*meanings, *labels, remarks);
  const imaging::LabelVolume lungs = LungsAlone(*std::move(labels), resolved);
  const std::map<imaging::Label, imaging::Extent> extents = imaging::Extents(lungs);
  std::vector<fit::PersonStructure> structures;
  for (const imaging::Label side : {imaging::Label{1}, imaging::Label{2}}) {
    const char* name = kStructures[side - 1U];
    const auto extent = extents.find(side);
    if (extent == extents.end()) {
      return absl::InvalidArgumentError(
          absl::StrCat(volume, ": no label of ", name, ": check --labels, the map of the volume's numbers"));
    }
    imaging::Mask mask = imaging::ExtractMask(lungs, side, extent->second, imaging::SurfaceMargin(lungs) + 1);
    imaging::Close(mask, 1);
    imaging::FillCavities(mask);
    const std::vector<imaging::Mask> parts = imaging::ConnectedComponents(mask, imaging::SurfaceMargin(lungs));
    absl::StatusOr<Mesh> surface = imaging::SurfaceOf(lungs, parts.empty() ? mask : parts.front(), kLungEdge);
    if (!surface.ok()) {
      return absl::Status(surface.status().code(), absl::StrCat(volume, ": ", name, ": ", surface.status().message()));
    }
    structures.push_back({name, volume, *std::move(surface)});
  }
  return structures;
}

}  // namespace phrenic::client
