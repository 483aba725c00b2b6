// The error study: observed orders match the published ones, and insignificant errors are not reported.
#include "server/study/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "absl/strings/match.h"
#include "server/schema/fields.h"
#include "server/study/queue/run.h"
#include "tests/compile_text.h"
#include "tests/study/run_on.h"

namespace phrenic::study {
namespace {

using testing::HasSubstr;

// A swinging, stretching sheet corner: nonlinear, with friction, no rigid links.
const char kSwing[] = R"(
  name: "swing" title: "Swing"
  bodies {
    name: "b" role: ROLE_DEFORMABLE mass: 3 fixed_vertices: [0]
    polyhedron {
      vertices { } vertices { x: 1 } vertices { x: 1 y: 1 }
      edges { a: 0 b: 1 } edges { a: 1 b: 2 } edges { a: 0 b: 2 }
    }
  }
  forces { springs { bodies: "b" stiffness: 100 } }
  forces { friction { bodies: "b" rate: 0.2 } }
  forces { gravity { bodies: "b" acceleration { z: -2 } } }
  probes { name: "corner" body: "b" vertex: 2 }
)";

const char kLinks[] = R"(
  constraints { rigid_links { body: "b" list { links { a: 0 b: 1 } } } }
)";

v1::CreateStudyRequest ErrorRequest(double seconds, int levels) {
  v1::CreateStudyRequest request;
  request.mutable_error()->set_seconds(seconds);
  request.mutable_error()->set_moments(2);
  request.mutable_error()->set_levels(levels);
  request.mutable_error()->set_tolerance(1e-11);
  return request;
}

// The observed order of convergence between the two finest steps, by integrator.
std::map<std::string, double> Orders(const v1::ErrorTable& table) {
  std::map<std::string, double> orders;
  for (const v1::ErrorRow& row : table.rows()) {
    if (row.has_order()) orders[row.integrator()] = row.order();
  }
  return orders;
}

TEST(ErrorStudy, FindsThePublishedOrders) {
  const auto result = RunOn(kSwing, ErrorRequest(1, 6));
  ASSERT_TRUE(result.ok()) << result.status();
  const std::map<std::string, double> orders = Orders(result->error());
  const std::map<std::string, double> published = {{"semi_implicit_euler", 1},
                                                   {"explicit_euler", 1},
                                                   {"velocity_verlet", 2},
                                                   {"runge_kutta_4", 4},
                                                   {"tr_bdf2", 2},
                                                   {"linear_implicit_euler", 1},
                                                   {"projective_dynamics", 1},
                                                   {"bdf2", 2}};
  for (const auto& [name, order] : published) {
    ASSERT_TRUE(orders.contains(name)) << name;
    EXPECT_NEAR(orders.at(name), order, 0.15 * order) << name;
  }
  EXPECT_LT(orders.at("thesis"), 0.5);
  EXPECT_LT(result->error().reference().error_max_mm(), 1e-5);
}

// A strip of muscle whose activation follows the breath with a delay, and whose force depends on the rate of its
// fibres: both are scalars of the state.
const char kStrip[] = R"(
  name: "strip" title: "Strip"
  bodies {
    name: "b" role: ROLE_DEFORMABLE mass: 0.2 fixed_regions: "left"
    grid { columns: 5 rows: 3 u { x: 0.02 } v { y: 0.02 } }
    regions { name: "left" low { x: -1 y: -1 z: -1 } high { x: 0.001 y: 1 z: 1 } }
    regions { name: "right" low { x: 0.07 y: -1 z: -1 } high { x: 1 y: 1 z: 1 } }
  }
  forces {
    muscle { body: "b" from_region: "left" tendon_region: "right" activation_time: 0.05 precision: PRECISION_DOUBLE }
  }
  forces { friction { bodies: "b" rate: 8 } }
  breath { waveform: WAVEFORM_RAISED_COSINE }
  parameters { breath_length: 1 diaphragm_activation: 0.3 }
)";

TEST(ErrorStudy, IntegratesScalarsInTheReferenceToo) {
  v1::CreateStudyRequest request = ErrorRequest(0.4, 4);
  request.mutable_error()->set_tolerance(1e-8);
  request.mutable_error()->add_integrators(v1::INTEGRATOR_SEMI_IMPLICIT_EULER);
  const auto result = RunOn(kStrip, request);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_THAT(result->error().reference().method(), HasSubstr("CVODE"));
  EXPECT_GT(result->error().reference().largest_displacement_mm(), 3) << "the muscle of the reference contracts";
  EXPECT_NEAR(Orders(result->error())["semi_implicit_euler"], 1, 0.15);
  EXPECT_LT(result->error().rows(3).error_max_mm(), 0.02 * result->error().reference().largest_displacement_mm());
}

// No ODE solver can make a reference where a thread is taut at one moment and slack at the next.
TEST(ErrorStudy, RefinesTheStepForAReferenceWithLimits) {
  v1::CreateStudyRequest request = ErrorRequest(1, 4);
  request.mutable_error()->set_tolerance(1e-6);
  request.mutable_error()->add_integrators(v1::INTEGRATOR_SEMI_IMPLICIT_EULER);
  const std::string limits =
      "constraints { length_limits { body: 'b' list { links { a: 0 b: 2 } } at_most_ratio: 1 } }";
  const auto result = RunOn(kSwing + limits, request);
  ASSERT_TRUE(result.ok()) << result.status();
  const v1::Reference& reference = result->error().reference();
  EXPECT_THAT(reference.method(), HasSubstr("velocity Verlet"));
  EXPECT_LT(reference.error_max_mm(), 0.01);
  EXPECT_NEAR(Orders(result->error())["semi_implicit_euler"], 1, 0.3);
}

