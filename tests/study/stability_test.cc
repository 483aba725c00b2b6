// The stability study: measured limits match the prediction, and the map divides at the limit.
#include "server/study/stability.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "server/study/extremes.h"
#include "server/study/queue/run.h"
#include "server/study/stability_limits.h"
#include "server/study/stability_map.h"
#include "server/study/subject.h"
#include "server/study/watched_run.h"
#include "tests/compile_text.h"
#include "tests/study/run_on.h"

namespace phrenic::study {
namespace {

using testing::HasSubstr;

// A row of masses of 1 kg between two fixed ends.
const char kChain[] = R"(
  name: "chain" title: "Chain"
  bodies {
    name: "b" role: ROLE_DEFORMABLE mass: 8 fixed_vertices: [0, 7]
    polyhedron {
      vertices { } vertices { x: 1 } vertices { x: 2 } vertices { x: 3 }
      vertices { x: 4 } vertices { x: 5 } vertices { x: 6 } vertices { x: 7 }
      edges { a: 0 b: 1 } edges { a: 1 b: 2 } edges { a: 2 b: 3 } edges { a: 3 b: 4 }
      edges { a: 4 b: 5 } edges { a: 5 b: 6 } edges { a: 6 b: 7 }
    }
  }
  forces { springs { bodies: "b" stiffness: 100 } }
)";

const char kHungSheet[] = R"(
  name: "sheet" title: "Sheet"
  bodies {
    name: "b" role: ROLE_DEFORMABLE mass: 18 fixed_vertices: [0, 1, 2, 3, 4, 5]
    grid { columns: 6 rows: 6 u { x: 0.1 } v { z: -0.1 } }
  }
  forces { springs { bodies: "b" stiffness: 200 } }
  forces { friction { bodies: "b" rate: 5 } }
)";

v1::LimitRow Limit(const std::string& text, v1::Integrator integrator, double factor = 1) {
  v1::LimitRow row;
  const Subject subject = With(Stiffened(SubjectOf(text), factor), integrator);
  EXPECT_TRUE(MeasureLimit(subject, 1, 60, kNeverCancel, row).ok());
  return row;
}

const v1::Integrator kExplicit[] = {v1::INTEGRATOR_SEMI_IMPLICIT_EULER, v1::INTEGRATOR_THESIS,
                                    v1::INTEGRATOR_VELOCITY_VERLET, v1::INTEGRATOR_RUNGE_KUTTA_4};
const v1::Integrator kImplicit[] = {v1::INTEGRATOR_LINEAR_IMPLICIT_EULER, v1::INTEGRATOR_BDF2, v1::INTEGRATOR_TR_BDF2,
                                    v1::INTEGRATOR_PROJECTIVE_DYNAMICS};

TEST(Limits, OfAChainMatchThePrediction) {
  for (const v1::Integrator integrator : kExplicit) {
    const v1::LimitRow row = Limit(kChain, integrator);
    EXPECT_NEAR(row.ratio(), 1, 0.1) << NameOf(integrator) << ": " << row.note();
  }
  // The frequency of the chain's fastest mode in closed form: omega = 2 sqrt(k/m) sin(6 pi/14).
  EXPECT_NEAR(Limit(kChain, v1::INTEGRATOR_VELOCITY_VERLET).measured_s(), 0.1 / std::sin(6 * M_PI / 14), 0.002);
}

TEST(Limits, OfASheetWithFrictionMatchThePrediction) {
  for (const v1::Integrator integrator : kExplicit) {
    const v1::LimitRow row = Limit(kHungSheet, integrator);
    EXPECT_NEAR(row.ratio(), 1, 0.1) << NameOf(integrator) << ": " << row.note();
  }
  const v1::LimitRow euler = Limit(kHungSheet, v1::INTEGRATOR_EXPLICIT_EULER);
  EXPECT_NEAR(euler.ratio(), 1, 0.1) << euler.note();
}

TEST(Limits, AreProportionalToTheInverseRootOfTheStiffness) {
  for (const v1::Integrator integrator : {v1::INTEGRATOR_VELOCITY_VERLET, v1::INTEGRATOR_RUNGE_KUTTA_4}) {
    const double soft = Limit(kChain, integrator).measured_s(), stiff = Limit(kChain, integrator, 1e6).measured_s();
    EXPECT_NEAR(soft / stiff, 1000, 20) << NameOf(integrator);
  }
}

TEST(Limits, OfExplicitEulerWithoutFrictionDoNotExist) {
  const v1::LimitRow row = Limit(kChain, v1::INTEGRATOR_EXPLICIT_EULER);
  EXPECT_FALSE(row.has_predicted_s() || row.has_measured_s());
  EXPECT_THAT(row.note(), testing::AllOf(HasSubstr("stable at no step"), HasSubstr("unstable")));
}

TEST(Limits, OfImplicitIntegratorsDoNotExistAtAnyStiffness) {
  for (const v1::Integrator integrator : kImplicit) {
    for (const double factor : {1.0, 1e6}) {
      const v1::LimitRow row = Limit(kHungSheet, integrator, factor);
      EXPECT_FALSE(row.has_predicted_s());
      EXPECT_THAT(row.note(), HasSubstr("measured at 0.1 s: stable")) << NameOf(integrator) << factor;
    }
  }
}

