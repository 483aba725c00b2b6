#include "server/mechanics/stability/spectrum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "server/mechanics/damping.h"
#include "server/mechanics/integrators/catalogue.h"
#include "server/mechanics/linalg/large_pages.h"
#include "server/mechanics/stability/scaled_stiffness.h"

namespace phrenic {
namespace {

constexpr int kProducts = 20;
constexpr int kRough = 8;        // products for a first guess of the step
constexpr double kNearby = 0.1;  // of a step: the accuracy of a guess that is good enough
constexpr int kGuesses = 4;
constexpr double kMostlyLeft = 0.7;
constexpr double kConverged = 1e-5;   // of the largest Ritz value: the residual of a converged one
constexpr double kExhausted = 1e-11;  // of a product: a smaller new component is round-off

// Returns a pseudo-random start vector, always the same; zero where the scale is.
Eigen::VectorXd Start(const Eigen::VectorXd& scale) {
  Eigen::VectorXd x(3 * scale.size());
  std::uint64_t bits = 0x9e3779b97f4a7c15;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
    x[i] = scale[i / 3] > 0 ? static_cast<double>(bits >> 11) * 0x1p-53 - 0.5 : 0;
  }
  return x;
}

// Sets the smallest mass of the free vertices.
void FindLeastMass(const Model& model, Spectrum& spectrum) {
  for (Eigen::Index i = 0; i < model.mass.size(); ++i) {
    if (model.inverse_mass[i] > 0) spectrum.least_mass = std::min(spectrum.least_mass, model.mass[i]);
  }
}

// Sums the norms of each row of blocks, scaled: upper bounds of the eigenvalues of M^-1/2 C M^-1/2 (Gershgorin).
class RowNorms final : public StiffnessSink {
 public:
  explicit RowNorms(const Eigen::VectorXd& inverse_mass)
      : scale_(inverse_mass.cwiseSqrt()), rows_(Eigen::VectorXd::Zero(inverse_mass.size())) {}
  void Add(int i, int j, const Eigen::Matrix3d& block) override { rows_[i] += scale_[i] * scale_[j] * block.norm(); }
  void AddOuter(double, const Points&) override {}
  double Largest() const { return rows_.maxCoeff(); }

 private:
  const Eigen::VectorXd scale_;
  Eigen::VectorXd rows_;
};

void FindViscousRate(const Model& model, const EvalContext& at, Spectrum& spectrum) {
  if (!HasViscosity(model)) return;
  RowNorms norms(model.inverse_mass);
  for (const auto& force : model.forces) AddViscosity(*force, at, 1, norms);
  spectrum.viscous_rate = norms.Largest();
}

void FindDampingRates(const Model& model, const EvalContext& at, Spectrum& spectrum) {
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
  FindViscousRate(model, at, spectrum);
  spectrum.damping_rate += shared.Bound(model.inverse_mass) + spectrum.viscous_rate;
}

// A list of vectors; each begins at an even index, so that sums over them are vectorised in the same way.
class Basis {
 public:
  using Column = Eigen::Map<const Eigen::VectorXd, Eigen::Aligned16>;
  explicit Basis(Eigen::Index rows) : rows_(rows) { values_.reserve(static_cast<size_t>(kProducts * Stride())); }

  // Appends q / norm.
  void Append(const Eigen::VectorXd& q, double norm) {
    values_.resize(static_cast<size_t>((size_ + 1) * Stride()));
    Eigen::Map<Eigen::VectorXd, Eigen::Aligned16>(values_.data() + size_++ * Stride(), rows_) = q / norm;
  }
  Column operator[](int k) const { return {values_.data() + k * Stride(), rows_}; }
  int size() const { return size_; }
  Eigen::Index rows() const { return rows_; }

 private:
  Eigen::Index Stride() const { return rows_ + rows_ % 2; }

