// Reference solutions match closed forms.
#include "server/study/reference.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/compile_text.h"
#include "tests/study/run_on.h"

namespace phrenic::study {
namespace {

// A mass of 2 kg, 1 m above a fixed point, on a spring of 50 N/m with friction 0.8 N s/m, pulled down by gravity.
const char kOscillator[] = R"(
  name: "oscillator" title: "Oscillator"
  bodies {
    name: "b" role: ROLE_DEFORMABLE mass: 4 fixed_vertices: [0]
    polyhedron { vertices { } vertices { z: 1 } edges { a: 0 b: 1 } }
  }
  forces { springs { bodies: "b" stiffness: 50 } }
  forces { friction { bodies: "b" rate: 0.4 } }
  forces { gravity { bodies: "b" acceleration { z: -1 } } }
  parameters { time_step: 0.01 }
)";

TEST(Reference, MatchesTheClosedFormOfADampedOscillator) {
  const Subject subject = SubjectOf(kOscillator);
  v1::Reference report;
  const std::vector<double> moments = Moments(3, 6);
  const auto reference = ConfirmedReference(subject, moments, 1e-10, kNeverCancel, report);
  ASSERT_TRUE(reference.ok()) << reference.status();
  const double m = subject.model->mass[1], k = 50;
  Eigen::VectorXd c = Eigen::VectorXd::Zero(2);
  for (const auto& force : subject.model->forces) {
    force->AddDamping(MakeEvalContext(*subject.model, subject.parameters, subject.model->InitialState()), c);
  }
  const double g = c[1] / (2 * m), omega = std::sqrt(k / m - g * g), sag = m * 1 / k;
  for (size_t i = 0; i < moments.size(); ++i) {
    const double t = moments[i];
    const double u = -sag + sag * std::exp(-g * t) * (std::cos(omega * t) + g / omega * std::sin(omega * t));
    EXPECT_NEAR(reference->states[i].x(2, 1) - 1, u, 1e-8);
  }
  EXPECT_LT(report.error_max_mm(), 1e-5);
  EXPECT_NEAR(report.largest_displacement_mm(), 2e3 * sag, 0.5e3 * sag);
}

const char kSwingingLink[] = R"(
  name: "pendulum" title: "Pendulum"
  bodies {
    name: "b" role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0]
    polyhedron { vertices { } vertices { x: 1 } edges { a: 0 b: 1 } }
  }
  forces { gravity { bodies: "b" acceleration { z: -9.81 } } }
  constraints { rigid_links { body: "b" list { links { a: 0 b: 1 } } } }
  parameters { time_step: 0.001 }
)";

TEST(Reference, KeepsRigidLinksAndTheirPeriod) {
  const Subject subject = SubjectOf(kSwingingLink);
  v1::Reference report;
  const double period = 2.367841948;  // from 90 degrees, length 1 m, g = 9.81 m/s^2 (complete elliptic integral)
  const auto reference = SolveReference(subject, Moments(period, 4), 1e-10, kNeverCancel, report);
  ASSERT_TRUE(reference.ok()) << reference.status();
  for (const State& state : reference->states) EXPECT_NEAR(state.x.col(1).norm(), 1, 1e-7);
  EXPECT_NEAR(reference->states[1].x(0, 1), -1, 1e-6);
  EXPECT_NEAR(reference->states[3].x(0, 1), 1, 1e-6);
}

TEST(Reference, StopsAtEveryCheckThatCancels) {
  const Subject subject = SubjectOf(kOscillator);
  for (int looks = 1; looks <= 8; ++looks) {
    int seen = 0;
    v1::Reference report;
    const auto stop = [&](double, std::string_view) { return ++seen < looks; };
    const auto reference = SolveReference(subject, Moments(1, 1), 1e-12, stop, report);
    EXPECT_TRUE(absl::IsCancelled(reference.status())) << reference.status();
    EXPECT_EQ(seen, looks) << "it continued after the cancellation";
  }
}

TEST(Reference, NeedsSmoothConstraints) {
  std::string text = kSwingingLink;
  text.replace(text.find("list {"), 0, "projection: PROJECTION_THESIS ");
  v1::Reference report;
  const auto reference = SolveReference(SubjectOf(text), Moments(1, 1), 1e-8, kNeverCancel, report);
  EXPECT_EQ(reference.status().code(), absl::StatusCode::kUnimplemented);
}

TEST(Reference, StopsWhenCancelled) {
  v1::Reference report;
  const auto cancel = [](double, std::string_view) { return false; };
  const auto reference = SolveReference(SubjectOf(kOscillator), Moments(1, 1), 1e-8, cancel, report);
  EXPECT_EQ(reference.status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace phrenic::study
