// A preset as text for a scene's file.
#ifndef PHRENIC_SERVER_CALIBRATE_PRESET_TEXT_H_
#define PHRENIC_SERVER_CALIBRATE_PRESET_TEXT_H_

#include <string>

#include "phrenic/v1/scene.pb.h"

namespace phrenic::calibrate {

// Returns "presets { ... }" over several lines, the parameters on one of them, below a comment line.
std::string PresetText(const v1::Preset& preset, const std::string& comment);

}  // namespace phrenic::calibrate

#endif  // PHRENIC_SERVER_CALIBRATE_PRESET_TEXT_H_