  Eigen::Index rows_;
  LargeVector<double> values_;
  int size_ = 0;
};

struct Krylov {
  Basis basis;
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

// Returns true if a Ritz vector has converged: the next vector loses its orthogonality along converged ones only
// (Paige, J Inst Maths Applics 1976;18:341).
bool OneHasConverged(const Krylov& krylov) {
  const Ritz pairs = RitzPairs(krylov);
  const double left = krylov.off_diagonal.back() * pairs.eigenvectors().bottomRows<1>().cwiseAbs().minCoeff();
  return left <= kConverged * pairs.eigenvalues().cwiseAbs().maxCoeff();
}

// Orthogonalises q against the basis; twice if little of it remains, which may not be orthogonal yet (Daniel, Gragg,
// Kaufman, Stewart 1976). Returns its remaining length.
double Orthogonalise(const Basis& basis, Eigen::VectorXd& q) {
  double norm = q.norm();
  for (int pass = 0; pass < 2; ++pass) {
    const double before = norm;
    for (int k = 0; k < basis.size(); ++k) q -= q.dot(basis[k]) * basis[k];
    norm = q.norm();
    if (norm > kMostlyLeft * before) break;
  }
  return norm;
}

Krylov Lanczos(ScaledStiffness& matrix, Eigen::VectorXd q, int products) {
  Krylov krylov{.basis = Basis(q.size()), .diagonal = {}, .off_diagonal = {}};
  double norm = q.norm();
  double largest = 0;  // length of a product: the scale of what remains of one
  bool converged = false;
  while (krylov.basis.size() < products && norm > kExhausted * largest) {
    krylov.basis.Append(q, norm);
    const int k = krylov.basis.size() - 1;
    const Basis::Column last = krylov.basis[k];
    matrix.Times(last, q);
    const double along = q.dot(last);
    if (k == 0) {
      q -= along * last;
    } else {
      q = (q - along * last) - krylov.off_diagonal.back() * krylov.basis[k - 1];
    }
    krylov.diagonal.push_back(along);
    const double back = k == 0 ? 0 : krylov.off_diagonal.back(), on = q.norm();
    largest = std::max(largest, std::hypot(back, along, on));
    krylov.off_diagonal.push_back(on);
    converged = converged || OneHasConverged(krylov);
    if (converged) krylov.off_diagonal.back() = Orthogonalise(krylov.basis, q);
    norm = krylov.off_diagonal.back();
  }
  return krylov;
}

// Returns the weighted sum of the basis, part by part, so that each part stays in the L1 cache.
Eigen::VectorXd Combine(const Basis& basis, const Eigen::VectorXd& weights) {
  constexpr Eigen::Index kPart = 1024;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(basis.rows());
  for (Eigen::Index first = 0; first < sum.size(); first += kPart) {
    auto part = sum.segment(first, std::min(kPart, sum.size() - first));
    for (int k = 0; k < basis.size(); ++k) part += weights[k] * basis[k].segment(first, part.size());
  }
  return sum;
}

// An estimate of the largest eigenvalue of the matrix.
struct Largest {
  double ritz = 0;         // lower bound of the eigenvalue
  double residual = 0;     // ritz + residual is an upper bound
  Eigen::VectorXd vector;  // of length 1; no rows if no eigenvalue is above 0
};

Largest FindLargest(ScaledStiffness& matrix, const Eigen::VectorXd& start, int products) {
  const Krylov krylov = Lanczos(matrix, start, products);
  if (krylov.basis.size() == 0) return {};
  const Ritz pairs = RitzPairs(krylov);
  const Eigen::VectorXd combination = pairs.eigenvectors().rightCols<1>();
  const double residual = krylov.off_diagonal.back() * std::abs(combination.tail<1>()[0]);
  const double ritz = pairs.eigenvalues().tail<1>()[0];
  if (ritz + residual <= 0) return {};
  return {ritz, residual, Combine(krylov.basis, combination)};
}

// Returns the rate by which the integrator's counted damping limits its step.
double& CountedRate(const Integrator& integrator, Spectrum& spectrum) {
  const bool viscous = integrator.counted_damping() == Integrator::Damping::kViscosity;
  return viscous ? spectrum.viscous_rate : spectrum.damping_rate;
}

// Finds the mode that limits the integrator's step and sets the spectrum's frequency and damping rate to that mode's.
// Each search starts from the last result and from all directions, since another mode may be the limiting one now.
Largest FindLimiting(ScaledStiffness& matrix, const Integrator& integrator, Spectrum& spectrum) {
  const Eigen::VectorXd start = Start(matrix.scale()).normalized();
  Largest limiting = FindLargest(matrix, start, kRough);
  if (limiting.vector.size() == 0) return limiting;
  Eigen::VectorXd product(limiting.vector.size());
  double step = 2 / std::sqrt(limiting.ritz + limiting.residual);
  for (int guess = 0; guess < kGuesses; ++guess) {
    matrix.WeighDamping(2 / step);
    limiting = FindLargest(matrix, start + limiting.vector, kProducts - kRough);
    matrix.WeighDamping(0);
    matrix.Times(limiting.vector, product);
    const double elastic = limiting.vector.dot(product);
    spectrum.omega_max = std::sqrt(std::max(0.0, elastic) + limiting.residual);
    CountedRate(integrator, spectrum) = std::max(0.0, limiting.ritz - elastic) * step / 2;
    const double guessed = std::exchange(step, integrator.MaxStep(spectrum));
    if (step == 0 || std::abs(guessed / step - 1) < kNearby) break;  // 0: the integrator is stable at no step
  }
  return limiting;
}

// Converts the vector to displacements, scaled so that the largest is of length 1.
void TakeMode(const Model& model, const Eigen::VectorXd& vector, FastestMode& fastest) {
  const Eigen::Map<const Points> mode(vector.data(), 3, vector.size() / 3);
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
  const EvalContext at = MakeEvalContext(model, parameters, state);
  const Integrator& integrator = FindIntegrator(parameters.integrator());
  Spectrum& spectrum = fastest.spectrum;
  FindLeastMass(model, spectrum);
  FindDampingRates(model, at, spectrum);
  ScaledStiffness matrix(model, at, integrator.counted_damping());
  Largest largest;
  if (integrator.counted_damping() != Integrator::Damping::kNone && CountedRate(integrator, spectrum) > 0) {
    largest = FindLimiting(matrix, integrator, spectrum);
  } else {
    largest = FindLargest(matrix, Start(matrix.scale()), kProducts);
    spectrum.omega_max = std::sqrt(largest.ritz + largest.residual);
  }
  if (largest.vector.size() > 0) TakeMode(model, largest.vector, fastest);
  return fastest;
}

}  // namespace phrenic
