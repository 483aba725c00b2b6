// The generated thorax, compiled once per test suite, and the parameters of its presets.
#ifndef PHRENIC_TESTS_PHYSIOLOGY_GENERATED_THORAX_H_
#define PHRENIC_TESTS_PHYSIOLOGY_GENERATED_THORAX_H_

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "server/anatomy/anatomy.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/compile/presets.h"
#include "server/schema/schema.h"

namespace phrenic {

// Returns a shipped scene, for example "thorax", compiled.
inline std::shared_ptr<const Model> CompileShipped(const std::string& name) {
  std::ifstream file(PHRENIC_SOURCE_DIR "/server/scenes/" + name + ".textproto");
  std::stringstream text;
  text << file.rdbuf();
  return *Compile(*schema::ParseScene(name + ".textproto", text.str()), [](const v1::Body& body) {
    return anatomy::Generate(body.anatomy(), body.generated().resolution_mm(), body.generated().sheet());
  });
}

// A fixture whose model all tests of a suite share.
class GeneratedThorax : public testing::Test {
 protected:
  static void SetUpTestSuite() { model_ = CompileShipped("thorax"); }
  static void TearDownTestSuite() { model_.reset(); }

  // Returns the model's parameters with those of a preset merged in.
  static v1::Parameters With(const std::string& preset) {
    v1::Parameters parameters = model_->parameters;
    parameters.MergeFrom(*FindPreset(model_->scene, preset));
    return parameters;
  }

  inline static std::shared_ptr<const Model> model_;
};

}  // namespace phrenic

#endif  // PHRENIC_TESTS_PHYSIOLOGY_GENERATED_THORAX_H_
