// The laws that every force keeps. A new force joins with one line in kForces.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "server/mechanics/solve/block_matrix.h"
#include "server/mechanics/step/step_plan.h"
#include "tests/compile_text.h"
#include "tests/contract/allocations.h"

namespace phrenic {
namespace {

struct ForceCase {
  const char* name;
  const char* text;         // one force of the scene
  bool internal;            // its forces and torques sum to zero, and a rigid motion changes nothing
  bool turns = false;       // follows normals as they turn, which is indefinite and left out of its stiffness
  double rounding = 1e-12;  // of its forces in these scenes [N]

  // Of a difference that is to show a derivative [m], and how near that comes [N/m].
  double Shift() const { return rounding > 1e-12 ? std::cbrt(rounding) : 1e-6; }
  double Slope() const { return rounding / Shift(); }
};

// Its passive law is one parabola below and above rest, so that its stiffness at rest is a derivative.
#define MUSCLE                                                                                                  \
  "muscle { body: 'sheet' from_region: 'left' tendon_region: 'right' passive_regions: 'front' thickness: 0.02 " \
  "active_stress: 2000 slack_stretch: 0.5 resting_tension: 0.9 passive_stiffness: 3.6 passive_growth: 1 "       \
  "resting_tension_across: 1 modulus_across: 200 shear_modulus: 100 tendon_tension: 1 tendon_stiffness: 20 "    \
  "viscosity: 0.5 tendon_viscosity: 0.8 "

const ForceCase kForces[] = {
    {"springs", "springs { bodies: 'sheet' stiffness: 30 rest_length_ratio: 0.9 }", true},
    {"springs_balanced", "springs { bodies: 'sheet' rest_length_ratio: 0.8 balanced_at_rest: true }", false},
    {"springs_material",
     "springs { bodies: 'sheet' rest_length_ratio: 0.95 material { youngs_modulus: 1000 thickness: 0.02 } }", true},
    {"springs_single", "springs { bodies: 'sheet' stiffness: 30 rest_length_ratio: 0.9 precision: PRECISION_SINGLE }",
     true, false, 1e-4},
    {"membrane", "membrane { bodies: 'sheet' youngs_modulus: 900 poissons_ratio: 0.4 thickness: 0.02 }", true},
    {"membrane_linear", "membrane { bodies: 'sheet' youngs_modulus: 900 thickness: 0.02 strain: STRAIN_LINEAR }",
     false},
    {"solid", "solid { bodies: 'block' youngs_modulus: 20 poissons_ratio: 0.4 }", true},
    {"solid_linear", "solid { bodies: 'block' youngs_modulus: 20 strain: STRAIN_LINEAR }", false},
    {"cross_layer", "cross_layer { bodies: 'block' distance: 1.5 stiffness: 20 }", true},
    {"cross_layer_bodies", "cross_layer { bodies: 'sheet' other_bodies: 'block' distance: 4 stiffness: 20 }", true},
    {"bending", "bending { bodies: 'sheet' youngs_modulus: 100 thickness: 0.3 }", true},
    {"bending_region", "bending { bodies: 'sheet' youngs_modulus: 100 thickness: 0.3 region: 'front' }", true},
    {"fibres",
     "fibres { bodies: 'sheet' from_region: 'left' to_region: 'right' modulus_along: 900 modulus_across: 200 "
     "thickness: "
     "0.02 active_stress: 300 }",
     true},
    {"muscle", MUSCLE " precision: PRECISION_DOUBLE }", true},
    {"muscle_single", MUSCLE " }", true, false, 1e-4},
    {"friction", "friction { bodies: 'sheet' rate: 2 }", false},
    {"gravity", "gravity { bodies: 'sheet' acceleration { z: -9.81 } }", false},
    {"action_line_cylinder",
     "action_line { bodies: 'sheet' origin { x: 1 y: 1 } direction { z: -1 } radius: 1.5 force: 3 "
     "fall_off: FALL_OFF_CYLINDER }",
     false},
    {"action_line_vertical",
     "action_line { bodies: 'sheet' origin {} direction { x: 1 } radius: 2 force: 3 fall_off: FALL_OFF_VERTICAL }",
     false},
    {"attachment", "attachment { bodies: 'sheet' anchors: 'bone' radius: 1.5 stiffness: 40 }", false},
    {"attachment_thesis",
     "attachment { bodies: 'sheet' anchors: 'bone' radius: 1.5 stiffness: 40 mode: ATTACHMENT_MODE_THESIS }", false},
    {"drag", "target_spring { bodies: 'sheet' displacement { x: 0.2 z: -0.3 } stiffness: 40 scaled_by_breath: true }",
     false},
    {"drag_point", "target_spring { bodies: 'sheet' region: 'left' point { z: 2 } stiffness: 40 damping_ratio: 0 }",
     false},
    {"drag_surface",
     "target_spring { bodies: 'sheet' vertices: [1, 5] surface: 'floor' stiffness: 40 damping_ratio: 0 "
     "scaled_by_breath: true }",
     false},
    {"point_load", "point_load { body: 'sheet' vertices: [2, 3] force { x: 1 z: -2 } }", false},
    {"point_load_region", "point_load { body: 'sheet' region: 'right' force { y: 3 } scaled_by_breath: true }", false},
    {"contact", "contact { bodies: 'sheet' surfaces: 'floor' depth: 0.1 load: 4 }", false},
    {"cables", "cables { body: 'sheet' stiffness: 30 rest_length_ratio: 0.9 }", true},
    {"cables_listed",
     "cables { body: 'sheet' list { links { a: 0 b: 7 } links { a: 11 b: 1 } } rest_length_ratio: 0.9 }", true},
    {"pressure", "pressure { surface { bodies: 'ball' } pressure: 4 breath_pressure: 3 }", true, true},
    {"pressure_of_a_gas", "pressure { surface { bodies: ['ball', 'block'] } compliance: 0.3 }", true},
    {"pressure_on_an_open_surface", "pressure { surface { bodies: 'sheet' } pressure: 4 compliance: 2 }", false, true},
    {"lungs", "lungs { walls { bodies: 'ball' } compliance: 0.3 resistance: 2 }", true},
    {"lungs_over_a_floor", "lungs { floor { bodies: 'ball' facing { z: 1 } } walls { bodies: 'sheet' } compliance: 2 }",
     false, true},
};

void PrintTo(const ForceCase& force, std::ostream* out) { *out << force.name; }

class ForceContract : public testing::TestWithParam<ForceCase> {
 protected:
  void SetUp() override {
    const std::string text = std::string(
        "name: 'contract' bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 2 "
        "grid { columns: 4 rows: 3 u { x: 1 } v { y: 1 z: 0.2 } } regions { name: 'left' low {} high { y: 2 z: 1 } } "
        "regions { name: 'right' low { x: 3 } high { x: 3 y: 2 z: 1 } } "
        "regions { name: 'front' low { x: 1 } high { x: 2 y: 1 z: 0.3 } } } "
        "bodies { name: 'block' role: ROLE_DEFORMABLE mass: 2 "
        "block { origin { z: 2 } size { x: 2 y: 1 z: 1 } columns: 2 rows: 1 layers: 1 } } "
        "bodies { name: 'ball' role: ROLE_DEFORMABLE mass: 2 ellipsoid { centre { z: 6 } radii { x: 1 y: 1 z: 1 } "
        "divisions: 2 } } "
        "bodies { name: 'bone' role: ROLE_AT_REST polyhedron { vertices { x: 0 y: -0.5 } vertices { x: 1 y: -0.5 } } } "
        "bodies { name: 'floor' role: ROLE_AT_REST polyhedron { vertices { x: -9 y: -9 z: 0.1 } vertices { x: 20 y: -9 "
        "z: 0.1 } vertices { y: 20 z: 0.1 } triangles { a: 0 b: 1 c: 2 } } } "
        "breath { waveform: WAVEFORM_SINE } forces { ");
    model_ = CompileText(text + GetParam().text + " }");
    ASSERT_NE(model_, nullptr);
    ASSERT_EQ(model_->forces.size(), 1u) << "the force was left out";
    state_ = model_->InitialState();
    state_.phase = 0.2;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-0.3, 0.3);
    for (double& value : state_.x.reshaped()) value += shift(random);
    for (double& value : state_.v.reshaped()) value = shift(random);
  }

