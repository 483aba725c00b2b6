// A model with a generalised coordinate that is no vertex, as later elements have them.
#ifndef PHRENIC_TESTS_SCALAR_MOTION_H_
#define PHRENIC_TESTS_SCALAR_MOTION_H_

#include <cmath>
#include <memory>

#include "server/mechanics/model_builder.h"
#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic {

// Drives coordinate `index` of State::scalars: q = sin t, with its rate.
class ScalarMotion final : public Motion {
 public:
  explicit ScalarMotion(int index) : Motion("swing"), index_(index) {}
  void Drive(const EvalContext& at, State& state) const override {
    state.scalars.q[index_] = std::sin(at.time);
    state.scalars.v[index_] = std::cos(at.time);
  }

 private:
  const int index_;
};

// The scene `text` with two coordinates: "angle" [rad], which a motion drives, and "volume" [m^3], which keeps its
// initial value 0.5 and rate -0.25.
inline std::shared_ptr<const Model> CompileWithScalars(const std::string& text) {
  const std::shared_ptr<Model> model = std::const_pointer_cast<Model>(CompileText(text));
  ModelBuilder builder;
  model->motions.push_back(std::make_unique<ScalarMotion>(builder.AddScalar("angle", "rad", 0)));
  builder.AddScalar("volume", "m^3", 0.5, -0.25);
  model->scalars = builder.model.scalars;
  return model;
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_SCALAR_MOTION_H_
