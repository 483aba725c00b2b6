// Runs studies on scenes given as text.
#ifndef PHRENIC_TESTS_STUDY_RUN_ON_H_
#define PHRENIC_TESTS_STUDY_RUN_ON_H_

#include <string>

#include "server/study/queue/run.h"
#include "tests/compile_text.h"

namespace phrenic::study {

// A Progress that never cancels.
inline const Progress kNeverCancel = [](double, std::string_view) { return true; };

// Compiles a scene that reads no files, with its own parameters.
inline Subject SubjectOf(const std::string& text) {
  auto model = CompileText(text);
  return {.model = model, .parameters = model->parameters};
}

// Runs the study of `request` on a scene that reads no files.
inline absl::StatusOr<v1::StudyResult> RunOn(const std::string& text, v1::CreateStudyRequest request,
                                             const Progress& progress = kNeverCancel) {
  request.mutable_source()->mutable_scene()->CopyFrom(*schema::ParseScene("test", text));
  const Compiler compile = [](const v1::SceneSource& source) {
    return Compile(source.scene(), [](const v1::Body&) { return absl::NotFoundError("no files"); });
  };
  return Run(request, compile, progress);
}

}  // namespace phrenic::study

#endif  // PHRENIC_TESTS_STUDY_RUN_ON_H_