  EvalContext At(const State& state) const { return MakeEvalContext(*model_, model_->parameters, state); }
  const Force& force() const { return *model_->forces.front(); }
  // As a step sums it.
  Points ForceAt(const State& state) const {
    Points f(3, state.x.cols());
    model_->plan->SumForces(At(state), f);
    return f;
  }
  Points StiffnessTimes(const State& state, const Points& dx) const {
    BlockMatrix stiffness(*model_);
    stiffness.Assemble(*model_, At(state));
    Points product(3, dx.cols());
    stiffness.Times(dx, product);
    return product;
  }
  double EnergyAt(const State& state) const { return force().Energy(At(state)); }

  std::shared_ptr<const Model> model_;
  State state_;
};

TEST_P(ForceContract, AddsAndNeverClears) {
  Points f = Points::Constant(3, state_.x.cols(), 5);
  force().AddForce(At(state_), f);
  EXPECT_LT((f.array() - 5 - ForceAt(state_).array()).abs().maxCoeff(), GetParam().rounding);
}

TEST_P(ForceContract, IsMinusEnergyGradient) {
  if (!force().conservative()) GTEST_SKIP() << "has no energy";
  state_.v.setZero();  // viscosity is not part of the energy
  const Points f = ForceAt(state_);
  for (Eigen::Index i = 0; i < state_.x.size(); ++i) {
    constexpr double kStep = 1e-6;
    State low = state_, high = state_;
    low.x.data()[i] -= kStep, high.x.data()[i] += kStep;
    EXPECT_NEAR(f.data()[i], -(EnergyAt(high) - EnergyAt(low)) / (2 * kStep), 1e-6 + GetParam().rounding);
  }
}

// At the mesh as it stands tension is not negative in any of the cases, so that nothing is left out of the derivative.
TEST_P(ForceContract, StiffnessIsForceDerivative) {
  if (GetParam().turns) GTEST_SKIP() << "what follows from the normals' turning is left out";
  const State rest = model_->InitialState();
  State low = rest, high = rest;
  const double shift = GetParam().Shift();
  const Points dx = state_.x - rest.x;
  low.x -= shift * dx, high.x += shift * dx;
  const Points df = -StiffnessTimes(rest, dx);
  const Points difference = (ForceAt(high) - ForceAt(low)) / (2 * shift);
  EXPECT_LT((df - difference).cwiseAbs().maxCoeff(), GetParam().Slope() * (1 + difference.cwiseAbs().maxCoeff()));
}

TEST_P(ForceContract, StiffnessIsSymmetricAndNeverPushesAlong) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  const auto vector = [&] { return Points(Points::NullaryExpr(3, state_.x.cols(), [&] { return value(random); })); };
  const Points a = vector(), b = vector();
  const Points ka = StiffnessTimes(state_, a), kb = StiffnessTimes(state_, b);
  EXPECT_NEAR(ka.cwiseProduct(b).sum(), kb.cwiseProduct(a).sum(), 1e-9);
  EXPECT_GE(ka.cwiseProduct(a).sum(), -1e-12);
}

