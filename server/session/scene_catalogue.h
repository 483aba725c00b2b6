// The scenes that a server offers: the *.textproto files of its folders.
#ifndef PHRENIC_SERVER_SESSION_SCENE_CATALOGUE_H_
#define PHRENIC_SERVER_SESSION_SCENE_CATALOGUE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/session.pb.h"

namespace phrenic::session {

// Reads the folders at every call, so that an edited scene takes effect at once. Thread-safe. Models owns it. Files are
// protobuf text (scene.proto) of at most 64 MiB; subfolders are not read.
class SceneCatalogue {
 public:
  // If two folders have a scene of the same name, the first folder's is used. A missing folder counts as empty.
  explicit SceneCatalogue(std::vector<std::string> folders) : folders_(std::move(folders)) {}

  // Returns all scenes, sorted by name. A scene that cannot be read is listed with the error as its description. Parses
  // every file.
  std::vector<v1::SceneSummary> List() const;
  // Returns the scene in NAME.textproto. NOT_FOUND lists the names that there are; INVALID_ARGUMENT gives file, line
  // and column. INVALID_ARGUMENT also for a file that is too large, PERMISSION_DENIED for one that cannot be read.
  absl::StatusOr<v1::Scene> Find(const std::string& name) const;
  // Returns the names of all files, sorted, without reading them.
  std::vector<std::string> Names() const;

 private:
  std::vector<std::string> folders_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_SCENE_CATALOGUE_H_
