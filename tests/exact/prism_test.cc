// The tensegrity prism of n struts: for any radius and height it is in equilibrium only if the two ends of a vertical
// cable are twisted by 90 - 180/n degrees. Then its force densities (tension over length) have the ratio
// q_horizontal / q_vertical = 1 / (2 sin(pi/n)) (Connelly and Terrell 1995).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "absl/strings/str_format.h"
#include "server/mechanics/constraint_residual.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

constexpr double kStiffness = 200, kRestRatio = 0.7;

// Vertices 0 to n-1 are the lower polygon, n to 2n-1 the upper one; strut i -> n+i, vertical cable i -> n+i-1.
struct Prism {
  int n;
  double turn;  // initial deviation from the stable twist [rad]

  double StableTwist() const { return std::numbers::pi / 2 - std::numbers::pi / n; }
  int Upper(int i) const { return n + (i + n) % n; }

  std::string Vertices() const {
    std::string text;
    for (int i = 0; i < 2 * n; ++i) {
      const double step = 2 * std::numbers::pi / n, twist = i < n ? 0 : StableTwist() + turn + step;
      const double angle = step * i + twist;
      text +=
          absl::StrFormat(" vertices { x: %.17g y: %.17g z: %g }", std::cos(angle), std::sin(angle), i < n ? 0 : 1.4);
    }
    return text;
  }

  std::string Cables() const {
    std::string text;
    for (int i = 0; i < n; ++i) {
      text += absl::StrFormat(" links { a: %d b: %d } links { a: %d b: %d } links { a: %d b: %d }", i, (i + 1) % n,
                              Upper(i), Upper(i + 1), i, Upper(i - 1));
    }
    return text;
  }

  std::string Scene() const {
    std::string struts;
    for (int i = 0; i < n; ++i) struts += absl::StrFormat(" links { a: %d b: %d }", i, Upper(i));
    return absl::StrFormat(
        "name: 'prism' bodies { name: 'prism' role: ROLE_DEFORMABLE mass: %d polyhedron {%s } } "
        "forces { cables { body: 'prism' stiffness: %g rest_length_ratio: %g list {%s } } } "
        "forces { friction { bodies: 'prism' rate: 2 } } constraints { rigid_links { body: 'prism' list {%s } } }",
        2 * n, Vertices(), kStiffness, kRestRatio, Cables(), struts);
  }
};

double Density(const Model& model, const State& state, int a, int b) {
  const double length = (state.x.col(a) - state.x.col(b)).norm();
  return kStiffness * (1 - kRestRatio * (model.rest.col(a) - model.rest.col(b)).norm() / length);
}

// Mean angle about the axis from vertex i to the upper end of its cable [rad].
double Twist(const Prism& prism, const State& state) {
  const Eigen::Vector3d lower = state.x.leftCols(prism.n).rowwise().mean();
  const Eigen::Vector3d upper = state.x.rightCols(prism.n).rowwise().mean();
  const Eigen::Vector3d axis = (upper - lower).normalized();
  double sum = 0;
  for (int i = 0; i < prism.n; ++i) {
    const Eigen::Vector3d a = state.x.col(i) - lower, b = state.x.col(prism.Upper(i - 1)) - upper;
    sum += std::atan2(axis.dot(a.cross(b)), a.dot(b) - axis.dot(a) * axis.dot(b));
  }
  return sum / prism.n;
}

class TensegrityPrism : public testing::TestWithParam<int> {};

TEST_P(TensegrityPrism, TurnsToItsStableTwist) {
  for (const double turn : {-0.35, 0.25}) {
    const Prism prism{GetParam(), turn};
    const auto model = CompileText(prism.Scene());
    ASSERT_NE(model, nullptr);
    EXPECT_NEAR(Twist(prism, model->InitialState()), prism.StableTwist() + turn, 1e-12) << "the initial twist";
    const State state = RunTo(*model, 60, 2e-3);
    EXPECT_NEAR(Twist(prism, state), prism.StableTwist(), 1e-6);
    const double horizontal = Density(*model, state, 0, 1), vertical = Density(*model, state, 0, prism.Upper(-1));
    EXPECT_NEAR(horizontal / vertical, 1 / (2 * std::sin(std::numbers::pi / prism.n)), 1e-6);
    EXPECT_LT(LargestResidual(*model, state).metres, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Struts, TensegrityPrism, testing::Values(3, 4, 5, 6));

}  // namespace
}  // namespace phrenic
