// Reads the scenes of server/scenes.
#ifndef PHRENIC_TESTS_THESIS_SHIPPED_H_
#define PHRENIC_TESTS_THESIS_SHIPPED_H_

#include <fstream>
#include <sstream>
#include <string>

namespace phrenic {

// Returns the text of the scene `name`; empty if there is no such file.
inline std::string ShippedScene(const std::string& name) {
  std::ifstream file(std::string(PHRENIC_SOURCE_DIR) + "/server/scenes/" + name + ".textproto");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_THESIS_SHIPPED_H_
