#include "server/imaging/surfaces/derived_thorax.h"

#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/imaging/fitted_cage.h"
#include "server/imaging/surfaces/scanned_diaphragm.h"
#include "server/imaging/surfaces/voxelised_parts.h"
#include "server/mesh/units.h"
#include "server/schema/schema.h"

namespace phrenic::imaging {
namespace {

// True for what bounds the diaphragm or the cage.
bool IsBound(v1::Structure structure) {
  switch (structure) {
    case v1::STRUCTURE_RIB:
    case v1::STRUCTURE_COSTAL_CARTILAGE:
    case v1::STRUCTURE_MANUBRIUM:
    case v1::STRUCTURE_STERNUM_BODY:
    case v1::STRUCTURE_XIPHOID:
    case v1::STRUCTURE_VERTEBRA:
    case v1::STRUCTURE_LUNG:
      return true;
    default:
      return false;
  }
}

void Place(const v1::Body& body, Mesh& mesh) {
  if (body.has_scale()) {
    mesh.vertices.array().colwise() *= Eigen::Array3d(body.scale().x(), body.scale().y(), body.scale().z());
  }
  mesh.vertices.colwise() += Eigen::Vector3d(body.offset().x(), body.offset().y(), body.offset().z());
}

}  // namespace

void TakeBack(const v1::Body& body, Mesh& mesh) {
  mesh.vertices.colwise() -= Eigen::Vector3d(body.offset().x(), body.offset().y(), body.offset().z());
  if (!body.has_scale()) return;
  mesh.vertices.array().colwise() /= Eigen::Array3d(body.scale().x(), body.scale().y(), body.scale().z());
}

bool IsScannedDiaphragm(const v1::Body& body) { return body.has_derived() && body.derived().has_file(); }

absl::StatusOr<std::vector<PatientBody>> ReadSurfaces(const BodySource& source, const v1::Scene& scene) {
  std::vector<PatientBody> surfaces;
  std::optional<PatientBody> scanned;
  for (const v1::Body& body : scene.bodies()) {
    const bool diaphragm = IsScannedDiaphragm(body);
    if (!diaphragm && (!IsBound(body.anatomy().structure()) || !(body.has_file() || body.has_generated()))) continue;
    if (diaphragm && scanned.has_value()) {
      return absl::InvalidArgumentError(
          absl::StrCat("\"", scanned->name, "\" and \"", body.name(), "\" both have a file of the diaphragm"));
    }
    v1::Body read = body;
    if (diaphragm) *read.mutable_file() = v1::SurfaceFile(body.derived().file());
    schema::FillDefaults(&read);
    absl::StatusOr<Mesh> mesh = source(read);
    if (!mesh.ok()) return mesh.status();
    Place(body, *mesh);
    (diaphragm ? scanned.emplace() : surfaces.emplace_back()) = {body.name(), body.anatomy(), *std::move(mesh)};
  }
  if (scanned.has_value()) surfaces.push_back(*std::move(scanned));
  return surfaces;
}

absl::StatusOr<DerivedThorax> DeriveThorax(const std::vector<PatientBody>& surfaces, double edge_length,
                                           const GoOn& go_on) {
  const absl::StatusOr<VoxelisedParts> voxelised = VoxeliseParts(surfaces, go_on);
  if (!voxelised.ok()) return voxelised.status();
  DerivedThorax thorax;
  const auto frame = FindCageFrame(voxelised->volume, voxelised->parts, thorax.fallbacks);
  if (!frame.ok()) return frame.status();
  thorax.frame = *frame;
  if (absl::Status status = go_on(); !status.ok()) return status;
  const FittedCage cage(voxelised->volume, voxelised->parts, *frame, thorax.fallbacks);
  thorax.cage = cage.Tube();
  thorax.cage.vertices *= kMillimetre;
  if (absl::Status status = go_on(); !status.ok()) return status;
  DiaphragmOptions options;
  options.vertices = 0;
  options.middle_edge_length = edge_length;
  auto diaphragm = DeriveDiaphragm(voxelised->volume, voxelised->parts, *frame, cage, options, thorax.fallbacks);
  if (!diaphragm.ok()) return diaphragm.status();
  thorax.diaphragm = *std::move(diaphragm);
  if (surfaces.back().anatomy.structure() != v1::STRUCTURE_DIAPHRAGM) return thorax;
  if (absl::Status status = go_on(); !status.ok()) return status;
  Mesh& middle = thorax.diaphragm.middle;
  const Mesh before = FollowScan(voxelised->volume, voxelised->parts.back().mask, thorax.cage, middle);
  thorax.diaphragm.mesh = surfaces.back().mesh;
  DrawLayers(before, middle, cage, thorax.diaphragm.mesh);
  return thorax;
}

}  // namespace phrenic::imaging
