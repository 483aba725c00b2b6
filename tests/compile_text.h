// Compiles and runs scenes that tests give as text. Such scenes read no files.
#ifndef PHRENIC_TESTS_COMPILE_TEXT_H_
#define PHRENIC_TESTS_COMPILE_TEXT_H_

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "server/mechanics/compile/compile.h"
#include "server/mechanics/step/step.h"
#include "server/schema/schema.h"

namespace phrenic {

// Returns the model, or the error of the parser or the compile step.
inline absl::StatusOr<std::shared_ptr<const Model>> TryCompileText(const std::string& text,
                                                                   const CompileOptions& options = {}) {
  absl::StatusOr<v1::Scene> scene = schema::ParseScene("test", text);
  if (!scene.ok()) return scene.status();
  return Compile(
      *scene, [](const v1::Body&) { return absl::NotFoundError("tests read no files"); }, options);
}

// Returns the model; fails the test and returns null if there is an error.
inline std::shared_ptr<const Model> CompileText(const std::string& text, const CompileOptions& options = {}) {
  auto model = TryCompileText(text, options);
  EXPECT_TRUE(model.ok()) << model.status();
  return model.ok() ? *model : nullptr;
}

// Takes steps of `dt` [s] from rest to `time` [s] and returns the state. Fails the test if a step fails.
inline State RunTo(const Model& model, double time, double dt) {
  State state = model.InitialState();
  Workspace work = model.MakeWorkspace();
  const long steps = std::lround(time / dt);
  for (long i = 0; i < steps; ++i) {
    if (Step(model, model.parameters, dt, state, work).ok()) continue;
    ADD_FAILURE() << "diverged at step " << i;
    break;
  }
  return state;
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_COMPILE_TEXT_H_
