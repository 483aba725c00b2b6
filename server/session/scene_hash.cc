#include "server/session/scene_hash.h"

#include <string_view>

#include "server/crypto/sha256.h"

namespace phrenic::session {
namespace {

template <typename Matrix>
void AddTo(Sha256& hash, const Matrix& values) {
  hash.Add(std::string_view(reinterpret_cast<const char*>(values.data()),
                            sizeof(typename Matrix::Scalar) * static_cast<size_t>(values.size())));
}

}  // namespace

std::string SceneHash(const Model& model) {
  Sha256 hash;
  hash.Add(model.scene.SerializeAsString());
  for (const BodyModel& body : model.bodies) {
    AddTo(hash, body.mesh.vertices);
    AddTo(hash, body.mesh.triangles);
    AddTo(hash, body.mesh.edges);
  }
  return hash.Hex();
}

}  // namespace phrenic::session
