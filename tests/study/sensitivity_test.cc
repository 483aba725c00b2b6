// Indices of functions whose indices are known, and the studies of a scene whose answer is known: a weight that hangs
// on a spring comes to rest m g/k below.
#include "server/study/uncertainty/sensitivity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "absl/strings/str_cat.h"
#include "server/study/uncertainty/chaos.h"
#include "server/study/uncertainty/percentiles.h"
#include "tests/study/run_on.h"

namespace phrenic::study {
namespace {

using ::testing::Each;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr double kPi = std::numbers::pi;

using UnitFunction = double (*)(const double* u);

// sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1, each uniform in -pi to pi (Ishigami and Homma 1990).
double Ishigami(const double* u) {
  const double x[] = {kPi * (2 * u[0] - 1), kPi * (2 * u[1] - 1), kPi * (2 * u[2] - 1)};
  return std::sin(x[0]) + 7 * std::pow(std::sin(x[1]), 2) + 0.1 * std::pow(x[2], 4) * std::sin(x[0]);
}

// Of the formulas with a = 7, b = 0.1: V1 = (1 + b pi^4/5)^2/2, V2 = a^2/8, V13 = 8 b^2 pi^8/225.
constexpr double kIshigamiFirst[] = {0.3139, 0.4424, 0};
constexpr double kIshigamiTotal[] = {0.5576, 0.4424, 0.2437};

constexpr double kG[] = {0, 1, 4.5, 9};

// Sobol's g-function: the product of (|4 u - 2| + a)/(1 + a).
double GFunction(const double* u) {
  double product = 1;
  for (size_t i = 0; i < 4; ++i) product *= (std::abs(4 * u[i] - 2) + kG[i]) / (1 + kG[i]);
  return product;
}

struct KnownIndices {
  std::vector<double> first, total;
};

// By V_i = 1/(3 (1 + a_i)^2) and V = prod (1 + V_i) - 1.
KnownIndices IndicesOfG() {
  KnownIndices known;
  double all = 1;
  for (const double a : kG) all *= 1 + 1 / (3 * std::pow(1 + a, 2));
  for (const double a : kG) {
    const double own = 1 / (3 * std::pow(1 + a, 2));
    known.first.push_back(own / (all - 1));
    known.total.push_back(own * all / (1 + own) / (all - 1));
  }
  return known;
}

std::vector<double> ValuesAt(const UnitPoints& points, UnitFunction f) {
  std::vector<double> values;
  for (Eigen::Index j = 0; j < points.rows(); ++j) values.push_back(f(points.row(j).data()));
  return values;
}

TEST(SobolIndices, AreThoseOfIshigami) {
  const auto indices = SobolIndices(ValuesAt(SaltelliPoints(4096, 3, 1), &Ishigami), 3, 1);
  ASSERT_THAT(indices, SizeIs(3));
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(indices[i].first, kIshigamiFirst[i], 0.02) << i;
    EXPECT_NEAR(indices[i].total, kIshigamiTotal[i], 0.02) << i;
    EXPECT_LE(indices[i].first_within->low, kIshigamiFirst[i] + 0.02);
    EXPECT_GE(indices[i].first_within->high, kIshigamiFirst[i] - 0.02);
    EXPECT_LT(indices[i].total_within->high - indices[i].total_within->low, 0.1);
  }
}

TEST(SobolIndices, AreThoseOfTheGFunction) {
  const auto indices = SobolIndices(ValuesAt(SaltelliPoints(4096, 4, 1), &GFunction), 4, 1);
  const KnownIndices known = IndicesOfG();
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(indices[i].first, known.first[i], 0.02) << i;
    EXPECT_NEAR(indices[i].total, known.total[i], 0.02) << i;
  }
}

TEST(SobolIndices, LeaveOutRunsThatFailed) {
  std::vector<double> values = ValuesAt(SaltelliPoints(4096, 3, 1), &Ishigami);
  for (size_t j = 0; j < values.size(); j += 97) values[j] = std::nan("");
  EXPECT_NEAR(SobolIndices(values, 3, 1)[1].first, kIshigamiFirst[1], 0.03);
  EXPECT_THAT(SobolIndices(std::vector<double>(50, std::nan("")), 3, 1), SizeIs(0));
}

TEST(SobolIndices, DoNotExistForAConstant) { EXPECT_THAT(SobolIndices(std::vector<double>(50, 2.5), 3, 1), SizeIs(0)); }

