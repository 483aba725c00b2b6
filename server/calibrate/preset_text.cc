#include "server/calibrate/preset_text.h"

#include <google/protobuf/text_format.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"

namespace phrenic::calibrate {

std::string PresetText(const v1::Preset& preset, const std::string& comment) {
  google::protobuf::TextFormat::Printer printer;
  printer.SetUseUtf8StringEscaping(true);
  v1::Preset rest = preset;
  rest.clear_parameters();
  printer.SetInitialIndentLevel(1);
  std::string fields, parameters;
  printer.PrintToString(rest, &fields);
  printer.SetInitialIndentLevel(0);
  printer.SetSingleLineMode(true);
  printer.PrintToString(preset.parameters(), &parameters);
  return absl::StrCat("# ", comment, "\npresets {\n", fields, "  parameters { ",
                      absl::StripTrailingAsciiWhitespace(parameters), " }\n}\n");
}

}  // namespace phrenic::calibrate
