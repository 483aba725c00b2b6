// The scenes that a server knows: the *.textproto files of its folders.
#ifndef PHRENIC_SERVER_SESSION_SCENE_CATALOGUE_H_
#define PHRENIC_SERVER_SESSION_SCENE_CATALOGUE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/session.pb.h"

namespace phrenic::session {

// Reads the folders anew with every call, so that a scene that is edited is seen at once. Any thread may call.
class SceneCatalogue {
 public:
  // Where two folders have a scene of the same name, the first one's counts. A folder that is missing is empty.
  explicit SceneCatalogue(std::vector<std::string> folders) : folders_(std::move(folders)) {}

  // In the order of their names. A scene that cannot be read is listed with the error as its description.
  std::vector<v1::SceneSummary> List() const;
  // The scene in NAME.textproto; NOT_FOUND lists the names there are, INVALID_ARGUMENT tells file, line and column.
  absl::StatusOr<v1::Scene> Find(const std::string& name) const;
  std::vector<std::string> Names() const;

 private:
  std::vector<std::string> folders_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_SCENE_CATALOGUE_H_