// The thesis' damping of 0.02 kg per step reverses the velocity of a lighter vertex.
TEST(Limits, OfTheThesisDampingDoNotExistForLightVertices) {
  std::string light = kChain;
  light.replace(light.find("mass: 8"), 7, "mass: 0.12");
  const v1::LimitRow row = Limit(light, v1::INTEGRATOR_THESIS);
  EXPECT_FALSE(row.has_predicted_s() || row.has_measured_s());
  EXPECT_THAT(row.note(), testing::AllOf(HasSubstr("stable at no step"), HasSubstr("unstable")));
}

// A net that falls onto its fixed rim and stretches: it moves at any step, and only long steps leave its motion.
TEST(Limits, OfAMovingSceneAreWhereRunsLeaveTheRunAtATenth) {
  const std::string falling =
      std::string(kHungSheet) + R"(forces { gravity { bodies: "b" acceleration { x: 9 z: 9 } } })";
  const Subject subject = With(SubjectOf(falling), v1::INTEGRATOR_VELOCITY_VERLET);
  v1::LimitRow row;
  ASSERT_TRUE(MeasureLimit(subject, 3, 60, kNeverCancel, row).ok());
  ASSERT_TRUE(row.has_predicted_s() && row.has_measured_s()) << row.note();
  EXPECT_GE(row.seconds(), 3);
  const auto survives = [&](double dt) {
    const auto run = Watch(subject, subject.model->InitialState(), row.seconds(), dt, 60, kNeverCancel);
    return run->status.ok() && run->largest_kinetic < 1e4;
  };
  EXPECT_TRUE(survives(0.98 * row.measured_s())) << row.DebugString();
  EXPECT_FALSE(survives(1.02 * row.measured_s())) << row.DebugString();
}

// What collapses at every step is no instability of the step.
TEST(Limits, AreNotLoweredByAMotionThatDivergesAtEveryStep) {
  v1::LimitRow row;
  const std::string torn = std::string(kChain) + R"(forces { point_load { body: "b" vertices: 3 force { x: 1e6 } } })";
  ASSERT_TRUE(MeasureLimit(With(SubjectOf(torn), v1::INTEGRATOR_VELOCITY_VERLET), 1, 60, kNeverCancel, row).ok());
  EXPECT_FALSE(row.has_measured_s());
  EXPECT_THAT(row.note(), HasSubstr("not measured: at a tenth of the predicted step, the run diverges at"));
}

v1::CreateStudyRequest MapRequest() {
  v1::CreateStudyRequest request;
  request.mutable_stability()->set_seconds(1.5);
  request.mutable_stability()->set_steps(2);
  request.mutable_stability()->set_stiffest(1e6);
  request.mutable_stability()->set_leave_out_extremes(true);
  request.mutable_stability()->set_most_seconds_a_run(60);
  for (const v1::Integrator kind : {v1::INTEGRATOR_VELOCITY_VERLET, v1::INTEGRATOR_LINEAR_IMPLICIT_EULER}) {
    request.mutable_stability()->add_integrators(kind);
  }
  return request;
}

std::string Loaded() {
  return std::string(kHungSheet) + R"(forces { gravity { bodies: "b" acceleration { z: -2 } } })";
}

// The map of the loaded sheet, run once.
const absl::StatusOr<v1::StudyResult>& LoadedMap() {
  static const auto* const map = new absl::StatusOr<v1::StudyResult>(RunOn(Loaded(), MapRequest()));
  return *map;
}

TEST(Map, DividesAtTheLimit) {
#ifdef PHRENIC_SANITIZED
  GTEST_SKIP() << "the Release build runs it; KeepsItsCpuBudget maps here";
#endif
  const auto& result = LoadedMap();
  ASSERT_TRUE(result.ok()) << result.status();
  std::map<double, double> limits;
  for (const v1::LimitRow& row : result->stability().limits()) {
    if (row.has_predicted_s()) limits[row.stiffness()] = row.predicted_s();
  }
  EXPECT_EQ(limits.size(), 7);
  std::set<std::string> verdicts;
  for (const v1::StabilityRow& row : result->stability().map()) {
    verdicts.insert(row.verdict());
    const bool above = row.integrator() == "velocity_verlet" && row.time_step_s() > limits[row.stiffness()];
    EXPECT_EQ(row.verdict() == "diverged", above) << row.DebugString();
    EXPECT_EQ(row.has_diverged_at_s(), above);
    EXPECT_EQ(row.where().empty(), !above);
  }
  EXPECT_TRUE(verdicts.contains("stable") && verdicts.contains("damped") && verdicts.contains("diverged"));
}

TEST(Map, RepeatsExactly) {
#ifdef PHRENIC_SANITIZED
  GTEST_SKIP() << "the Release build runs it; KeepsItsCpuBudget maps here";
#endif
  const auto& a = LoadedMap();
  const auto b = RunOn(Loaded(), MapRequest());
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->stability().SerializeAsString(), b->stability().SerializeAsString());
}

TEST(Map, KeepsItsCpuBudget) {
  v1::CreateStudyRequest request = MapRequest();
  request.mutable_stability()->set_seconds(60);
  request.mutable_stability()->set_most_seconds_a_run(0.001);
  request.mutable_stability()->set_stiffest(100);
  const auto result = RunOn(Loaded(), request);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->stability().map(result->stability().map_size() - 1).verdict(), "out of time");
  EXPECT_LT(result->took_s(), 20);
}

TEST(Stability, StopsWhenCancelled) {
  double furthest = 0;
  const auto until = [&furthest](double done, std::string_view) {
    EXPECT_GE(done, furthest - 1e-9);
    furthest = std::max(furthest, done);
    return done < 0.6;
  };
  EXPECT_EQ(RunOn(Loaded(), MapRequest(), until).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace phrenic::study
