// One setting of a program and its origin. Plain data.
#ifndef PHRENIC_SERVER_SETTINGS_SETTING_H_
#define PHRENIC_SERVER_SETTINGS_SETTING_H_

#include <string>

namespace phrenic::settings {

struct Setting {
  std::string name, value;
  std::string origin;  // "--server", "PHRENIC_SERVER", the file's path, "default"
};

}  // namespace phrenic::settings

#endif  // PHRENIC_SERVER_SETTINGS_SETTING_H_
