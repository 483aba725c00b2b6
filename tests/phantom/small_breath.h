// The generated thorax with coarse bodies, at rest and at the peak of a deep breath, for all tests of a suite.
#ifndef PHRENIC_TESTS_PHANTOM_SMALL_BREATH_H_
#define PHRENIC_TESTS_PHANTOM_SMALL_BREATH_H_

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "server/mechanics/step/step.h"
#include "server/phantom/breathing_phantom.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic::phantom {

inline absl::Status Go() { return absl::OkStatus(); }

class SmallBreath : public testing::Test {
 protected:
  static constexpr double kSpacing = 4;  // [mm]

  static void SetUpTestSuite() {
    model_ = CompileShipped("thorax", 12);
    v1::Parameters parameters = model_->parameters;
    parameters.MergeFrom(*FindPreset(model_->scene, "deep"));
    State state = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    states_ = {state};
    while (state.time < 3) ASSERT_TRUE(Step(*model_, parameters, parameters.time_step(), state, work).ok());
    states_.push_back(state);
    phantom_.emplace(*BreathingPhantom::Make(*model_, states_, {kSpacing, true, true}));
    rest_ = *phantom_->Render(0, Go);
    peak_ = *phantom_->Render(1, Go);
  }
  static void TearDownTestSuite() {
    phantom_.reset();
    model_.reset();
  }

  static const std::vector<Structure>& All() { return phantom_->structures().all; }

  inline static std::shared_ptr<const Model> model_;
  inline static std::vector<State> states_;
  inline static std::optional<BreathingPhantom> phantom_;
  inline static PhantomPhase rest_, peak_;
};

}  // namespace phrenic::phantom

#endif  // PHRENIC_TESTS_PHANTOM_SMALL_BREATH_H_