// Multiplies blocks with points, one by one.
class Product final : public StiffnessSink {
 public:
  explicit Product(const Points& x) : x_(x), product(Points::Zero(3, x.cols())) {}
  void Add(int i, int j, const Eigen::Matrix3d& block) override { product.col(i) += block * x_.col(j); }
  void AddOuter(double, const Points&) override { ADD_FAILURE() << "viscosity is blocks alone"; }

 private:
  const Points& x_;

 public:
  Points product;
};

// What the velocities change of the force is -c v, vertex by vertex, what they share, and viscosity.
TEST_P(ForceContract, DampingIsTheForcesPartInVelocity) {
  State still = state_;
  still.v.setZero();
  Eigen::VectorXd c = Eigen::VectorXd::Zero(state_.x.cols());
  force().AddDamping(At(state_), c);
  EXPECT_GE(c.minCoeff(), 0);
  Points damped = state_.v * c.asDiagonal();
  OuterProducts shared;
  force().AddSharedDamping(At(state_), shared);
  EXPECT_EQ(force().has_shared_damping(), !shared.empty());
  if (!GetParam().turns) shared.AddTimes(1, state_.v, damped);
  Product viscous(state_.v);
  force().AddViscosity(At(state_), viscous);
  EXPECT_EQ(force().has_viscosity(), !viscous.product.isZero(0));
  EXPECT_GE(viscous.product.cwiseProduct(state_.v).sum(), 0) << "viscosity takes energy";
  damped += viscous.product;
  if (GetParam().turns && !shared.empty()) GTEST_SKIP() << "on a free border flow is not only the surface's own";
  EXPECT_LT((ForceAt(state_) - ForceAt(still) + damped).cwiseAbs().maxCoeff(), GetParam().rounding);
}

