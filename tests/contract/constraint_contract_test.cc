// The laws that every constraint keeps, and those that only the exact ones do. A new constraint joins with one line in
// kConstraints.
#include <gtest/gtest.h>

#include <random>

#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/step/step_plan.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

struct ConstraintCase {
  const char* name;
  const char* text;  // one constraint of the scene, of a bipyramid with a tail (below)
  bool exact;        // keeps momentum and corrects velocities
};

#define PAIRS "list { links { a: 0 b: 1 } links { a: 2 b: 3 } links { a: 4 b: 6 } }"
#define CHAIN "list { links { a: 0 b: 1 } links { a: 1 b: 2 } links { a: 2 b: 5 } links { a: 5 b: 6 } }"
// All edges of the bipyramid and its axis, which is one link more than a rigid body has freedom for.
#define TRUSS                                                                                                   \
  "list { links { a: 0 b: 1 } links { a: 1 b: 2 } links { a: 2 b: 0 } links { a: 3 b: 0 } links { a: 3 b: 1 } " \
  "links { a: 3 b: 2 } links { a: 4 b: 0 } links { a: 4 b: 1 } links { a: 4 b: 2 } links { a: 3 b: 4 } "        \
  "links { a: 4 b: 5 } links { a: 5 b: 6 } }"

const ConstraintCase kConstraints[] = {
    {"rigid_links", "rigid_links { body: 'truss' " PAIRS " }", true},
    {"rigid_links_chain", "rigid_links { body: 'truss' " CHAIN " }", true},
    {"rigid_links_truss", "rigid_links { body: 'truss' " TRUSS " }", true},
    {"rigid_links_thesis", "rigid_links { body: 'truss' " PAIRS " projection: PROJECTION_THESIS }", false},
    {"limits_at_most", "length_limits { body: 'truss' " CHAIN " at_most_ratio: 1 }", true},
    {"limits_at_least", "length_limits { body: 'truss' " CHAIN " at_least_ratio: 1 }", true},
    {"rigid_links_swept", "rigid_links { body: 'truss' " CHAIN " sweeps: 40 }", true},
    {"limits_swept", "length_limits { body: 'truss' " CHAIN " at_most_ratio: 1 at_least_ratio: 0.99 sweeps: 40 }",
     true},
    {"limits_both", "length_limits { body: 'truss' " CHAIN " at_most_ratio: 1.01 at_least_ratio: 0.99 }", true},
};

void PrintTo(const ConstraintCase& constraint, std::ostream* out) { *out << constraint.name; }

// Vertices 0-2 are the bipyramid's waist, 3 and 4 its tips, 5 and 6 its tail; 1 kg each.
std::string Scene(const std::string& constraint, const std::string& more = "") {
  return "name: 'contract' bodies { name: 'truss' role: ROLE_DEFORMABLE mass: 7 polyhedron { "
         "vertices { x: 1 } vertices { x: -0.5 y: 0.9 } vertices { x: -0.5 y: -0.8 } vertices { z: 1.1 } "
         "vertices { z: -0.9 } vertices { x: 0.2 z: -2 } vertices { x: -0.6 y: 0.3 z: -2.5 } } } constraints { " +
         constraint + " } " + more;
}

State Thrown(const Model& model, double spin) {
  State state = model.InitialState();
  const Eigen::Vector3d axis(0.3, -0.5, 0.8);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> rate(-1, 1);
  for (auto v : state.v.colwise()) v = Eigen::Vector3d::NullaryExpr([&] { return rate(random); });
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) state.v.col(i) += spin * axis.cross(state.x.col(i));
  model.plan->ProjectVelocities(model.parameters, Scratch(), state);
  return state;
}

void Fly(const Model& model, double dt, int steps, State& state) {
  Workspace work = model.MakeWorkspace();
  int done = 0;
  while (done < steps && Step(model, model.parameters, dt, state, work).ok()) ++done;
  EXPECT_EQ(done, steps) << "diverged";
}

Eigen::Vector3d Momentum(const Model& model, const State& state) { return state.v * model.mass; }

Eigen::Vector3d AngularMomentum(const Model& model, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    sum += model.mass[i] * Eigen::Vector3d(state.x.col(i)).cross(Eigen::Vector3d(state.v.col(i)));
  }
  return sum;
}

class ConstraintContract : public testing::TestWithParam<ConstraintCase> {
 protected:
  void SetUp() override {
    model_ = CompileText(Scene(GetParam().text));
    ASSERT_NE(model_, nullptr);
    ASSERT_EQ(model_->constraints.size(), 1u) << "the constraint was left out";
  }
  double Residual(const State& state) const { return model_->constraints.front()->Residual(state); }

  std::shared_ptr<const Model> model_;
};

#ifdef PHRENIC_SANITIZED
constexpr int kManySteps = 10'000;  // enough for sanitizers; the Release build takes all steps
#else
constexpr int kManySteps = 100'000;
#endif

TEST_P(ConstraintContract, HoldsForAHundredThousandSteps) {
  State state = Thrown(*model_, 2);
  Fly(*model_, 2e-5, kManySteps, state);
  EXPECT_LT(Residual(state), 1e-9);
  EXPECT_EQ(LargestResidual(*model_, state).metres, Residual(state));
}

