#include "client/files/scene_text.h"

#include <google/protobuf/text_format.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace phrenic::client {

std::string SceneText(const v1::Scene& scene, const std::string& comment) {
  google::protobuf::TextFormat::Printer printer;
  printer.SetUseUtf8StringEscaping(true);
  std::string text;
  printer.PrintToString(scene, &text);
  const std::string head =
      comment.empty() ? "" : absl::StrCat("# ", absl::StrReplaceAll(comment, {{"\n", "\n# "}}), "\n");
  return absl::StrCat("# proto-file: proto/phrenic/v1/scene.proto\n# proto-message: phrenic.v1.Scene\n", head, text);
}

}  // namespace phrenic::client
