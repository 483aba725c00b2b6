#include "server/mechanics/spectrum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "server/mechanics/advance.h"
#include "server/mechanics/scaled_stiffness.h"

namespace phrenic {
namespace {

constexpr int kProducts = 20;
constexpr double kMostlyLeft = 0.7;
constexpr double kConverged = 1e-5;   // of the largest Ritz value: round-off over it is still small
constexpr double kExhausted = 1e-11;  // a product that leaves less than this that is new leaves round-off

// Deterministic and without a pattern that a mesh could share; zero where the scale is.
Eigen::VectorXd Start(const Eigen::VectorXd& scale) {
  Eigen::VectorXd x(3 * scale.size());
  std::uint64_t bits = 0x9e3779b97f4a7c15;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
    x[i] = scale[i / 3] > 0 ? static_cast<double>(bits >> 11) * 0x1p-53 - 0.5 : 0;
  }
  return x;
}

// Of the free vertices.
void FindLeastMass(const Model& model, Spectrum& spectrum) {
  for (Eigen::Index i = 0; i < model.mass.size(); ++i) {
    if (model.inverse_mass[i] > 0) spectrum.least_mass = std::min(spectrum.least_mass, model.mass[i]);
  }
}

void FindDampingRates(const Model& model, const Instant& at, Spectrum& spectrum) {
  Eigen::VectorXd c(model.rest.cols());
  SumDamping(model, at, c);
  spectrum.least_damping_rate = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    if (model.inverse_mass[i] == 0) continue;
    spectrum.damping_rate = std::max(spectrum.damping_rate, c[i] * model.inverse_mass[i]);
    spectrum.least_damping_rate = std::min(spectrum.least_damping_rate, c[i] * model.inverse_mass[i]);
  }
  OuterProducts shared;
  SumSharedDamping(model, at, shared);
  spectrum.damping_rate += shared.Bound(model.inverse_mass);
}

struct Krylov {
  std::vector<Eigen::VectorXd> basis;
  std::vector<double> diagonal, off_diagonal;  // of the tridiagonal matrix; one more off_diagonal than needed
};

using Ritz = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

Ritz RitzPairs(const Krylov& krylov) {
  const auto size = static_cast<Eigen::Index>(krylov.diagonal.size());
  const Eigen::Map<const Eigen::VectorXd> diagonal(krylov.diagonal.data(), size);
  const Eigen::Map<const Eigen::VectorXd> off(krylov.off_diagonal.data(), size - 1);
  Ritz pairs;
  pairs.computeFromTridiagonal(diagonal, off);
  return pairs;
}

// Whether a Ritz vector has converged: only along those does the next vector lose its right angle to the basis (Paige,
// J Inst Maths Applics 1976;18:341), by round-off over what is left of it.
bool OneHasConverged(const Krylov& krylov) {
  const Ritz pairs = RitzPairs(krylov);
  const double left = krylov.off_diagonal.back() * pairs.eigenvectors().bottomRows<1>().cwiseAbs().minCoeff();
  return left <= kConverged * pairs.eigenvalues().cwiseAbs().maxCoeff();
}

// Takes off q what of it lies along the basis, again where little is left, which may not be orthogonal (Daniel, Gragg,
// Kaufman, Stewart 1976); what is left of its length.
double Orthogonalise(const std::vector<Eigen::VectorXd>& basis, Eigen::VectorXd& q) {
  double norm = q.norm();
  for (int pass = 0; pass < 2; ++pass) {
    const double before = norm;
    for (const Eigen::VectorXd& b : basis) q -= q.dot(b) * b;
    norm = q.norm();
    if (norm > kMostlyLeft * before) break;
  }
  return norm;
}

Krylov Lanczos(ScaledStiffness& matrix) {
  Krylov krylov;
  Eigen::VectorXd q = Start(matrix.scale());
  double norm = q.norm();
  double largest = 0;  // product: what is left of one is measured by it, whatever the unit of stiffness
  bool converged = false;
  while (static_cast<int>(krylov.basis.size()) < kProducts && norm > kExhausted * largest) {
    krylov.basis.emplace_back(q / norm);
    const Eigen::VectorXd& last = krylov.basis.back();
    matrix.Times(last, q);
    largest = std::max(largest, q.norm());
    krylov.diagonal.push_back(q.dot(last));
    q -= krylov.diagonal.back() * last;
    if (krylov.basis.size() > 1) q -= krylov.off_diagonal.back() * krylov.basis[krylov.basis.size() - 2];
    krylov.off_diagonal.push_back(q.norm());
    converged = converged || OneHasConverged(krylov);
    if (converged) krylov.off_diagonal.back() = Orthogonalise(krylov.basis, q);
    norm = krylov.off_diagonal.back();
  }
  return krylov;
}

// The combination of the basis as displacements, of which the largest is of length 1.
void FindMode(const Model& model, const Krylov& krylov, const Eigen::VectorXd& combination, FastestMode& fastest) {
  Eigen::VectorXd scaled = Eigen::VectorXd::Zero(krylov.basis.front().size());
  for (size_t k = 0; k < krylov.basis.size(); ++k) {
    scaled += combination[static_cast<Eigen::Index>(k)] * krylov.basis[k];
  }
  const Eigen::Map<const Points> mode(scaled.data(), 3, scaled.size() / 3);
  Eigen::Index largest = 0;
  mode.colwise().squaredNorm().maxCoeff(&largest);
  fastest.vertex = static_cast<int>(largest);
  fastest.mode = mode * model.inverse_mass.cwiseSqrt().asDiagonal();
  fastest.mode /= fastest.mode.colwise().norm().maxCoeff();
}

}  // namespace

FastestMode FindFastestMode(const Model& model, const v1::Parameters& parameters, const State& state) {
  FastestMode fastest;
  if (model.rest.cols() == 0 || model.inverse_mass.maxCoeff() == 0) return fastest;
  const Instant at = MakeInstant(model, parameters, state);
  FindLeastMass(model, fastest.spectrum);
  FindDampingRates(model, at, fastest.spectrum);
  ScaledStiffness stiffness(model, at);
  const Krylov krylov = Lanczos(stiffness);
  if (krylov.basis.empty()) return fastest;
  const Ritz pairs = RitzPairs(krylov);
  const Eigen::VectorXd combination = pairs.eigenvectors().rightCols<1>();
  const double residual = krylov.off_diagonal.back() * std::abs(combination.tail<1>()[0]);
  const double eigenvalue = std::max(0.0, pairs.eigenvalues().tail<1>()[0] + residual);
  if (eigenvalue <= 0) return fastest;
  fastest.spectrum.omega_max = std::sqrt(eigenvalue);
  FindMode(model, krylov, combination, fastest);
  return fastest;
}

}  // namespace phrenic
