// Pressures on open surfaces, what lungs and measures refuse, and matrices of low rank.
#include "server/mechanics/breathing/chamber.h"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "server/mechanics/solve/implicit_system.h"
#include "tests/compile_text.h"
#include "tests/mechanics/every_target.h"

namespace phrenic {
namespace {

using ::testing::HasSubstr;

const char kDome[] =
    "name: 'dome' bodies { name: 'dome' role: ROLE_DEFORMABLE ellipsoid { radii { x: 1 y: 1 z: 1 } divisions: 3 "
    "upper_half: true } fixed_regions: 'rim' regions { name: 'top' low { x: -1 y: -1 z: 0.9 } high { x: 1 y: 1 z: 1 } "
    "} "
    "} bodies { name: 'wire' role: ROLE_AT_REST polyhedron { vertices {} vertices { x: 1 } edges { a: 0 b: 1 } } } ";

Points RandomPoints(int columns, int seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  return Points::NullaryExpr(3, columns, [&] { return value(random); });
}

struct LooseTriangles {
  Triangles triangles;
  Points x, v;
};

LooseTriangles RandomTriangles(int triangles) {
  constexpr int kCorners = 40;
  std::mt19937 random(triangles);
  std::uniform_int_distribution<int> vertex(0, kCorners - 1);
  LooseTriangles made{Triangles::NullaryExpr(3, triangles, [&] { return vertex(random); }), RandomPoints(kCorners, 1),
                      RandomPoints(kCorners, 2)};
  made.triangles(0, triangles - 1) = kCorners - 1;  // nothing follows it in memory
  return made;
}

// Each triangle's prism down to the plane, and its rate, one by one.
ChamberReading OneByOne(const LooseTriangles& of, double height) {
  ChamberReading sum;
  for (const auto& at : of.triangles.colwise()) {
    const Eigen::Vector3d a = of.x.col(at[0]), b = of.x.col(at[1]), c = of.x.col(at[2]);
    const Eigen::Vector3d da = of.v.col(at[0]), db = of.v.col(at[1]), dc = of.v.col(at[2]);
    const double heights = a.z() + b.z() + c.z() - 3 * height, rise = da.z() + db.z() + dc.z();
    const double widening = (db - da).cross(c - a).z() + (b - a).cross(dc - da).z();
    sum.volume += heights * (b - a).cross(c - a).z() / 6;
    sum.flow += (rise * (b - a).cross(c - a).z() + heights * widening) / 6;
  }
  return sum;
}

TEST(SumTriangles, GivesWhatTheyGiveOneByOneWithTheSameBitsOnEveryInstructionSet) {
  for (const int triangles : {1, 7, 8, 9, 1000}) {
    const LooseTriangles surface = RandomTriangles(triangles);
    const std::vector<TrianglePacket> packets = PackTriangles(surface.triangles);
    const auto sum = [&] { return SumTriangles(packets, 0.3, surface.x.data(), surface.v.data()); };
    const ChamberReading here = sum(), exact = OneByOne(surface, 0.3);
    EXPECT_NEAR(here.volume, exact.volume, 1e-13 * triangles);
    EXPECT_NEAR(here.flow, exact.flow, 1e-13 * triangles);
    OnEveryTarget([&] {
      EXPECT_EQ(sum().volume, here.volume);
      EXPECT_EQ(sum().flow, here.flow);
      EXPECT_EQ(SumTriangles(packets, 0.3, surface.x.data()).volume, here.volume);
    });
  }
}

TEST(SumTriangles, OfNoneIsNothing) { EXPECT_EQ(SumTriangles(PackTriangles(Triangles(3, 0)), 1, nullptr).volume, 0); }

// Where the rim stays, the push along the normals is minus the gradient of -p V + (V - V0)^2/(2 C).
TEST(PressureOnADome, HasAnEnergyWhereTheRimIsHeld) {
  const auto model = CompileText(std::string(kDome) +
                                 "forces { pressure { surface { bodies: 'dome' } pressure: 3 compliance: 0.5 } }");
  const Force& force = *model->forces.front();
  ASSERT_TRUE(force.conservative());
  State state = model->InitialState();
  const auto energy = [&] { return force.Energy(MakeEvalContext(*model, model->parameters, state)); };
  const Points shift = 0.1 * RandomPoints(static_cast<int>(state.x.cols()), 3);
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (model->inverse_mass[i] > 0) state.x.col(i) += shift.col(i);
  }
  Points f = Points::Zero(3, state.x.cols());
  force.AddForce(MakeEvalContext(*model, model->parameters, state), f);
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (model->inverse_mass[i] == 0) continue;
    double& z = state.x(2, i);
    const double there = z;
    z = there + 1e-6;
    const double high = energy();
    z = there - 1e-6;
    const double low = energy();
    z = there;
    EXPECT_NEAR(f(2, i), -(high - low) / 2e-6, 1e-6);
  }
}

