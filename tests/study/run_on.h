// Studies of scenes written in tests.
#ifndef PHRENIC_TESTS_STUDY_RUN_ON_H_
#define PHRENIC_TESTS_STUDY_RUN_ON_H_

#include <string>

#include "server/study/run.h"
#include "tests/compile_text.h"

namespace phrenic::study {

inline const Progress kNobody = [](double, std::string_view) { return true; };

inline Subject SubjectOf(const std::string& text) {
  auto model = CompileText(text);
  return {.model = model, .parameters = model->parameters};
}

inline absl::StatusOr<v1::StudyResult> RunOn(const std::string& text, v1::CreateStudyRequest request,
                                             const Progress& progress = kNobody) {
  request.mutable_source()->mutable_scene()->CopyFrom(*schema::ParseScene("test", text));
  const Compiler compile = [](const v1::SceneSource& source) {
    return Compile(source.scene(), [](const v1::Body&) { return absl::NotFoundError("no files"); });
  };
  return Run(request, compile, progress);
}

}  // namespace phrenic::study

#endif  // PHRENIC_TESTS_STUDY_RUN_ON_H_
