// Projective dynamics: its iterations converge to backward Euler, it dissipates energy, and its matrix is exact.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "server/mechanics/integrators/projective_dynamics.h"
#include "server/mechanics/solve/prefactored_system.h"
#include "server/mechanics/step/step_plan.h"
#include "server/mesh/topology.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// A chain along x of masses of 0.5 kg between two fixed ends, with springs of 1 m; every third spring may be stiffer.
std::string PreviewChain(const std::string& forces, double stiffness = 50, double third = 50) {
  constexpr int kFree = 11;
  std::string text =
      "name: 'chain' bodies { name: 'chain' role: ROLE_DEFORMABLE mass: 6.5 fixed_vertices: [0, 12] "
      "regions { name: 'stiff' low { x: 2.5 y: -9 z: -9 } high { x: 5.5 y: 9 z: 9 } } polyhedron {";
  for (int i = 0; i <= kFree + 1; ++i) text += " vertices { x: " + std::to_string(i) + " }";
  for (int i = 0; i <= kFree; ++i) text += " edges { a: " + std::to_string(i) + " b: " + std::to_string(i + 1) + " }";
  return text +
         " } } forces { springs { bodies: 'chain' exclude_region: 'stiff' stiffness: " + std::to_string(stiffness) +
         " } } forces { springs { bodies: 'chain' region: 'stiff' stiffness: " + std::to_string(third) + " } } " +
         forces + "parameters { integrator: INTEGRATOR_PROJECTIVE_DYNAMICS }";
}

const char kPreviewGravity[] = "forces { gravity { bodies: 'chain' acceleration { z: -9.81 } } } ";

// A square net under tension, fixed along one side.
const char kNet[] = R"(
  name: "net" title: "Net"
  bodies {
    name: "net" role: ROLE_DEFORMABLE mass: 3.2 fixed_vertices: [0, 1, 2, 3, 4, 5, 6, 7]
    grid { columns: 8 rows: 8 u { x: 0.1 } v { z: -0.1 } }
  }
  forces { springs { bodies: "net" stiffness: 100 } }
  parameters { integrator: INTEGRATOR_PROJECTIVE_DYNAMICS }
)";

State Disturbed(const Model& model, double speed) {
  State state = model.InitialState();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> velocity(-speed, speed);
  for (int i = 0; i < state.v.cols(); ++i) {
    if (model.inverse_mass[i] > 0) state.v.col(i) = Eigen::Vector3d::NullaryExpr([&] { return velocity(random); });
  }
  return state;
}

State StepBy(const Integrator& integrator, const Model& model, double dt, State state) {
  Workspace work = model.MakeWorkspace();
  work.before = state.x;
  work.velocity_before = state.v;
  EXPECT_TRUE(integrator.Advance(*model.plan, model.parameters, dt, state, work).ok());
  return state;
}

// Residual of backward Euler, M (v' - v) - dt f(x'), over dt times the largest force.
double Residual(const Model& model, double dt, const State& before, const State& after) {
  Points f(3, after.x.cols());
  model.plan->SumForces(MakeEvalContext(model, model.parameters, after), f);
  double left = 0;
  for (int i = 0; i < f.cols(); ++i) {
    if (model.inverse_mass[i] == 0) continue;
    left = std::max(left, (model.mass[i] * (after.v.col(i) - before.v.col(i)) / dt - f.col(i)).norm());
  }
  return left / f.colwise().norm().maxCoeff();
}

double PreviewEnergy(const Model& model, const State& state) {
  double energy = 0.5 * state.v.colwise().squaredNorm().dot(model.mass.transpose());
  for (const auto& force : model.forces) energy += force->Energy(MakeEvalContext(model, model.parameters, state));
  return energy;
}

TEST(ProjectiveDynamics, IteratesTowardsBackwardEuler) {
  const auto model = CompileText(kNet);
  const State start = Disturbed(*model, 0.2);
  const State exact = StepBy(ProjectiveDynamics(400), *model, 0.1, start);
  EXPECT_LT(Residual(*model, 0.1, start, exact), 1e-9);
  const auto error = [&](int iterations) {
    return (StepBy(ProjectiveDynamics(iterations), *model, 0.1, start).x - exact.x).norm() / (exact.x - start.x).norm();
  };
  EXPECT_LT(error(5), 0.6);
  EXPECT_LT(error(20), 0.3 * error(5));
  EXPECT_LT(error(100), 0.01 * error(20));
}