TEST_P(ConstraintContract, SwitchedOffItDoesNothing) {
  v1::Parameters off = model_->parameters;
  off.set_apply_links(false);
  State state = model_->InitialState();
  for (Eigen::Index i = 0; i < state.v.cols(); ++i) state.v.col(i) = Eigen::Vector3d(1, 0.5 * i, -0.1 * i * i);
  const Points velocities = state.v;
  Workspace work = model_->MakeWorkspace();
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(Step(*model_, off, 1e-3, state, work).ok());
  model_->plan->ProjectVelocities(off, Scratch(), state);
  EXPECT_EQ(state.v, velocities);
  EXPECT_LT((state.x - model_->rest - 0.1 * velocities).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_P(ConstraintContract, KeepsMomentumAndAngularMomentum) {
  if (!GetParam().exact) GTEST_SKIP() << "splits corrections by the distance moved";
  State state = Thrown(*model_, 1);
  const Eigen::Vector3d momentum = Momentum(*model_, state), angular = AngularMomentum(*model_, state);
  Fly(*model_, 1e-3, 5'000, state);
  EXPECT_LT((Momentum(*model_, state) - momentum).norm(), 1e-9);
  EXPECT_LT((AngularMomentum(*model_, state) - angular).norm(), 1e-6 * angular.norm());
}

// Another that never acts has both worked out for all vertices at once.
TEST_P(ConstraintContract, HoldsBlockByBlockToTheBitAsForAll) {
  if (dynamic_cast<const BlockConstraint*>(model_->constraints.front().get()) == nullptr) {
    GTEST_SKIP() << "is projected for all vertices at once";
  }
  const std::string slack =
      " } constraints { length_limits { body: 'truss' list { links { a: 3 b: 6 } } at_most_ratio: 9 }";
  const auto both = CompileText(Scene(GetParam().text + slack));
  ASSERT_NE(both, nullptr);
  ASSERT_EQ(both->constraints.size(), 2u);
  State alone = Thrown(*model_, 2), together = alone;
  Fly(*model_, 1e-3, 100, alone);
  Fly(*both, 1e-3, 100, together);
  EXPECT_EQ(StateHash(alone), StateHash(together));
}

// Then a move along the velocities leaves the constraint at second order only, and there is nothing more to take.
TEST_P(ConstraintContract, ProjectedVelocitiesStayOnIt) {
  if (!GetParam().exact) GTEST_SKIP() << "leaves velocities alone";
  State state = Thrown(*model_, 3);
  const Eigen::Vector3d momentum = Momentum(*model_, state), angular = AngularMomentum(*model_, state);
  const auto residual_after = [&](double dt) {
    State moved = state;
    moved.x += dt * state.v;
    return Residual(moved);
  };
  EXPECT_LT(residual_after(1e-4), 1e-6);
  EXPECT_LT(residual_after(1e-5), 0.011 * residual_after(1e-4) + 1e-14);
  const Points once = state.v;
  model_->plan->ProjectVelocities(model_->parameters, Scratch(), state);
  EXPECT_LT((state.v - once).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((Momentum(*model_, state) - momentum).norm(), 1e-12);
  EXPECT_LT((AngularMomentum(*model_, state) - angular).norm(), 1e-10);
}

// With every other constraint implicit integrators keep their order and gain nothing (order_test.cc).
TEST(ThesisLinks, AreRefusedWithImplicitIntegratorsWhenCompiledAndWhenChangedLive) {
  const std::string links = "rigid_links { body: 'truss' " PAIRS " projection: PROJECTION_THESIS }";
  for (const char* integrator : {"LINEAR_IMPLICIT_EULER", "BDF2", "TR_BDF2", "STATIC", "PROJECTIVE_DYNAMICS"}) {
    const std::string chosen = std::string("parameters { integrator: INTEGRATOR_") + integrator + " ";
    const auto refused = TryCompileText(Scene(links, chosen + "}"));
    EXPECT_EQ(refused.status().code(), absl::StatusCode::kInvalidArgument) << integrator;
    EXPECT_NE(refused.status().message().find("parameters.integrator"), std::string::npos) << refused.status();
    EXPECT_NE(refused.status().message().find("PROJECTION_EXACT"), std::string::npos) << refused.status();
    EXPECT_TRUE(TryCompileText(Scene(links, chosen + "apply_links: false }")).ok()) << integrator;
    const auto model = CompileText(Scene(links));
    v1::Parameters live = model->parameters;
    v1::Integrator kind = v1::INTEGRATOR_UNSPECIFIED;
    ASSERT_TRUE(v1::Integrator_Parse(std::string("INTEGRATOR_") + integrator, &kind));
    live.set_integrator(kind);
    State state = model->InitialState();
    Workspace work = model->MakeWorkspace();
    const absl::Status stepped = Step(*model, live, 1e-3, state, work);
    EXPECT_EQ(stepped.code(), absl::StatusCode::kAborted);
    EXPECT_NE(stepped.message().find("PROJECTION_EXACT"), std::string::npos) << stepped;
  }
}

INSTANTIATE_TEST_SUITE_P(Constraints, ConstraintContract, testing::ValuesIn(kConstraints),
                         [](const auto& test) { return std::string(test.param.name); });

// Two elements that share vertices hold as one that has the links of both.
TEST(SeveralConstraints, HoldTogetherWhereTheyShareVertices) {
  const auto split = CompileText(
      Scene("rigid_links { body: 'truss' list { links { a: 0 b: 1 } links { a: 2 b: 5 } } }",
            "constraints { rigid_links { body: 'truss' list { links { a: 1 b: 2 } links { a: 5 b: 6 } } } }"));
  const auto one = CompileText(Scene("rigid_links { body: 'truss' " CHAIN " }"));
  State state = Thrown(*split, 2), other = Thrown(*one, 2);
  EXPECT_LT((state.v - other.v).cwiseAbs().maxCoeff(), 1e-9);
  Fly(*split, 1e-3, 500, state);
  Fly(*one, 1e-3, 500, other);
  EXPECT_LT(LargestResidual(*split, state).metres, 1e-9);
  EXPECT_LT((state.x - other.x).cwiseAbs().maxCoeff(), 1e-7);
}

}  // namespace
}  // namespace phrenic
