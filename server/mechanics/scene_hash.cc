#include "server/mechanics/scene_hash.h"

#include <openssl/evp.h>

#include <memory>

#include "absl/strings/escaping.h"
#include "absl/strings/string_view.h"

namespace phrenic {

std::string SceneHash(const Model& model) {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
  const std::string scene = model.scene.SerializeAsString();
  EVP_DigestUpdate(context.get(), scene.data(), scene.size());
  for (const BodyModel& body : model.bodies) {
    const Mesh& mesh = body.mesh;
    EVP_DigestUpdate(context.get(), mesh.vertices.data(), sizeof(double) * static_cast<size_t>(mesh.vertices.size()));
    EVP_DigestUpdate(context.get(), mesh.triangles.data(), sizeof(int) * static_cast<size_t>(mesh.triangles.size()));
    EVP_DigestUpdate(context.get(), mesh.edges.data(), sizeof(int) * static_cast<size_t>(mesh.edges.size()));
  }
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  EVP_DigestFinal_ex(context.get(), digest, &size);
  return absl::BytesToHexString(absl::string_view(reinterpret_cast<const char*>(digest), size));
}

}  // namespace phrenic