TEST(PressureOnADome, HasNoEnergyWhereTheRimIsFree) {
  const auto model = CompileText(
      "name: 'sheet' bodies { name: 'sheet' role: ROLE_DEFORMABLE grid { columns: 3 rows: 3 u { x: 1 } v { y: 1 } } } "
      "forces { pressure { surface { bodies: 'sheet' } pressure: 3 } }");
  EXPECT_FALSE(model->forces.front()->conservative());
}

TEST(PressureOnADome, IsLeftOutWhereItIsNothing) {
  const auto model = CompileText(std::string(kDome) + "forces { pressure { surface { bodies: 'dome' } } }");
  EXPECT_TRUE(model->forces.empty());
  EXPECT_EQ(model->report.left_out(0).what(), "pressure:dome");
}

TEST(Chamber, WhatCannotBeMeasuredIsRefusedWithFieldAndRemedy) {
  const struct {
    const char* text;
    const char* words;
  } cases[] = {
      {"forces { lungs {} }", "forces[0].lungs: bounds no thorax: set floor, walls or both"},
      {"forces { lungs { floor { bodies: 'chest' } } }", "forces[0].lungs.floor.bodies[0]: there is no body"},
      {"forces { pressure { surface { bodies: 'wire' } pressure: 1 } }", "its role must be ROLE_DEFORMABLE"},
      {"forces { pressure { surface { bodies: 'dome' facing { z: -1 } } pressure: 1 } }", "chooses no triangle"},
      {"forces { pressure { surface { bodies: 'dome' } pressure: 1e9 } }", "pressure: 1e+09 is outside"},
      {"forces { lungs { floor { bodies: 'dome' } compliance: 0 } }", "compliance: 0 is outside"},
      {"measures { name: 'v' volume { surface { bodies: 'wire' } } }",
       "measures[0].volume.surface: chooses no triangle"},
      {"measures { name: 'v' volume { surface { bodies: 'dome' region: 'rim' } } }", "chooses no triangle"},
      {"measures { name: 'v' volume { surface { bodies: 'dome' } plane { normal {} } } }",
       "plane.normal: has no direc"},
      {"measures { name: 'v' }", "measures[0]: says no kind"},
      {"measures { name: 'h' highest { body: 'dome' direction {} } }", "direction: has no direction"},
      {"measures { name: 'h' highest { body: 'dome' } } measures { name: 'h' highest { body: 'dome' } }",
       "two measures"},
      {"measures { name: 'e' kinetic_energy { bodies: 'wire' } }", "ROLE_DEFORMABLE"},
      {"measures { name: 'e' elastic_energy { forces: 'x' } }", "there is no force \"x\"; there is none"},
      {"forces { friction { bodies: 'dome' } } measures { name: 'e' elastic_energy { forces: 'friction:dome' } }",
       "\"friction:dome\" has no energy"},
      {"forces { name: 'l' lungs { floor { bodies: 'dome' } } } measures { name: 'e' force_output { force: 'l' output: "
       "'pressure' } }",
       "it has volume, flow, alveolar_pressure, pleural_pressure"},
  };
  for (const auto& bad : cases) {
    const auto model = TryCompileText(std::string(kDome) + bad.text);
    ASSERT_FALSE(model.ok()) << bad.text;
    EXPECT_THAT(std::string(model.status().message()), HasSubstr(bad.words)) << bad.text;
  }
}