TEST(PolynomialChaos, HasTheIndicesOfIshigamiAndPredictsIt) {
  const UnitPoints points = SobolPoints(600, 3, 1);
  const ChaosFit fit = FitChaos(points, ValuesAt(points, &Ishigami), 9);
  ASSERT_THAT(fit.indices, SizeIs(3));
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(fit.indices[i].first, kIshigamiFirst[i], 0.01) << i;
    EXPECT_NEAR(fit.indices[i].total, kIshigamiTotal[i], 0.01) << i;
  }
  EXPECT_NEAR(fit.mean, 3.5, 0.02);
  EXPECT_NEAR(fit.deviation, 3.7208, 0.05);
  EXPECT_GT(fit.predicted_share, 0.99);
}

// A degree that cannot follow the function says so.
TEST(PolynomialChaos, OfTooLowADegreePredictsLittle) {
  const UnitPoints points = SobolPoints(600, 3, 1);
  EXPECT_LT(FitChaos(points, ValuesAt(points, &Ishigami), 2).predicted_share, 0.5);
}

TEST(PolynomialChaos, IsExactForAPolynomialOfItsDegree) {
  const UnitPoints points = SobolPoints(40, 2, 3);
  const ChaosFit fit = FitChaos(points, ValuesAt(points, [](const double* u) { return 3 * u[0] + u[0] * u[1]; }), 2);
  // With a = u0 - 1/2 and b = u1 - 1/2: 1.75 + 3.5 a + 0.5 b + a b; the variance of a is 1/12.
  const double variance = (3.5 * 3.5 + 0.5 * 0.5) / 12 + 1.0 / 144;
  EXPECT_NEAR(fit.mean, 1.75, 1e-12);
  EXPECT_NEAR(fit.deviation, std::sqrt(variance), 1e-12);
  EXPECT_NEAR(fit.indices[1].first, 0.25 / 12 / variance, 1e-12);
  EXPECT_NEAR(fit.indices[1].total, (0.25 / 12 + 1.0 / 144) / variance, 1e-12);
  EXPECT_NEAR(fit.predicted_share, 1, 1e-12);
}

TEST(PolynomialChaos, NeedsMoreRunsThanCoefficients) {
  const UnitPoints points = SobolPoints(6, 2, 1);
  EXPECT_EQ(FitChaos(points, ValuesAt(points, [](const double* u) { return u[0]; }), 2).terms, 0);
}

TEST(Screening, FindsTheEffectsOfALinearFunctionAndNoMore) {
  const UnitPoints points = MorrisPoints(5, 3, 1);
  const auto effects = ElementaryEffects(points, ValuesAt(points, [](const double* u) { return 4 * u[0] - 2 * u[2]; }));
  EXPECT_NEAR(effects[0].mean, 4, 1e-12);
  EXPECT_NEAR(effects[1].mean_size, 0, 1e-12);
  EXPECT_NEAR(effects[2].mean, -2, 1e-12);
  EXPECT_NEAR(effects[2].mean_size, 2, 1e-12);
  EXPECT_NEAR(effects[0].deviation, 0, 1e-12);
}

TEST(Screening, RanksTheGFunctionAndSeesItsCurvature) {
  const UnitPoints points = MorrisPoints(40, 4, 1);
  const auto effects = ElementaryEffects(points, ValuesAt(points, &GFunction));
  for (size_t i = 1; i < 4; ++i) EXPECT_GT(effects[i - 1].mean_size, effects[i].mean_size) << i;
  EXPECT_GT(effects[0].deviation, effects[0].mean_size / 2);
}

TEST(Points, LieInTheCubeAndAreTheSameForASeed) {
  EXPECT_EQ(SobolPoints(64, 5, 7), SobolPoints(64, 5, 7));
  EXPECT_NE(SobolPoints(64, 5, 7), SobolPoints(64, 5, 8));
  EXPECT_GT(SobolPoints(64, 5, 7).minCoeff(), 0);
  EXPECT_LT(SobolPoints(64, 5, 7).maxCoeff(), 1);
  EXPECT_GE(MorrisPoints(20, 6, 1).minCoeff(), 0);
  EXPECT_LE(MorrisPoints(20, 6, 1).maxCoeff(), 1);
}

// A net: each of 64 points in a different 64th of every input.
TEST(Points, OfSobolFillEachInputEvenly) {
  const UnitPoints points = SobolPoints(64, 5, 7);
  for (Eigen::Index i = 0; i < 5; ++i) {
    std::set<int> cells;
    // The sequence begins with its second point, so that a point of the next 64 takes the place of one.
    for (Eigen::Index j = 0; j < 63; ++j) cells.insert(static_cast<int>(64 * points(j, i)));
    EXPECT_EQ(cells.size(), 63u) << i;
  }
}

