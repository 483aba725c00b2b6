#include "server/imaging/surfaces/surface_scene.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/imaging/patient/patient_scene.h"

namespace phrenic::imaging {
namespace {

constexpr char kSeenBody[] = "diaphragm";
constexpr double kFurthestLayer = 0.015;  // of a scanned layer from the middle surface, which is smoother [m]

// Returns the surfaces with the diaphragm's file as a derived body.
v1::Scene WithScan(const v1::Scene& surfaces) {
  v1::Scene scene = surfaces;
  for (v1::Body& body : *scene.mutable_bodies()) {
    if (body.anatomy().structure() != v1::STRUCTURE_DIAPHRAGM || !body.has_file()) continue;
    const v1::SurfaceFile file = body.file();
    *body.mutable_derived()->mutable_file() = file;
  }
  return scene;
}

// Gives a body the shape that it has among the surfaces.
void KeepShape(const v1::Scene& surfaces, v1::Body& body) {
  for (const v1::Body& from : surfaces.bodies()) {
    const bool scan = IsScannedDiaphragm(from) && body.name() == kSeenBody;
    if (!scan && (from.name() != body.name() || IsScannedDiaphragm(from))) continue;
    if (from.has_file()) *body.mutable_file() = from.file();
    if (from.has_generated()) *body.mutable_generated() = from.generated();
    if (from.has_derived()) *body.mutable_derived() = from.derived();
    if (from.has_offset()) *body.mutable_offset() = from.offset();
    if (from.has_scale()) *body.mutable_scale() = from.scale();
    return;
  }
  body.mutable_derived();
}

// Returns the bodies of the scene: the seen diaphragm, its middle surface, the cage, and the rest.
std::vector<PatientBody> BodiesOf(std::vector<PatientBody> surfaces, const DerivedThorax& thorax) {
  const v1::Anatomy sheet = surfaces.back().anatomy;
  surfaces.pop_back();
  v1::Anatomy cage;
  cage.set_structure(v1::STRUCTURE_INNER_CAGE);
  std::vector<PatientBody> bodies = {{kSeenBody, sheet, thorax.diaphragm.mesh},
                                     {kMiddleBody, sheet, thorax.diaphragm.middle},
                                     {kWallBody, cage, thorax.cage}};
  std::ranges::move(surfaces, std::back_inserter(bodies));
  return bodies;
}

}  // namespace

absl::StatusOr<SurfaceScene> MakeSurfaceScene(const BodySource& source, const v1::Scene& surfaces,
                                              const v1::Scene& pattern, const std::string& name) {
  const v1::Scene scanned = WithScan(surfaces);
  absl::StatusOr<std::vector<PatientBody>> read = ReadSurfaces(source, scanned);
  if (!read.ok()) return read.status();
  if (read->empty() || read->back().anatomy.structure() != v1::STRUCTURE_DIAPHRAGM) {
    return absl::InvalidArgumentError("no body with anatomy STRUCTURE_DIAPHRAGM has a file");
  }
  absl::StatusOr<DerivedThorax> thorax = DeriveThorax(*read, DiaphragmOptions().middle_edge_length);
  if (!thorax.ok()) return thorax.status();
  SurfaceScene made;
  made.scene = PatientScene(pattern, BodiesOf(*std::move(read), *thorax), thorax->frame, name);
  made.scene.set_title(absl::StrCat("Thorax of ", name, ", from surface files"));
  made.scene.set_description("Made by `phrenic patient` from surface files, which it names.");
  for (v1::Body& body : *made.scene.mutable_bodies()) KeepShape(scanned, body);
  for (v1::Motion& motion : *made.scene.mutable_motions()) {
    if (motion.skin().mode() == v1::SKIN_MODE_SHEET) motion.mutable_skin()->set_thickness(kFurthestLayer);
  }
  made.fallbacks = std::move(thorax->fallbacks);
  return made;
}

}  // namespace phrenic::imaging
