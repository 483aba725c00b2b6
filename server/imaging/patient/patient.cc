#include "server/imaging/patient/patient.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "server/imaging/label_surface.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/patient/patient_scene.h"
#include "server/imaging/patient/readiness.h"
#include "server/imaging/patient/template_parts.h"
#include "server/imaging/rib_axis.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"

namespace phrenic::imaging {
namespace {

constexpr double kDiaphragmsShare = 0.5;  // of the progress
constexpr double kLungEdges = 1.5;        // edge length of lungs, relative to bones

bool HasSurface(const Part& part) { return part.organ == v1::ORGAN_UNSPECIFIED && !part.Is(v1::STRUCTURE_DIAPHRAGM); }

absl::Status CheckParts(const FilledParts& filled) {
  const std::vector<Part>& parts = filled.parts;
  const auto has = [&parts](v1::Structure structure) {
    return std::any_of(parts.begin(), parts.end(), [&](const Part& part) { return part.Is(structure); });
  };
  if (has(v1::STRUCTURE_LUNG) && has(v1::STRUCTURE_RIB) && has(v1::STRUCTURE_VERTEBRA)) return absl::OkStatus();
  const std::string& why = filled.report.not_filled();
  return absl::FailedPreconditionError(absl::StrCat(
      "by this label map the volume has no lungs, no ribs or no vertebrae, so it cannot be made into a thorax",
      why.empty() ? "" : ", and they cannot be filled: ", why));
}

// Marks every vertex of a mesh as the template's.
void MarkAll(Mesh& mesh) {
  std::vector<int>& all = mesh.regions[kFromTemplate];
  all.resize(static_cast<std::size_t>(mesh.vertices.cols()));
  std::iota(all.begin(), all.end(), 0);
}

absl::Status AddSurfaces(const LabelVolume& volume, const std::vector<Part>& parts, const PatientOptions& options,
                         PatientProgress progress, Patient& patient, Fallbacks& fallbacks) {
  const double voxel_ml = std::abs(volume.to_patient.linear().determinant()) / 1000;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Part& part = parts[p];
    if (!HasSurface(part)) continue;
    const double done = (1 - kDiaphragmsShare) * static_cast<double>(p) / static_cast<double>(parts.size());
    if (!progress(done, part.name)) return absl::CancelledError("making the patient was cancelled");
    const double edges = part.Is(v1::STRUCTURE_LUNG) ? kLungEdges : 1;
    absl::StatusOr<Mesh> mesh = part.surface.triangles.cols() > 0
                                    ? absl::StatusOr<Mesh>(part.surface)
                                    : SurfaceOf(volume, part.mask, edges * options.edge_length);
    if (!mesh.ok()) {
      fallbacks.push_back({absl::StrCat(part.name, ": left out, ", std::string(mesh.status().message()))});
      continue;
    }
    v1::PatientSurface& surface = *patient.report.add_surfaces();
    surface.set_body(part.name);
    surface.set_vertices(static_cast<int>(mesh->vertices.cols()));
    surface.set_triangles(static_cast<int>(mesh->triangles.cols()));
    surface.set_volume_ml(1e6 * SignedVolume(mesh->vertices, mesh->triangles));
    surface.set_label_volume_ml(voxel_ml * static_cast<double>(part.label_voxels));
    surface.set_from_template(part.filled);
    if (part.filled) MarkAll(*mesh);
    patient.bodies.push_back({part.name, part.anatomy, *std::move(mesh)});
  }
  return absl::OkStatus();
}

// Returns the parts of the volume, and those filled from the template if that is wanted and the volume lacks some.
FilledParts Fill(const LabelVolume& volume, const std::vector<Part>& seen, bool wanted, Fallbacks& fallbacks) {
  if (!wanted) return {volume, seen, {}};
  FilledParts filled = FillFromTemplate(volume, seen);
  const v1::TemplateFill& report = filled.report;
  if (!report.not_filled().empty()) {
    fallbacks.push_back({absl::StrCat("nothing was filled from the template: ", report.not_filled())});
  }
  if (report.parts().empty()) return filled;
  fallbacks.push_back(
      {absl::StrFormat(
           "from the generated thorax, scaled by %.2f, %.2f and %.2f along x, y and z, %.1f mm from what is seen: %s",
           report.scale(0), report.scale(1), report.scale(2), report.residual_mm(),
           absl::StrJoin(report.parts(), ", ")),
       v1::ASSUMPTION_KIND_TEMPLATE,
       {report.parts().begin(), report.parts().end()},
       {report.scale(0), report.scale(1), report.scale(2), report.residual_mm()}});
  return filled;
}

// Adds the diaphragm, what is simulated of it, and the wall, before the others.
void AddDerived(DerivedDiaphragm diaphragm, const FittedCage& cage, Patient& patient) {
  v1::Anatomy sheet, inner_cage;
  sheet.set_structure(v1::STRUCTURE_DIAPHRAGM);
  inner_cage.set_structure(v1::STRUCTURE_INNER_CAGE);
  Mesh wall = cage.Tube();
  wall.vertices *= kMillimetre;
  std::vector<PatientBody> bodies;
  bodies.push_back({kSheetBody, sheet, std::move(diaphragm.mesh)});
  bodies.push_back({kMiddleBody, sheet, std::move(diaphragm.middle)});
  bodies.push_back({kWallBody, inner_cage, std::move(wall)});
  patient.bodies.insert(patient.bodies.begin(), std::make_move_iterator(bodies.begin()),
                        std::make_move_iterator(bodies.end()));
}

void ReportRibs(const CageFrame& frame, Patient& patient) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  for (const PatientBody& body : patient.bodies) {
    if (body.anatomy.structure() != v1::STRUCTURE_RIB) continue;
    const RibNeck neck = FindRibNeck(body.mesh, ScaleOf(frame));
    const Eigen::Vector3d axis = neck.Axis();
    v1::PatientRib& rib = *patient.report.add_ribs();
    rib.set_body(body.name);
    rib.set_neck_mm((neck.tubercle - neck.head).norm() / kMillimetre);
    rib.set_axis_degrees(kDegrees * std::atan2(std::abs(axis.x()), axis.y()));
    rib.set_drop_degrees(-kDegrees * std::asin(axis.z()));
  }
}