TEST(Percentiles, AreThoseOfTheSortedSample) {
  EXPECT_DOUBLE_EQ(Percentile({3, 1, 2}, 50), 2);
  EXPECT_DOUBLE_EQ(Percentile({3, 1, 2}, 0), 1);
  EXPECT_DOUBLE_EQ(Percentile({3, 1, 2}, 75), 2.5);
  EXPECT_DOUBLE_EQ(DeviationOf({1, 2, 3}), 1);
}

// A weight of 0.1 kg hangs on a spring of 50 N/m times the elasticity: 0.01962 m/elasticity below its place at rest.
const char kHangingWeight[] = R"(
  name: "weight" title: "Weight"
  bodies {
    name: "weight" role: ROLE_DEFORMABLE mass: 0.2
    polyhedron { vertices { } vertices { z: -0.1 } edges { a: 0 b: 1 } }
    fixed_vertices: 0
  }
  forces { springs { bodies: "weight" stiffness: 50 } }
  forces { gravity { bodies: "weight" acceleration { z: -9.81 } } }
  measures { name: "height" highest { body: "weight" direction { z: -1 } point { z: -0.1 } } }
  parameters { integrator: INTEGRATOR_STATIC }
)";
constexpr double kSag = 0.1 * 9.81 / 50;  // [m]

v1::UncertainInput Uniform(const std::string& parameter, double low, double high) {
  v1::UncertainInput input;
  input.set_parameter(parameter);
  input.mutable_uniform()->set_low(low);
  input.mutable_uniform()->set_high(high);
  return input;
}

v1::StudiedOutput Height() {
  v1::StudiedOutput output;
  output.set_measure("height");
  output.set_statistic(v1::STATISTIC_LAST);
  return output;
}

template <typename Study>
void Fill(Study& study) {
  *study.add_inputs() = Uniform("elasticity", 0.5, 1.5);
  *study.add_inputs() = Uniform("breath_force", 0, 2);
  *study.add_outputs() = Height();
  study.set_seconds(0.1);
  study.set_threads(1);
}

v1::CreateStudyRequest SensitivityOfWeight() {
  v1::CreateStudyRequest request;
  Fill(*request.mutable_sensitivity());
  request.mutable_sensitivity()->set_degree(6);
  request.mutable_sensitivity()->set_samples(256);
  return request;
}

v1::CreateStudyRequest UncertaintyOfWeight() {
  v1::CreateStudyRequest request;
  Fill(*request.mutable_uncertainty());
  request.mutable_uncertainty()->set_samples(128);
  return request;
}

TEST(SensitivityStudy, FindsThatOnlyTheSpringMatters) {
  const auto result = RunOn(kHangingWeight, SensitivityOfWeight());
  ASSERT_TRUE(result.ok()) << result.status();
  const v1::SensitivityTable& table = result->sensitivity();
  ASSERT_EQ(table.indices_size(), 4);
  for (const v1::IndexRow& row : table.indices()) {
    const double sampling_error = row.method() == "saltelli" ? 0.01 : 1e-3;
    EXPECT_NEAR(row.total(), row.input() == "elasticity" ? 1 : 0, sampling_error) << row.method();
  }
  // The mean of 1/e over e in 0.5 to 1.5 is ln 3.
  EXPECT_NEAR(table.fits(0).mean(), kSag * std::log(3), 1e-4 * kSag);
  EXPECT_EQ(table.failed(), 0);
  EXPECT_EQ(table.runs(), 6 * 3 + 57 + 256 * 4);
  EXPECT_THAT(table.advice(), HasSubstr("elasticity"));
}

TEST(SensitivityStudy, KeepsTheInputsThatScreeningFinds) {
  v1::CreateStudyRequest request = SensitivityOfWeight();
  request.mutable_sensitivity()->set_kept(1);
  const auto result = RunOn(kHangingWeight, request);
  ASSERT_TRUE(result.ok()) << result.status();
  for (const v1::IndexRow& row : result->sensitivity().indices()) EXPECT_EQ(row.input(), "elasticity");
  EXPECT_TRUE(result->sensitivity().screening(0).kept());
  EXPECT_FALSE(result->sensitivity().screening(1).kept());
}

TEST(UncertaintyStudy, HasThePercentilesOfTheExactAnswer) {
  const auto result = RunOn(kHangingWeight, UncertaintyOfWeight());
  ASSERT_TRUE(result.ok()) << result.status();
  const v1::BandRow& band = result->uncertainty().bands(0);
  EXPECT_NEAR(band.nominal(), kSag, 1e-6 * kSag);
  EXPECT_NEAR(band.p50(), kSag, 0.02 * kSag);
  EXPECT_NEAR(band.p5(), kSag / 1.45, 0.02 * kSag);
  EXPECT_NEAR(band.p95(), kSag / 0.55, 0.04 * kSag);
  EXPECT_EQ(result->uncertainty().samples(0).values_size(), 128);
}

