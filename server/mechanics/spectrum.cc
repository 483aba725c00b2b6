#include "server/mechanics/spectrum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "server/mechanics/advance.h"
#include "server/mechanics/block_matrix.h"

namespace phrenic {
namespace {

constexpr int kProducts = 20;
constexpr double kMostlyLeft = 0.7;
constexpr double kExhausted = 1e-11;  // a product that leaves less than this that is new leaves round-off

// y = M^-1/2 K M^-1/2 x.
class ScaledStiffness {
 public:
  ScaledStiffness(const Model& model, const Instant& at) : stiffness_(model), scale_(model.inverse_mass.cwiseSqrt()) {
    stiffness_.Assemble(model, at);
    for (const auto& force : model.forces) force->AddLatentStiffness(at, stiffness_);
  }

  Eigen::VectorXd operator*(const Eigen::VectorXd& x) const {
    const Eigen::Index n = scale_.size();
    const Points scaled = Eigen::Map<const Points>(x.data(), 3, n) * scale_.asDiagonal();
    Points product(3, n);
    stiffness_.Times(scaled, product);
    product = product * scale_.asDiagonal();
    return Eigen::Map<const Eigen::VectorXd>(product.data(), product.size());
  }

  // Deterministic and without a pattern that a mesh could share.
  Eigen::VectorXd Start() const {
    Eigen::VectorXd x(3 * scale_.size());
    std::uint64_t bits = 0x9e3779b97f4a7c15;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
      x[i] = scale_[i / 3] > 0 ? static_cast<double>(bits >> 11) * 0x1p-53 - 0.5 : 0;
    }
    return x;
  }

 private:
  BlockMatrix stiffness_;
  Eigen::VectorXd scale_;
};

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

Krylov Lanczos(const ScaledStiffness& matrix) {
  Krylov krylov;
  Eigen::VectorXd q = matrix.Start();
  double norm = q.norm();
  double largest = 0;  // product: what is left of one is measured by it, whatever the unit of stiffness
  while (static_cast<int>(krylov.basis.size()) < kProducts && norm > kExhausted * largest) {
    krylov.basis.push_back(q / norm);
    q = matrix * krylov.basis.back();
    largest = std::max(largest, q.norm());
    krylov.diagonal.push_back(q.dot(krylov.basis.back()));
    q -= krylov.diagonal.back() * krylov.basis.back();
    if (krylov.basis.size() > 1) q -= krylov.off_diagonal.back() * krylov.basis[krylov.basis.size() - 2];
    norm = Orthogonalise(krylov.basis, q);
    krylov.off_diagonal.push_back(norm);
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
  const Krylov krylov = Lanczos(ScaledStiffness(model, at));
  const auto size = static_cast<Eigen::Index>(krylov.diagonal.size());
  if (size == 0) return fastest;
  const Eigen::Map<const Eigen::VectorXd> diagonal(krylov.diagonal.data(), size);
  const Eigen::Map<const Eigen::VectorXd> off(krylov.off_diagonal.data(), size - 1);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off);
  const Eigen::VectorXd combination = solver.eigenvectors().col(size - 1);
  const double residual = krylov.off_diagonal.back() * std::abs(combination[size - 1]);
  const double eigenvalue = std::max(0.0, solver.eigenvalues()[size - 1] + residual);
  if (eigenvalue <= 0) return fastest;
  fastest.spectrum.omega_max = std::sqrt(eigenvalue);
  FindMode(model, krylov, combination, fastest);
  return fastest;
}

}  // namespace phrenic
