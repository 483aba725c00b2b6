// Any boxes of labels in any orientation give a patient with finite surfaces, or an error. The first byte is 'n' for a
// NIfTI file, and 'r' for a CreatePatientRequest, whose names of labels give meanings with different numbers and names,
// or an error that names the field; otherwise four bytes choose the frame, and each seven bytes a box: label, corner
// and size in a grid of 32.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>

#include "absl/strings/match.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/nifti.h"
#include "server/imaging/patient/patient.h"
#include "server/schema/schema.h"
#include "server/session/patient/label_table.h"

namespace phrenic::imaging {
namespace {

constexpr int kSide = 32;
constexpr std::size_t kMostVoxels = 200'000;  // for speed

const v1::Scene& Pattern() {
  static const v1::Scene& pattern = *new v1::Scene(*schema::ParseScene("pattern", R"(name: "pattern"
    layers { name: "diaphragm" } layers { name: "ribs" } layers { name: "sternum" } layers { name: "spine" }
    bodies { name: "diaphragm" role: ROLE_DEFORMABLE mass: 3 generated {} }
    motions { ribs { bodies: "ribs" end_states { number: 5 pump_degrees: 9 bucket_degrees: 12 } } }
    forces { action_line { bodies: "diaphragm" origin { x: -0.05 } direction { z: -1 } radius: 0.08 force: 4
                           fall_off: FALL_OFF_CYLINDER } })"));
  return pattern;
}

const v1::LabelMap& Map() {
  static const v1::LabelMap& map = *new v1::LabelMap(*ReadLabelMap("totalsegmentator"));
  return map;
}

LabelVolume Boxes(const std::uint8_t* data, std::size_t size) {
  LabelVolume volume;
  volume.size.setConstant(kSide);
  volume.labels.assign(kSide * kSide * kSide, 0);
  const Eigen::Vector3d spacing(1 + data[0] % 32, 1 + data[1] % 32, 1 + data[2] % 32);
  volume.to_patient = Eigen::Affine3d(Eigen::AngleAxisd(data[3] / 64 * 1.5707963, Eigen::Vector3d::UnitX()));
  volume.to_patient.linear() *= spacing.asDiagonal();
  for (std::size_t at = 4; at + 7 <= size; at += 7) {
    const auto label = static_cast<Label>(Map().labels(data[at] % Map().labels_size()).number());
    for (int k = data[at + 3] % kSide; k < std::min(kSide, data[at + 3] % kSide + data[at + 6] % kSide); ++k) {
      for (int j = data[at + 2] % kSide; j < std::min(kSide, data[at + 2] % kSide + data[at + 5] % kSide); ++j) {
        for (int i = data[at + 1] % kSide; i < std::min(kSide, data[at + 1] % kSide + data[at + 4] % kSide); ++i) {
          volume.labels[volume.Index({i, j, k})] = label;
        }
      }
    }
  }
  return volume;
}

void Try(const LabelVolume& volume) {
  PatientOptions options;
  options.edge_length = 20;
  options.diaphragm.vertices = 500;
  const auto patient = MakePatient(volume, Map(), Pattern(), options, [](double, std::string_view) { return true; });
  if (!patient.ok()) {
    if (patient.status().message().empty()) std::abort();
    return;
  }
  for (const PatientBody& body : patient->bodies) {
    if (body.mesh.vertices.cols() == 0 || !body.mesh.vertices.allFinite()) std::abort();
  }
  if (!schema::Validate(patient->scene).ok()) std::abort();
}

void NameLabels(const std::uint8_t* data, std::size_t size) {
  v1::CreatePatientRequest request;
  if (!request.ParseFromArray(data, static_cast<int>(size)) || !schema::Validate(request).ok()) return;
  const std::uint8_t box[] = {2, 2, 2, 0, 0, 1, 1, 1, 9, 9, 9};
  LabelVolume volume = Boxes(box, sizeof box);
  const auto map = session::ApplyLabels(request.labels(), volume);
  if (!map.ok()) {
    if (!absl::StartsWith(map.status().message(), "labels[")) std::abort();
    return;
  }
  std::set<std::string> names;
  std::set<int> numbers;
  for (const v1::LabelMeaning& label : map->labels()) {
    if (!names.insert(label.name()).second || !numbers.insert(label.number()).second) std::abort();
  }
}

}  // namespace
}  // namespace phrenic::imaging

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using phrenic::imaging::Try;
  if (size < 5) return 0;
  if (data[0] == 'r') {
    phrenic::imaging::NameLabels(data + 1, size - 1);
    return 0;
  }
  if (data[0] != 'n') {
    Try(phrenic::imaging::Boxes(data, size));
    return 0;
  }
  const auto volume = phrenic::imaging::ParseNifti("fuzz", {reinterpret_cast<const char*>(data) + 1, size - 1});
  if (volume.ok() && volume->labels.size() <= phrenic::imaging::kMostVoxels) Try(*volume);
  return 0;
}
