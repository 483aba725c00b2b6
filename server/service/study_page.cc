#include "server/service/study_page.h"

#include <google/protobuf/util/json_util.h>

#include <fstream>
#include <sstream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace phrenic::service {
namespace {

constexpr const char* kPlaceholder = "__PHRENIC_STUDY__";

}  // namespace

absl::StatusOr<std::string> StudyPage(const v1::Study& study, const std::string& web_root) {
  if (study.state() != v1::STUDY_STATE_DONE) {
    return absl::FailedPreconditionError(
        absl::StrCat("study_id: the study \"", study.id(), "\" has no page until it is done"));
  }
  std::ifstream file(web_root + "/report.html", std::ios::binary);
  std::stringstream page;
  page << file.rdbuf();
  const std::string html = page.str();
  const size_t at = html.find(kPlaceholder);
  if (!file || at == std::string::npos) {
    return absl::NotFoundError(
        absl::StrCat("there is no report.html in ", web_root, ": build the viewer (npm run build in web/)"));
  }
  std::string json;
  (void)google::protobuf::util::MessageToJsonString(study, &json);
  // Escapes "<", so that text from a scene cannot close the script element.
  json = absl::StrReplaceAll(json, {{"<", "\\u003c"}});
  return html.substr(0, at) + json + html.substr(at + std::string(kPlaceholder).size());
}

}  // namespace phrenic::service