TEST(ErrorStudy, RecommendsAnIntegrator) {
  v1::CreateStudyRequest request = ErrorRequest(1, 6);
  request.mutable_error()->set_target(1e-5);
  const auto result = RunOn(kSwing, request);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_THAT(result->error().advice(), HasSubstr("For an error of 0.01 mm"));
  const auto dominated = [&](const v1::ErrorRow& row) {
    return std::any_of(result->error().rows().begin(), result->error().rows().end(), [&](const v1::ErrorRow& other) {
      return other.verdict() == "ok" && other.error_rms_mm() < row.error_rms_mm() &&
             other.cpu_per_second() < row.cpu_per_second();
    });
  };
  for (const v1::ErrorRow& row : result->error().rows()) {
    EXPECT_EQ(row.pareto(), row.verdict() == "ok" && !dominated(row)) << row.DebugString();
  }
}

TEST(ErrorStudy, RefusesErrorsBelowTheReferences) {
  v1::CreateStudyRequest request = ErrorRequest(1, 4);
  request.mutable_error()->set_tolerance(1e-4);
  request.mutable_error()->add_integrators(v1::INTEGRATOR_RUNGE_KUTTA_4);
  const auto result = RunOn(kSwing, request);
  ASSERT_TRUE(result.ok()) << result.status();
  const v1::ErrorRow& last = result->error().rows(result->error().rows_size() - 1);
  EXPECT_EQ(last.verdict(), "below the reference's error");
  EXPECT_FALSE(last.has_error_rms_mm());
  EXPECT_FALSE(last.pareto());
}

TEST(ErrorStudy, ShowsTheErrorOfTheThesisProjection) {
  v1::CreateStudyRequest request = ErrorRequest(1, 3);
  request.mutable_error()->add_integrators(v1::INTEGRATOR_VELOCITY_VERLET);
  request.mutable_parameters()->set_integrator(v1::INTEGRATOR_VELOCITY_VERLET);
  request.mutable_parameters()->set_time_step(0.005);
  const std::string scene = std::string(kSwing) + kLinks;
  const auto result = RunOn(scene, request);
  ASSERT_TRUE(result.ok()) << result.status();
  std::map<std::string, v1::ResidualRow> last;
  for (const v1::ResidualRow& row : result->error().residuals()) last[row.projection()] = row;
  ASSERT_EQ(last.size(), 2);
  EXPECT_LT(last["exact"].residual_mm(), 1e-6);
  EXPECT_GT(last["thesis"].error_rms_mm(), 10 * last["exact"].error_rms_mm());
}

// The reference uses double precision: an adaptive solver resolves round-off of single precision as motion and hardly
// advances.
TEST(ErrorStudy, ComparesSinglePrecisionWithADoubleReference) {
  v1::CreateStudyRequest request = ErrorRequest(1, 6);
  request.mutable_error()->add_integrators(v1::INTEGRATOR_RUNGE_KUTTA_4);
  std::string single = kSwing;
  single.insert(single.find("stiffness: 100"), "precision: PRECISION_SINGLE ");
  const auto in_double = RunOn(kSwing, request), in_single = RunOn(single, request);
  ASSERT_TRUE(in_double.ok() && in_single.ok()) << in_double.status() << in_single.status();
  const v1::ErrorTable &exact = in_double->error(), &rounded = in_single->error();
  EXPECT_EQ(rounded.reference().evaluations(), exact.reference().evaluations());
  EXPECT_EQ(rounded.reference().error_max_mm(), exact.reference().error_max_mm());
  ASSERT_EQ(rounded.rows_size(), exact.rows_size());
  EXPECT_GT(rounded.rows(5).error_rms_mm(), 2 * exact.rows(5).error_rms_mm()) << "the remaining error is round-off";
}

TEST(ErrorStudy, RepeatsExactly) {
  v1::CreateStudyRequest request = ErrorRequest(0.5, 3);
  const auto a = RunOn(kSwing, request), b = RunOn(kSwing, request);
  ASSERT_TRUE(a.ok() && b.ok());
  ASSERT_EQ(a->error().rows_size(), b->error().rows_size());
  for (int i = 0; i < a->error().rows_size(); ++i) {
    EXPECT_EQ(a->error().rows(i).error_max_mm(), b->error().rows(i).error_max_mm());
    EXPECT_EQ(a->error().rows(i).error_energy_j(), b->error().rows(i).error_energy_j());
  }
}

TEST(ErrorStudy, ReportsWhenARunWasOutOfTimeAndSkipsShorterSteps) {
  std::string stiff = kSwing;
  v1::CreateStudyRequest request = ErrorRequest(1, 1);
  request.mutable_error()->add_integrators(v1::INTEGRATOR_VELOCITY_VERLET);
  request.mutable_error()->set_most_seconds_a_run(0.001);
  request.mutable_error()->set_levels(16);
  const auto result = RunOn(stiff, request);
  ASSERT_TRUE(result.ok()) << result.status();
  const auto& rows = result->error().rows();
  const auto late = std::ranges::find_if(
      rows, [](const v1::ErrorRow& row) { return absl::StartsWith(row.verdict(), "out of time"); });
  ASSERT_LT(late - rows.begin(), 15) << "each level takes twice the time";
  EXPECT_THAT(late->verdict(), HasSubstr("out of time at"));
  for (auto row = late + 1; row != rows.end(); ++row) EXPECT_EQ(row->verdict(), "out of time") << "not tried";
}

TEST(Study, WithoutAKindIsRefused) { EXPECT_EQ(RunOn(kSwing, {}).status().code(), absl::StatusCode::kInvalidArgument); }

}  // namespace
}  // namespace phrenic::study