TEST(OuterProducts, CorrectAnInverse) {
  constexpr int kColumns = 4;
  OuterProducts products;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * kColumns, 3 * kColumns);
  for (int term = 0; term < 3; ++term) {
    const Points g = RandomPoints(kColumns, term);
    products.Add(term + 1, g);
    matrix += (term + 1) * g.reshaped() * g.reshaped().transpose();
  }
  const Points b = RandomPoints(kColumns, 9);
  Points product = Points::Zero(3, kColumns);
  products.AddTimes(2, b, product);
  EXPECT_LT((product.reshaped() - 2 * matrix * b.reshaped()).norm(), 1e-12);
  Points y = b / 5;
  products.Correct(
      2, [](const Points& right, Points& left) { left = right / 5; }, y);
  const Eigen::MatrixXd whole = 5 * Eigen::MatrixXd::Identity(3 * kColumns, 3 * kColumns) + 2 * matrix;
  EXPECT_LT((whole * y.reshaped() - b.reshaped()).norm(), 1e-12);
}

// By the matrix itself; more columns than a packet of the kernel, and some over.
TEST(OuterProducts, CorrectAStep) {
  constexpr int kColumns = 21;
  constexpr double kStep = 0.3;
  OuterProducts products;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * kColumns, 3 * kColumns);
  for (int term = 0; term < 3; ++term) {
    const Points g = RandomPoints(kColumns, term);
    products.Add(term + 1, g);
    matrix += kStep * (term + 1) * g.reshaped() * g.reshaped().transpose();
  }
  Eigen::VectorXd weights = RandomPoints(kColumns, 7).row(0).cwiseAbs().array() + 0.1;
  weights[4] = 0;  // does not move
  const Points start = RandomPoints(kColumns, 8), gain = RandomPoints(kColumns, 9) * weights.asDiagonal();
  Points v = start + gain, x = kStep * v;
  products.CorrectStep(kStep, weights, start, v, x);
  EXPECT_EQ(v.col(4), start.col(4));
  EXPECT_LT((x - kStep * v).norm(), 1e-12);
  // (1/W + dt S) corrected = 1/W gain, times W.
  const Points corrected = v - start;
  Points damped = (matrix * corrected.reshaped()).reshaped(3, kColumns) * weights.asDiagonal();
  EXPECT_LT((corrected + damped - gain).norm(), 1e-12);
}

// A tolerance that no iteration meets brings the factorisation on.
TEST(ImplicitSystemWithLungs, FactorisesToWhatIterationsFind) {
  const auto model =
      CompileText(std::string(kDome) +
                  "forces { membrane { bodies: 'dome' } } forces { pressure { surface { bodies: 'dome' } "
                  "compliance: 0.01 } } forces { lungs { floor { bodies: 'dome' } compliance: 0.02 "
                  "resistance: 70 } }");
  const State state = model->InitialState();
  const Points b = RandomPoints(static_cast<int>(state.x.cols()), 5);
  ImplicitSystem system(*model);
  const EvalContext at = MakeEvalContext(*model, model->parameters, state);
  system.Assemble(*model, at, 0.1);
  Points iterated = Points::Zero(3, b.cols()), factorised = iterated;
  SolverEffort iterations, none;
  ASSERT_TRUE(system.Solve(*model, at, b, 1e-6, iterations, iterated).ok());
  ASSERT_GT(iterations.iterations(), 0);
  ASSERT_TRUE(system.Solve(*model, at, b, std::nan(""), none, factorised).ok());
  ASSERT_EQ(none.iterations(), 0);
  EXPECT_LT((iterated - factorised).norm(), 1e-4 * iterated.norm());
}

}  // namespace
}  // namespace phrenic