void ReportFallbacks(const Fallbacks& fallbacks, v1::PatientReport& report) {
  for (const Fallback& fallback : fallbacks) {
    report.add_fallbacks(fallback.text);
    v1::Assumption& assumption = *report.add_assumptions();
    assumption.set_kind(fallback.kind);
    assumption.mutable_parts()->Assign(fallback.parts.begin(), fallback.parts.end());
    assumption.mutable_values()->Assign(fallback.values.begin(), fallback.values.end());
  }
}

// INVALID_ARGUMENT if two bodies would have one name.
absl::Status CheckBodyNames(const std::vector<Part>& parts) {
  std::set<std::string> names = {kSheetBody, kMiddleBody, kWallBody};
  for (const Part& part : parts) {
    if (!HasSurface(part) || names.insert(part.name).second) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("two bodies would have the name \"", part.name,
                     "\"; give labels of one structure the same name in the map, and others names of their own"));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Patient> MakePatient(const LabelVolume& given, const v1::LabelMap& map, const v1::Scene& pattern,
                                    const PatientOptions& options, PatientProgress progress) {
  Patient patient;
  patient.report.set_name(options.name);
  std::vector<std::string> remarks = given.remarks;
  v1::LabelMap meanings = Resolve(map, given, remarks);
  Fallbacks fallbacks;
  for (std::string& remark : remarks) fallbacks.push_back({std::move(remark)});
  std::optional<LabelVolume> united;
  if (HasRepeatedNames(meanings)) meanings = UniteLabels(meanings, united.emplace(given));
  const LabelVolume& volume = united.has_value() ? *united : given;
  const absl::StatusOr<std::vector<Part>> seen = FindParts(volume, meanings, fallbacks);
  if (!seen.ok()) return seen.status();
  const FilledParts filled = Fill(volume, *seen, options.fill, fallbacks);
  *patient.report.mutable_fill() = filled.report;
  const std::vector<Part>& parts = filled.parts;
  if (absl::Status status = CheckParts(filled); !status.ok()) return status;
  if (absl::Status status = CheckBodyNames(parts); !status.ok()) return status;
  const absl::StatusOr<CageFrame> frame = FindCageFrame(filled.volume, parts, fallbacks);
  if (!frame.ok()) return frame.status();
  absl::Status status = AddSurfaces(filled.volume, parts, options, progress, patient, fallbacks);
  if (!status.ok()) return status;
  if (!progress(1 - kDiaphragmsShare, "diaphragm")) return absl::CancelledError("making the patient was cancelled");
  const FittedCage cage(filled.volume, parts, *frame, fallbacks);
  absl::StatusOr<DerivedDiaphragm> diaphragm =
      DeriveDiaphragm(filled.volume, parts, *frame, cage, options.diaphragm, fallbacks);
  if (!diaphragm.ok()) return diaphragm.status();
  *patient.report.mutable_diaphragm() = diaphragm->report;
  MarkFilled(filled, diaphragm->mesh);
  patient.report.mutable_fill()->set_diaphragm_share(MarkFilled(filled, diaphragm->middle));
  AddDerived(*std::move(diaphragm), cage, patient);
  patient.report.set_moved_left_mm(-frame->centre.x());
  for (PatientBody& body : patient.bodies) body.mesh.vertices.row(0).array() -= kMillimetre * frame->centre.x();
  ReportRibs(*frame, patient);
  *patient.report.mutable_readiness() = JudgeReadiness(volume, *seen, patient.bodies, patient.report);
  patient.scene = PatientScene(pattern, patient.bodies, *frame, options.name);
  ReportFallbacks(fallbacks, patient.report);
  return patient;
}

}  // namespace phrenic::imaging
