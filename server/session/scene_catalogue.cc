#include "server/session/scene_catalogue.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "absl/strings/str_cat.h"
#include "server/schema/names.h"
#include "server/schema/schema.h"

namespace phrenic::session {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestScene = 64 << 20;  // [bytes]

// Returns name -> file; of two files with the same name, the first folder's.
std::map<std::string, fs::path> Files(const std::vector<std::string>& folders) {
  std::map<std::string, fs::path> files;
  for (const std::string& folder : folders) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      const fs::path& path = entry.path();
      if (path.extension() == ".textproto") files.emplace(path.stem().string(), path);
    }
  }
  return files;
}

absl::StatusOr<v1::Scene> Read(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error || size > kLargestScene) {
    return absl::InvalidArgumentError(absl::StrCat(path.string(), ": not a file of at most ", kLargestScene, " bytes"));
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) return absl::PermissionDeniedError(absl::StrCat(path.string(), ": cannot be read"));
  return schema::ParseScene(path.filename().string(), text.str());
}

}  // namespace

std::vector<v1::SceneSummary> SceneCatalogue::List() const {
  std::vector<v1::SceneSummary> scenes;
  for (const auto& [name, path] : Files(folders_)) {
    v1::SceneSummary& summary = scenes.emplace_back();
    summary.set_name(name);
    const absl::StatusOr<v1::Scene> scene = Read(path);
    if (scene.ok()) {
      summary.set_title(scene->title());
      summary.set_description(scene->description());
      for (const v1::Preset& preset : scene->presets()) summary.add_presets(preset.name());
    } else {
      summary.set_title(absl::StrCat(name, " (cannot be read)"));
      summary.set_description(std::string(scene.status().message()));
    }
  }
  return scenes;
}

absl::StatusOr<v1::Scene> SceneCatalogue::Find(const std::string& name) const {
  const auto files = Files(folders_);
  const auto found = files.find(name);
  if (found != files.end()) return Read(found->second);
  return absl::NotFoundError(
      absl::StrCat("source.name: there is no scene \"", name, "\"", schema::ThereAre(name, Names())));
}

std::vector<std::string> SceneCatalogue::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, path] : Files(folders_)) names.push_back(name);
  return names;
}

}  // namespace phrenic::session