// What AdvanceScalars adds over a short time is that time times the rates; what it leaves at a time of 0 is no jump.
TEST_P(ForceContract, ScalarRatesAreThoseOfItsSteps) {
  const Force& force = *model_->forces.front();
  if (!force.advances_scalars()) GTEST_SKIP() << "has no scalars of its own";
  constexpr double kTime = 1e-7;
  const EvalContext at = MakeEvalContext(*model_, model_->parameters, state_);
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(state_.scalars.q.size());
  force.SetScalarRates(at, rates);
  ScalarState start = state_.scalars;
  force.AdvanceScalars(at, 0, 0, start);
  ScalarState end = start;
  force.AdvanceScalars(at, 0, kTime, end);
  for (Eigen::Index i = 0; i < rates.size(); ++i) {
    EXPECT_NEAR((end.q[i] - start.q[i]) / kTime, rates[i], 1e-4 * std::abs(rates[i]) + 1e-7) << i;
  }
}

TEST_P(ForceContract, AllocatesNothing) {
  Points f = Points::Zero(3, state_.x.cols());
  Eigen::VectorXd c = Eigen::VectorXd::Zero(state_.x.cols());
  const EvalContext at = At(state_);
  model_->plan->SumForces(at, f);
  const std::int64_t before = Allocations();
  model_->plan->SumForces(at, f);
  force().AddForce(at, f);
  force().AddDamping(at, c);
  EXPECT_EQ(Allocations(), before);
}

TEST_P(ForceContract, InternalForcesAndTorquesSumToZero) {
  if (!GetParam().internal) GTEST_SKIP() << "acts from outside";
  const Points f = ForceAt(state_);
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < f.cols(); ++i)
    torque += Eigen::Vector3d(state_.x.col(i)).cross(Eigen::Vector3d(f.col(i)));
  EXPECT_LT(f.rowwise().sum().norm(), GetParam().rounding);
  EXPECT_LT(torque.norm(), GetParam().rounding);
}

TEST_P(ForceContract, RigidMotionChangesNothing) {
  if (!GetParam().internal) GTEST_SKIP() << "acts from outside";
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  State moved = state_;
  moved.x = (turn * state_.x).colwise() + Eigen::Vector3d(4, -5, 6);
  moved.v = turn * state_.v;
  EXPECT_LT((ForceAt(moved) - turn * ForceAt(state_)).cwiseAbs().maxCoeff(), GetParam().rounding);
  EXPECT_NEAR(EnergyAt(moved), EnergyAt(state_), 1e-12);
}

TEST_P(ForceContract, IsFiniteWhereVerticesCoincide) {
  state_.x.setZero();
  EXPECT_TRUE(ForceAt(state_).allFinite());
  EXPECT_TRUE(StiffnessTimes(state_, model_->rest).allFinite());
}

INSTANTIATE_TEST_SUITE_P(Forces, ForceContract, testing::ValuesIn(kForces),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace phrenic