TEST(UncertaintyStudy, HasTheSameNumbersAtAnyNumberOfThreads) {
  v1::CreateStudyRequest request = UncertaintyOfWeight();
  const auto one = RunOn(kHangingWeight, request);
  request.mutable_uncertainty()->set_threads(3);
  const auto three = RunOn(kHangingWeight, request);
  ASSERT_TRUE(one.ok() && three.ok());
  EXPECT_EQ(one->uncertainty().SerializeAsString(), three->uncertainty().SerializeAsString());
  request.mutable_uncertainty()->set_seed(2);
  EXPECT_NE(one->uncertainty().SerializeAsString(), RunOn(kHangingWeight, request)->uncertainty().SerializeAsString());
}

TEST(UncertaintyStudy, CutsADistributionAtTheParametersRange) {
  v1::CreateStudyRequest request = UncertaintyOfWeight();
  v1::UncertainInput& input = *request.mutable_uncertainty()->mutable_inputs(1);
  input.mutable_normal()->set_mean(0);
  input.mutable_normal()->set_deviation(1);
  const auto result = RunOn(kHangingWeight, request);
  ASSERT_TRUE(result.ok()) << result.status();
  // breath_force is never negative: half of the normal distribution is left, whose median is at its upper quartile.
  EXPECT_NEAR(result->uncertainty().inputs(1).p50(), 0.6745, 0.01);
}

TEST(ConvergenceStudy, OfAnExactAnswerFindsNoChange) {
  v1::CreateStudyRequest request;
  v1::ConvergenceStudy& study = *request.mutable_convergence();
  *study.add_outputs() = Height();
  study.set_seconds(0.1);
  const auto result = RunOn(kHangingWeight, request);
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_EQ(result->convergence().rows_size(), 3);
  for (const v1::ConvergenceRow& row : result->convergence().rows()) {
    EXPECT_NEAR(row.value(), kSag, 1e-6 * kSag) << row.to();
    EXPECT_NEAR(row.change_percent(), 0, 1e-4) << row.to();
  }
}

// A weight that swings: its amplitude after a time depends on the step, by its order.
TEST(ConvergenceStudy, FindsTheOrderOfTheIntegrator) {
  v1::CreateStudyRequest request;
  v1::ConvergenceStudy& study = *request.mutable_convergence();
  *study.add_outputs() = Height();
  study.set_seconds(0.512);
  study.set_halvings(3);
  study.add_integrators(v1::INTEGRATOR_SEMI_IMPLICIT_EULER);
  request.mutable_parameters()->set_integrator(v1::INTEGRATOR_VELOCITY_VERLET);
  request.mutable_parameters()->set_time_step(0.008);
  const auto result = RunOn(kHangingWeight, request);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_NEAR(result->convergence().rows(3).order(), 2, 0.1);
  EXPECT_EQ(result->convergence().rows(4).varied(), "integrator");
  EXPECT_GT(std::abs(result->convergence().rows(4).change_percent()), 0.01);
}

std::string ErrorOf(const v1::CreateStudyRequest& request) {
  return std::string(RunOn(kHangingWeight, request).status().message());
}

TEST(SensitivityStudy, NamesTheFieldOfABadRequest) {
  v1::CreateStudyRequest request = SensitivityOfWeight();
  v1::SensitivityStudy& study = *request.mutable_sensitivity();
  *study.mutable_inputs(1) = Uniform("elastcity", 1, 2);
  EXPECT_THAT(ErrorOf(request), HasSubstr("inputs[1].parameter: there is no parameter \"elastcity\"; did you mean"));
  *study.mutable_inputs(1) = Uniform("elasticity", 1, 2);
  EXPECT_THAT(ErrorOf(request), HasSubstr("inputs[1].parameter: elasticity is varied twice"));
  *study.mutable_inputs(1) = Uniform("integrator", 1, 2);
  EXPECT_THAT(ErrorOf(request), HasSubstr("integrator is no number"));
  *study.mutable_inputs(1) = Uniform("breath_force", 2, 2);
  EXPECT_THAT(ErrorOf(request), HasSubstr("inputs[1].uniform.high: must be above low"));
  *study.mutable_inputs(1) = Uniform("breath_force", -1, 2);
  EXPECT_THAT(ErrorOf(request), HasSubstr("inputs[1].uniform.low: -1 is outside"));
  study.mutable_inputs(1)->clear_distribution();
  EXPECT_THAT(ErrorOf(request), HasSubstr("inputs[1]: needs a distribution"));
  study.clear_inputs();
  EXPECT_THAT(ErrorOf(request), HasSubstr("inputs: at least one is needed"));
}

