#include "server/service/study_page.h"

#include <google/protobuf/util/json_util.h>

#include <fstream>
#include <sstream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace phrenic::service {
namespace {

constexpr const char* kPlace = "__PHRENIC_STUDY__";

}  // namespace

absl::StatusOr<std::string> StudyPage(const v1::Study& study, const std::string& web_root) {
  if (study.state() != v1::STUDY_STATE_DONE) {
    return absl::FailedPreconditionError(
        absl::StrCat("study_id: the study \"", study.id(), "\" has no page before it is done"));
  }
  std::ifstream file(web_root + "/report.html", std::ios::binary);
  std::stringstream page;
  page << file.rdbuf();
  const std::string html = page.str();
  const size_t at = html.find(kPlace);
  if (!file || at == std::string::npos) {
    return absl::NotFoundError(
        absl::StrCat("there is no page for studies in ", web_root, ": build the viewer (npm run build in web/)"));
  }
  std::string json;
  (void)google::protobuf::util::MessageToJsonString(study, &json);
  // No text of a scene may end the script that it stands in.
  json = absl::StrReplaceAll(json, {{"<", "\\u003c"}});
  return html.substr(0, at) + json + html.substr(at + std::string(kPlace).size());
}

}  // namespace phrenic::service
