// The generated thorax, compiled once per test suite, and the parameters of its presets.
#ifndef PHRENIC_TESTS_PHYSIOLOGY_GENERATED_THORAX_H_
#define PHRENIC_TESTS_PHYSIOLOGY_GENERATED_THORAX_H_

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <string>

#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "server/anatomy/anatomy.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/compile/presets.h"
#include "server/physiology/recording.h"
#include "server/schema/schema.h"

namespace phrenic {

// Returns a shipped scene, for example "thorax".
inline v1::Scene ReadShipped(const std::string& name) {
  std::ifstream file(PHRENIC_SOURCE_DIR "/server/scenes/" + name + ".textproto");
  std::stringstream text;
  text << file.rdbuf();
  return *schema::ParseScene(name + ".textproto", text.str());
}

// Returns a scene compiled; generated bodies have the resolution [mm] that the function gives, their own for 0.
inline std::shared_ptr<const Model> CompileScene(const v1::Scene& scene,
                                                 const std::function<double(const v1::Body&)>& resolution_mm) {
  return *Compile(scene, [=](const v1::Body& body) {
    v1::Generated shape = body.generated();
    if (const double wanted = resolution_mm(body); wanted > 0) shape.set_resolution_mm(wanted);
    return anatomy::Generate(body.anatomy(), shape);
  });
}

// Returns a shipped scene compiled.
inline std::shared_ptr<const Model> CompileShipped(const std::string& name,
                                                   const std::function<double(const v1::Body&)>& resolution_mm) {
  return CompileScene(ReadShipped(name), resolution_mm);
}

// With one resolution for all generated bodies.
inline std::shared_ptr<const Model> CompileShipped(const std::string& name, double resolution_mm = 0) {
  return CompileShipped(name, [resolution_mm](const v1::Body&) { return resolution_mm; });
}

// Returns how far a dome has descended from rest in the column at its apex [mm].
inline double DomeDescent(const physiology::Subject& subject, const State& state, v1::Side side) {
  const auto column = side == v1::SIDE_LEFT ? physiology::Columns::kLeftApex : physiology::Columns::kRightApex;
  const auto height = [&](const Points& sheet) { return subject.columns.Heights(sheet)[column]; };
  const int sheet = subject.parts.sheet;
  return 1e3 * (height(subject.model.bodies[static_cast<size_t>(sheet)].mesh.vertices) -
                height(physiology::Placed(subject.model, state, sheet)));
}

// Records a quiet breath.
inline auto QuietBreath(const physiology::Subject& subject) {
  v1::Parameters parameters = subject.model.parameters;
  parameters.MergeFrom(*FindPreset(subject.model.scene, "quiet"));
  return physiology::Record(subject, "quiet", parameters, [](double) { return true; });
}

// The thorax with bodies of 6 mm, and a breath of a preset without a search for flaws: compiled and recorded once for
// all tests of the program.
inline const std::shared_ptr<const Model>& CoarseThorax() {
  static const std::shared_ptr<const Model> model = CompileShipped("thorax", 6);
  return model;
}

inline const std::shared_ptr<const physiology::Subject>& CoarseSubject() {
  static const std::shared_ptr<const physiology::Subject> subject = *physiology::Subject::Of(*CoarseThorax());
  return subject;
}

inline const physiology::Recording& CoarseBreath(const std::string& preset) {
  static std::map<std::string, physiology::Recording>& breaths = *new std::map<std::string, physiology::Recording>;
  const auto found = breaths.find(preset);
  if (found != breaths.end()) return found->second;
  v1::Parameters parameters = CoarseThorax()->parameters;
  parameters.MergeFrom(*FindPreset(CoarseThorax()->scene, preset));
  auto breath = physiology::Record(
      *CoarseSubject(), preset, parameters, [](double) { return true; }, physiology::FlawSearch::kNever);
  return breaths.emplace(preset, *std::move(breath)).first->second;
}

// Returns a section of the physiology page, from its heading to the next, with single spaces in place of line breaks.
inline std::string PhysiologyPage(const std::string& heading) {
  std::ifstream file(PHRENIC_SOURCE_DIR "/server/physiology/README.md");
  std::stringstream text;
  text << file.rdbuf();
  const std::string page = text.str();
  const size_t begin = page.find("\n## " + heading + "\n");
  EXPECT_NE(begin, std::string::npos) << heading;
  if (begin == std::string::npos) return "";
  const std::string section = page.substr(begin, page.find("\n## ", begin + 1) - begin);
  return absl::StrJoin(absl::StrSplit(section, absl::ByAnyChar(" \n"), absl::SkipEmpty()), " ");
}

// A fixture whose model all tests of a suite share.
class GeneratedThorax : public testing::Test {
 protected:
  static void SetUpTestSuite() { model_ = CompileShipped("thorax-thesis"); }
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
