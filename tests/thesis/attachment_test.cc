// The force of the thesis' attachment is proportional to the carrier's displacement per step, so the motion of the
// tissue is proportional to the time step. An attachment by spring and damper does not depend on the time step.
#include <gtest/gtest.h>

#include "absl/strings/str_format.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// Returns the displacement of a vertex that a rib moves over half a breath [m].
double Travel(const std::string& mode, double stiffness, double dt) {
  const auto model = CompileText(absl::StrFormat(
      "name: 'stick' breath { waveform: WAVEFORM_RAISED_COSINE } "
      "bodies { name: 'rib' role: ROLE_DRIVEN anatomy { structure: STRUCTURE_RIB number: 7 side: SIDE_LEFT } "
      "polyhedron "
      "{ vertices { x: 0.02 } vertices { x: 0.12 y: -0.1 } vertices { x: 0.06 y: -0.18 z: -0.06 } } } "
      "bodies { name: 'tissue' role: ROLE_DEFORMABLE mass: 0.002 polyhedron { vertices { x: 0.06 y: -0.18 z: -0.062 } "
      "vertices { x: 0.06 y: -0.17 z: -0.15 } } } "
      "motions { ribs { bodies: 'rib' quiet_state: 1 end_states { number: 7 pump_degrees: 10 bucket_degrees: 12 } } } "
      "forces { attachment { bodies: 'tissue' anchors: 'rib' radius: 0.01 stiffness: %g mode: %s } } "
      "forces { friction { bodies: 'tissue' rate: 5 } } parameters { time_step: %g }",
      stiffness, mode, dt));
  const State state = RunTo(*model, 2, dt);
  EXPECT_EQ(state.x.col(1), model->rest.col(1)) << "outside the radius of the attachment";
  return (state.x.col(0) - model->rest.col(0)).norm();
}

TEST(Attachment, OfTheThesisTravelsInProportionToTheTimeStep) {
  const double fine = Travel("ATTACHMENT_MODE_THESIS", 0.1, 1e-3);
  EXPECT_GT(fine, 1e-6);
  EXPECT_NEAR(Travel("ATTACHMENT_MODE_THESIS", 0.1, 2e-2) / fine, 20, 20 * 0.05);
  EXPECT_NEAR(Travel("ATTACHMENT_MODE_THESIS", 0.1, 4e-3) / fine, 4, 4 * 0.02);
}

TEST(Attachment, BySpringAndDamperDoesNotDependOnTheTimeStep) {
  const double fine = Travel("ATTACHMENT_MODE_SPRING_DAMPER", 1, 1e-3);
  EXPECT_GT(fine, 0.01);
  EXPECT_NEAR(Travel("ATTACHMENT_MODE_SPRING_DAMPER", 1, 2e-2) / fine, 1, 0.01);
}

}  // namespace
}  // namespace phrenic