TEST(ProjectiveDynamics, ConvergesToTheEquilibrium) {
  const auto model = CompileText(PreviewChain(kPreviewGravity));
  v1::Parameters parameters = model->parameters;
  State still = model->InitialState(), state = still;
  Workspace work = model->MakeWorkspace();
  parameters.set_integrator(v1::INTEGRATOR_STATIC);
  ASSERT_TRUE(Step(*model, parameters, 0.1, still, work).ok());
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(Step(*model, model->parameters, 0.1, state, work).ok());
  EXPECT_LT((state.x - still.x).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(ProjectiveDynamics, LosesEnergyInFreeVibrationAtAnyStep) {
  std::string tense = kNet;
  tense.replace(tense.find("stiffness: 100"), 14, "stiffness: 100 rest_length_ratio: 0.5");
  for (const std::string& scene : {std::string(kNet), tense, PreviewChain(""), PreviewChain("", 50, 5e7)}) {
    const auto model = CompileText(scene);
    for (const double dt : {1.0 / 600, 1.0 / 60, 0.1, 1.0}) {
      for (const double speed : {0.1, 1.0, 10.0}) {
        State state = Disturbed(*model, speed);
        Workspace work = model->MakeWorkspace();
        const double first = PreviewEnergy(*model, state);
        double last = first;
        for (int i = 0; i < 300; ++i) {
          ASSERT_TRUE(Step(*model, model->parameters, dt, state, work).ok());
          const double energy = PreviewEnergy(*model, state);
          ASSERT_LE(energy, last + 1e-9 * first) << "step " << i << " of " << dt << " s from " << speed << " m/s";
          last = energy;
        }
      }
    }
  }
}

TEST(ProjectiveDynamics, StaysBoundedWithAStiffnessRatioOfAMillion) {
  for (const double dt : {1.0 / 60, 0.1}) {
    const auto model = CompileText(PreviewChain(kPreviewGravity, 50, 5e7));
    State state = Disturbed(*model, 1);
    Workspace work = model->MakeWorkspace();
    double most = 0;
    for (int i = 0; i < 1000; ++i) {
      ASSERT_TRUE(Step(*model, model->parameters, dt, state, work).ok()) << i;
      most = std::max(most, (state.x - model->rest).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(most, 10) << dt;  // in equilibrium it hangs down by 6 m
  }
}

// For a net of springs at rest, A is M + g^2 sum k (e_a - e_b)(e_a - e_b)^T on the free vertices, for any direction of
// the springs.
TEST(PrefactoredSystem, IsTheLaplacianOfSpringsAtRest) {
  const auto model = CompileText(kNet);
  constexpr double kStep = 0.1, kSpring = 100;
  PrefactoredSystem system(*model);
  system.Prepare(*model, model->parameters, kStep);
  const Points b = Disturbed(*model, 1).v;
  Points y;
  system.Solve(b, y);
  Points product = y * model->mass.asDiagonal();
  const Edges edges = SpringEdges(model->bodies[0].mesh);
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const Eigen::Vector3d apart = kStep * kStep * kSpring * (y.col(edges(0, e)) - y.col(edges(1, e)));
    product.col(edges(0, e)) += apart;
    product.col(edges(1, e)) -= apart;
  }
  for (Eigen::Index i = 0; i < b.cols(); ++i) {
    if (model->inverse_mass[i] > 0) {
      EXPECT_LT((product.col(i) - b.col(i)).norm(), 1e-12) << i;
    } else {
      EXPECT_TRUE(y.col(i).isZero(0)) << i;
    }
  }
}

// A change of a live parameter changes the matrix; resetting it restores the same bits.
TEST(PrefactoredSystem, DependsOnParametersAndNotOnHistory) {
  const auto model = CompileText(kNet);
  v1::Parameters stiffer = model->parameters;
  stiffer.set_elasticity(10);
  PrefactoredSystem system(*model);
  const Points b = Disturbed(*model, 1).v;
  const auto solved = [&](const v1::Parameters& parameters, double g) {
    Points y;
    system.Prepare(*model, parameters, g);
    system.Solve(b, y);
    return y;
  };
  const Points first = solved(model->parameters, 0.1);
  EXPECT_LT(solved(stiffer, 0.1).norm(), 0.5 * first.norm());
  EXPECT_GT(solved(model->parameters, 0.01).norm(), 2 * first.norm());
  EXPECT_EQ(solved(model->parameters, 0.1), first);
}

}  // namespace
}  // namespace phrenic