// A name with bounds would be another name for the same parameter.
TEST(SensitivityStudy, VariesAParameterOnce) {
  v1::CreateStudyRequest request = SensitivityOfWeight();
  *request.mutable_sensitivity()->mutable_inputs(1) = Uniform("elasticity:0:5", 1, 2);
  EXPECT_THAT(ErrorOf(request), HasSubstr("inputs[1].parameter: is a name without bounds"));
}

// What a request names and how often decides what a study keeps in memory.
TEST(UncertaintyStudy, IsBounded) {
  v1::CreateStudyRequest request = UncertaintyOfWeight();
  v1::UncertaintyStudy& study = *request.mutable_uncertainty();
  study.set_samples(1 << 20);
  EXPECT_THAT(ErrorOf(request), HasSubstr("samples: these are 1.049e+06 runs, more than 200000"));
  study.set_samples(128);
  *study.add_outputs() = study.outputs(0);
  EXPECT_THAT(ErrorOf(request), HasSubstr("is named twice"));
}

TEST(ConvergenceStudy, IsBounded) {
  v1::CreateStudyRequest request;
  v1::ConvergenceStudy& study = *request.mutable_convergence();
  for (int i = 0; i < 2; ++i) study.add_integrators(v1::INTEGRATOR_BDF2);
  EXPECT_THAT(ErrorOf(request), HasSubstr("integrators: one is named twice"));
  study.clear_integrators();
  for (int i = 0; i < 17; ++i) study.add_resolutions_mm(3 + i);
  EXPECT_THAT(ErrorOf(request), HasSubstr("resolutions_mm: at most 16"));
  study.set_resolutions_mm(1, 3);
  EXPECT_THAT(ErrorOf(request), HasSubstr("resolutions_mm: one is named twice"));
}

TEST(SensitivityStudy, NamesTheMeasuresThatThereAre) {
  v1::CreateStudyRequest request = SensitivityOfWeight();
  v1::SensitivityStudy& study = *request.mutable_sensitivity();
  study.mutable_outputs(0)->set_measure("hight");
  EXPECT_THAT(ErrorOf(request), HasSubstr("outputs[0].measure: there is no measure \"hight\"; did you mean height?"));
  study.mutable_outputs(0)->set_measure("height");
  study.mutable_outputs(0)->clear_statistic();
  EXPECT_THAT(ErrorOf(request), HasSubstr("outputs[0].statistic: must be set"));
}

TEST(SensitivityStudy, RefusesMoreRunsThanAreAllowed) {
  v1::CreateStudyRequest request = SensitivityOfWeight();
  request.mutable_sensitivity()->set_samples(1 << 20);
  EXPECT_THAT(ErrorOf(request), HasSubstr("more than 200000"));
  request = SensitivityOfWeight();
  request.mutable_sensitivity()->set_trajectories(0);
  request.mutable_sensitivity()->set_degree(0);
  request.mutable_sensitivity()->set_samples(0);
  EXPECT_THAT(ErrorOf(request), HasSubstr("one of them must be more"));
}

TEST(SensitivityStudy, StopsWhenCancelled) {
  const auto result =
      RunOn(kHangingWeight, SensitivityOfWeight(), [](double done, std::string_view) { return done < 0.2; });
  EXPECT_TRUE(absl::IsCancelled(result.status())) << result.status();
}

// Runs that diverge are counted and said, and leave the others alone.
TEST(UncertaintyStudy, CountsRunsThatDiverge) {
  v1::CreateStudyRequest request = UncertaintyOfWeight();
  request.mutable_uncertainty()->set_seconds(5);
  request.mutable_uncertainty()->clear_inputs();
  *request.mutable_uncertainty()->add_inputs() = Uniform("elasticity", 0.5, 4);
  request.mutable_parameters()->set_integrator(v1::INTEGRATOR_VELOCITY_VERLET);
  request.mutable_parameters()->set_time_step(0.06);  // stable up to an elasticity of 2.2
  const auto result = RunOn(kHangingWeight, request);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_NEAR(static_cast<double>(result->uncertainty().failed()), 128 * 1.8 / 3.5, 12);
  EXPECT_THAT(result->uncertainty().problem(), HasSubstr("diverged"));
}

}  // namespace
}  // namespace phrenic::study
