#include "server/mechanics/pulls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic {
namespace {

using testing::HasSubstr;

v1::Pull Of(const std::string& body, int vertex, double x, double y, double z) {
  v1::Pull pull;
  pull.set_body(body);
  pull.set_vertex(vertex);
  pull.mutable_force()->set_x(x);
  pull.mutable_force()->set_y(y);
  pull.mutable_force()->set_z(z);
  return pull;
}

std::string Refusal(const v1::Pull& pull) {
  PullList list;
  *list.Add() = pull;
  const auto found = FindPulls(*CompileText(kTriangle), list, "pulls");
  EXPECT_EQ(found.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(found.status().message());
}

TEST(Pulls, AreForcesOnTheirVertices) {
  const auto model = CompileText(kTriangle);
  State pulled = model->InitialState(), free = pulled;
  Workspace work = model->MakeWorkspace();
  pulled.pulls = {{2, {0, 0, 4}}};
  ASSERT_TRUE(Step(*model, model->parameters, 0.01, pulled, work).ok());
  ASSERT_TRUE(Step(*model, model->parameters, 0.01, free, work).ok());
  EXPECT_NEAR(pulled.v(2, 2) - free.v(2, 2), 0.01 * 4 / model->mass[2], 1e-15);
  EXPECT_EQ(pulled.v.col(1), free.v.col(1));
}

TEST(Pulls, GoOnInACopyOfTheState) {
  const auto model = CompileText(kTriangle);
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace(), other = model->MakeWorkspace();
  state.pulls = {{1, {0, 2, 0}}};
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(Step(*model, model->parameters, 0.01, state, work).ok());
  State copy = state;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(Step(*model, model->parameters, 0.01, state, work).ok());
    ASSERT_TRUE(Step(*model, model->parameters, 0.01, copy, other).ok());
  }
  EXPECT_EQ(StateHash(copy), StateHash(state));
}

TEST(Pulls, ActInEveryIntegrator) {
  for (const char* name : {"SEMI_IMPLICIT_EULER", "VELOCITY_VERLET", "RUNGE_KUTTA_4", "LINEAR_IMPLICIT_EULER", "BDF2",
                           "TR_BDF2", "EXPLICIT_EULER", "PROJECTIVE_DYNAMICS"}) {
    const auto model = CompileText(Retimed(std::string("time_step: 0.01 integrator: INTEGRATOR_") + name));
    State state = model->InitialState();
    Workspace work = model->MakeWorkspace();
    state.pulls = {{2, {0, 0, 1 + model->mass[2]}}};  // its weight, and 1 N
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(Step(*model, model->parameters, 0.01, state, work).ok());
    EXPECT_NEAR(state.v(2, 2), 0.1 / model->mass[2], 0.01) << name;
  }
}

TEST(Pulls, ReplaceTheOneOnTheirVertexAndAreLetGoByZero) {
  std::vector<VertexPull> pulls;
  ASSERT_TRUE(ChangePulls({{1, {1, 0, 0}}, {2, {2, 0, 0}}}, false, pulls).ok());
  ASSERT_TRUE(ChangePulls({{1, {0, 5, 0}}}, false, pulls).ok());
  ASSERT_EQ(pulls.size(), 2u);
  EXPECT_EQ(pulls[0].force, Eigen::Vector3d(0, 5, 0));
  ASSERT_TRUE(ChangePulls({{2, {0, 0, 0}}}, false, pulls).ok());
  ASSERT_EQ(pulls.size(), 1u);
  ASSERT_TRUE(ChangePulls({{3, {0, 0, 1}}}, true, pulls).ok());
  ASSERT_EQ(pulls.size(), 1u);
  EXPECT_EQ(pulls[0].vertex, 3);
  ASSERT_TRUE(ChangePulls({}, true, pulls).ok());
  EXPECT_TRUE(pulls.empty());
}

TEST(Pulls, AreLimitedInNumber) {
  std::vector<VertexPull> many, pulls = {{-1, {1, 0, 0}}};
  for (int i = 0; i < kMostPulls; ++i) many.push_back({i, {1, 0, 0}});
  const absl::Status refused = ChangePulls(many, false, pulls);
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(pulls.size(), 1u) << "a refused change changes nothing";
  EXPECT_TRUE(ChangePulls(many, true, pulls).ok());
}

TEST(Pulls, AreNamedAsPeopleNamedThem) {
  const auto model = CompileText(kTriangle);
  PullList list;
  *list.Add() = Of("sheet", 2, 1, -2, 3);
  const auto found = FindPulls(*model, list, "pulls");
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_EQ(DescribePulls(*model, *found)[0].SerializeAsString(), list[0].SerializeAsString());
}

TEST(Pulls, OnAFollowerActOnTheVertexThatMovesIt) {
  const auto model = CompileText(Triangle(
      "bodies { name: 'seen' role: ROLE_SEEN polyhedron { vertices { x: 0.1 y: 0.7 } vertices { x: 0.6 y: 0.2 z: 0.1 } "
      "vertices { x: 0.1 } triangles { a: 0 b: 1 c: 2 } } } "
      "motions { skin { bodies: 'seen' drivers: 'sheet' mode: SKIN_MODE_TRIANGLES } }"));
  PullList list;
  *list.Add() = Of("seen", 0, 1, 0, 0);
  *list.Add() = Of("seen", 1, 0, 2, 0);
  const auto found = FindPulls(*model, list, "pulls");
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_EQ((*found)[0].vertex, 2);
  EXPECT_EQ((*found)[1].vertex, 1);
  EXPECT_EQ(DescribePulls(*model, *found)[0].body(), "sheet");
  *list.Add() = Of("seen", 2, 1, 0, 0);
  EXPECT_THAT(std::string(FindPulls(*model, list, "pulls").status().message()), HasSubstr("fixed or driven"));
}

TEST(Pulls, OnNothingThatCanMoveAreRefused) {
  EXPECT_EQ(Refusal(Of("shet", 1, 1, 0, 0)), "pulls[0].body: there is no deformable body \"shet\"; there are sheet");
  EXPECT_THAT(Refusal(Of("post", 1, 1, 0, 0)), HasSubstr("no deformable body"));
  EXPECT_THAT(Refusal(Of("sheet", 3, 1, 0, 0)), HasSubstr("its vertices are 0 to 2"));
  EXPECT_THAT(Refusal(Of("sheet", 0, 1, 0, 0)), HasSubstr("fixed or driven"));
  EXPECT_THAT(Refusal(Of("sheet", 1, 0, 0, 2e6)), HasSubstr("pulls[0].force"));
}

}  // namespace
}  // namespace phrenic
