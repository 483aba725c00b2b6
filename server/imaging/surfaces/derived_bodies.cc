#include "server/imaging/surfaces/derived_bodies.h"

#include <memory>
#include <optional>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::imaging {
namespace {

// Returns the edge length of the scene's middle surface [mm].
double EdgeLengthOf(const v1::Scene& scene) {
  for (const v1::Body& body : scene.bodies()) {
    if (body.has_derived() && body.anatomy().structure() == v1::STRUCTURE_DIAPHRAGM && !IsScannedDiaphragm(body)) {
      if (body.derived().has_resolution_mm()) return body.derived().resolution_mm();
    }
  }
  return DiaphragmOptions().middle_edge_length;
}

// The derived meshes of one scene, made when the first is asked for.
class DerivedScene {
 public:
  DerivedScene(BodySource source, v1::Scene scene, GoOn go_on)
      : source_(std::move(source)), scene_(std::move(scene)), go_on_(std::move(go_on)) {}

  absl::StatusOr<Mesh> Get(const v1::Body& body) ABSL_LOCKS_EXCLUDED(mutex_) {
    if (!body.has_derived()) return source_(body);
    const v1::Structure structure = body.anatomy().structure();
    if (structure != v1::STRUCTURE_INNER_CAGE && structure != v1::STRUCTURE_DIAPHRAGM) {
      return absl::InvalidArgumentError("derived: only an inner cage and a diaphragm can be derived; set anatomy");
    }
    absl::MutexLock lock(&mutex_);
    if (!thorax_.has_value()) thorax_ = Derive();
    if (!thorax_->ok()) return thorax_->status();
    const DerivedDiaphragm& diaphragm = (*thorax_)->diaphragm;
    Mesh mesh = IsScannedDiaphragm(body) ? diaphragm.mesh : diaphragm.middle;
    if (structure == v1::STRUCTURE_INNER_CAGE) mesh = (*thorax_)->cage;
    TakeBack(body, mesh);
    return mesh;
  }

 private:
  absl::StatusOr<DerivedThorax> Derive() const {
    const absl::StatusOr<std::vector<PatientBody>> surfaces = ReadSurfaces(source_, scene_);
    if (!surfaces.ok()) return surfaces.status();
    return DeriveThorax(*surfaces, EdgeLengthOf(scene_), go_on_);
  }

  const BodySource source_;
  const v1::Scene scene_;
  const GoOn go_on_;
  absl::Mutex mutex_;
  std::optional<absl::StatusOr<DerivedThorax>> thorax_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace

BodySource WithDerived(BodySource source, v1::Scene scene, GoOn go_on) {
  return [derived = std::make_shared<DerivedScene>(std::move(source), std::move(scene), std::move(go_on))](
             const v1::Body& body) { return derived->Get(body); };
}

}  // namespace phrenic::imaging
