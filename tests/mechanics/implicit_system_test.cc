// The linear systems of implicit steps, and the steps that they carry.
#include "server/mechanics/solve/implicit_system.h"

#include <gtest/gtest.h>

#include <random>

#include "absl/strings/str_cat.h"
#include "tests/compile_text.h"
#include "tests/mechanics/every_target.h"

namespace phrenic {
namespace {

Points RandomPoints(Eigen::Index columns, int seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  return Points::NullaryExpr(3, columns, [&] { return value(random); });
}

// A sheet that is held at one edge, of a kind of tissue.
std::shared_ptr<const Model> Sheet(const std::string& forces, int columns = 9, int rows = 13) {
  return CompileText(
      "name: 'sheet' bodies { name: 'sheet' role: ROLE_DEFORMABLE material {} fixed_vertices: [0, 1, "
      "2] grid { columns: " +
      std::to_string(columns) + " rows: " + std::to_string(rows) + " u { x: 0.01 } v { y: 0.01 } } } " + forces);
}

const char* const kTissues[] = {
    "forces { springs { bodies: 'sheet' stiffness: 300 } }",
    "forces { membrane { bodies: 'sheet' youngs_modulus: 9000 } }",  // its blocks are not symmetric
    "forces { springs { bodies: 'sheet' stiffness: 300 } } forces { springs { bodies: 'sheet' stiffness: 900 "
    "rest_length_ratio: 0.7 } }",  // two along each edge
    "forces { springs { bodies: 'sheet' stiffness: 300 } } forces { springs { bodies: 'sheet' stiffness: 5000 "
    "rest_length_ratio: 1.3 } } forces { bending { bodies: 'sheet' youngs_modulus: 9000 } } forces { friction { "
    "bodies: 'sheet' rate: 40 } } forces { target_spring { bodies: 'sheet' displacement { z: 0.01 } stiffness: 2 } }",
};

// A y = b by the matrix in double precision.
double Missing(const Model& model, const EvalContext& at, double g, const Points& b, const Points& y) {
  BlockMatrix stiffness(model);
  stiffness.Assemble(model, at);
  Points product = Points::Zero(3, b.cols());
  stiffness.Times(y, product);
  Eigen::VectorXd inertia = Eigen::VectorXd::Zero(b.cols());
  for (const auto& force : model.forces) force->AddDamping(at, inertia);
  inertia = model.mass + g * inertia;
  Points missing = b - y * inertia.asDiagonal() - g * g * product;
  Points all = b;
  for (Eigen::Index i = 0; i < b.cols(); ++i) {
    if (model.inverse_mass[i] == 0) missing.col(i).setZero(), all.col(i).setZero();
  }
  return missing.norm() / all.norm();
}

// What single precision may leave is said in the header.
TEST(ImplicitSystem, SolvesToItsTolerance) {
  for (const char* tissue : kTissues) {
    const auto model = Sheet(tissue);
    State state = model->InitialState();
    state.x += 2e-3 * RandomPoints(state.x.cols(), 1);
    state.x.col(40) = state.x.col(41);  // an edge without length
    const EvalContext at = MakeEvalContext(*model, model->parameters, state);
    const Points b = RandomPoints(state.x.cols(), 2);
    ImplicitSystem system(*model);
    system.Assemble(*model, at, 0.01);
    for (const double tolerance : {1e-2, 1e-5}) {
      Points y = Points::Zero(3, b.cols());
      SolverEffort effort;
      effort.Begin(0);
      ASSERT_TRUE(system.Solve(*model, at, b, tolerance, effort, y).ok());
      EXPECT_GT(effort.iterations(), 0);
      EXPECT_LE(effort.residual(), tolerance);
      EXPECT_LT(Missing(*model, at, 0.01, b, y), 20 * tolerance) << tissue;  // by another norm
    }
  }
}

// A chain whose even vertices are numbered first, then the odd ones; the first is held.
std::shared_ptr<const Model> ChainOfTwoHalves(int half) {
  std::string vertices, edges;
  for (int i = 0; i < 2 * half; ++i) {
    absl::StrAppend(&vertices, " vertices { x: ", 0.01 * (i < half ? 2 * i : 2 * (i - half) + 1), " }");
    if (i < half) absl::StrAppend(&edges, " edges { a: ", i, " b: ", i + half, " }");
    if (i >= half && i + 1 < 2 * half) absl::StrAppend(&edges, " edges { a: ", i, " b: ", i - half + 1, " }");
  }
  return CompileText(
      absl::StrCat("name: 'chain' bodies { name: 'chain' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: 0 polyhedron {",
                   vertices, edges, " } } forces { springs { bodies: 'chain' stiffness: 300 } }"));
}

// Rows then have an order of their own, and held vertices have none of them.
TEST(ImplicitSystem, SolvesWhereSpringsJoinVerticesFarApartByNumber) {
  const auto model = ChainOfTwoHalves(10000);
  ASSERT_NE(model, nullptr);
  State state = model->InitialState();
  state.x += 1e-3 * RandomPoints(state.x.cols(), 1);
  const EvalContext at = MakeEvalContext(*model, model->parameters, state);
  const Points b = RandomPoints(state.x.cols(), 2);
  ImplicitSystem system(*model);
  system.Assemble(*model, at, 0.01);
  Points y = Points::Zero(3, b.cols());
  SolverEffort effort;
  effort.Begin(0);
  ASSERT_TRUE(system.Solve(*model, at, b, 1e-4, effort, y).ok());
  EXPECT_GT(effort.iterations(), 0);
  EXPECT_LT(Missing(*model, at, 0.01, b, y), 20 * 1e-4);
}

TEST(ImplicitSystem, GivesTheSameBitsOnEveryInstructionSet) {
  const auto model = Sheet(kTissues[2]);
  State state = model->InitialState();
  state.x += 2e-3 * RandomPoints(state.x.cols(), 1);
  const EvalContext at = MakeEvalContext(*model, model->parameters, state);
  const Points b = RandomPoints(state.x.cols(), 2);
  Points first;
  OnEveryTarget([&] {
    ImplicitSystem system(*model);
    system.Assemble(*model, at, 0.01);
    Points y = Points::Zero(3, b.cols());
    SolverEffort effort;
    ASSERT_TRUE(system.Solve(*model, at, b, 1e-4, effort, y).ok());
    if (first.size() == 0) first = y;
    EXPECT_EQ(y, first);
  });
}

// The solution as a guess leaves next to nothing to do.
TEST(ImplicitSystem, StartsWarm) {
  const auto model = Sheet(kTissues[0]);
  const State state = model->InitialState();
  const EvalContext at = MakeEvalContext(*model, model->parameters, state);
  const Points b = RandomPoints(state.x.cols(), 2);
  ImplicitSystem system(*model);
  system.Assemble(*model, at, 0.01);
  Points y = Points::Zero(3, b.cols());
  SolverEffort cold, warm;
  ASSERT_TRUE(system.Solve(*model, at, b, 1e-6, cold, y).ok());
  const Points solved = y;
  ASSERT_TRUE(system.Solve(*model, at, b, 1e-6, warm, y).ok());
  EXPECT_LT(warm.iterations(), cold.iterations() / 2);
  EXPECT_LT((y - solved).norm(), 1e-5 * solved.norm());
}

TEST(ImplicitSystem, KeepsItsBudgetAndSaysWhatIsLeft) {
  const auto model = Sheet("forces { springs { bodies: 'sheet' stiffness: 3e6 } }", 60, 60);
  v1::Parameters parameters = model->parameters;
  parameters.set_integrator(v1::INTEGRATOR_LINEAR_IMPLICIT_EULER);
  const auto step = [&](double budget) {
    parameters.set_solver_budget(budget);
    State state = model->InitialState();
    state.v = RandomPoints(state.v.cols(), 4);
    Workspace work = model->MakeWorkspace();
    EXPECT_TRUE(Step(*model, parameters, 0.01, state, work).ok());
    return work.effort;
  };
  const SolverEffort whole = step(0), cut = step(1e-6);
  EXPECT_GT(whole.iterations(), 20);
  EXPECT_LE(whole.residual(), 1e-3);
  EXPECT_EQ(cut.iterations(), 1);
  EXPECT_GT(cut.residual(), whole.residual());
}

// Springs that want to be a third longer than they are: the sheet buckles. Their stiffness across is negative until
// then, and is left out; where it is not, steps of 10 ms gain energy without bound.
TEST(LinearImplicitEuler, GainsNoEnergyInCompression) {
  const auto model = Sheet(
      "forces { springs { bodies: 'sheet' stiffness: 300 rest_length_ratio: 1.3 } } forces { friction { bodies: "
      "'sheet' "
      "rate: 1 } }",
      15, 15);
  v1::Parameters parameters = model->parameters;
  parameters.set_integrator(v1::INTEGRATOR_LINEAR_IMPLICIT_EULER);
  State state = model->InitialState();
  state.x += 1e-5 * RandomPoints(state.x.cols(), 3);
  Workspace work = model->MakeWorkspace();
  const auto energy = [&] {
    const EvalContext at = MakeEvalContext(*model, parameters, state);
    return model->forces.front()->Energy(at) +
           (state.v.colwise().squaredNorm().transpose().cwiseProduct(model->mass)).sum() / 2;
  };
  const double first = energy();
  for (int step = 0; step < 200; ++step) {
    ASSERT_TRUE(Step(*model, parameters, 0.01, state, work).ok()) << step;
    ASSERT_LT(energy(), first) << step;
    ASSERT_LE(work.effort.residual(), 1e-3) << step;
  }
  EXPECT_LT(energy(), 0.01 * first);  // it has let go, sideways
}

}  // namespace
}  // namespace phrenic
