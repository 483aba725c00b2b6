#include "server/mechanics/implicit_system.h"

#include <Eigen/LU>
#include <cmath>

#include "server/mechanics/advance.h"

namespace phrenic {
namespace {

constexpr int kIterations = 400;

}  // namespace

ImplicitSystem::ImplicitSystem(const Model& model) : stiffness_(model) {
  const Eigen::Index n = model.rest.cols();
  diagonal_ = Eigen::VectorXd::Zero(n);
  inverses_.resize(n);
  residual_ = direction_ = product_ = scaled_ = Points::Zero(3, n);
}

void ImplicitSystem::Assemble(const Model& model, const Instant& at, double g) {
  g_ = g;
  factorised_ = false;
  stiffness_.Assemble(model, at);
  SumDamping(model, at, diagonal_);
  SumSharedDamping(model, at, shared_damping_);
  for (Eigen::Index i = 0; i < diagonal_.size(); ++i) {
    diagonal_[i] = model.inverse_mass[i] > 0 ? model.mass[i] + g * diagonal_[i] : 0;
    if (diagonal_[i] == 0) continue;
    const int vertex = static_cast<int>(i);
    inverses_[i] = (diagonal_[i] * Eigen::Matrix3d::Identity() + g * g * stiffness_.Diagonal(vertex)).inverse();
  }
}

void ImplicitSystem::Times(const Model& model, const Points& x, Points& y) const {
  stiffness_.Times(x, y);
  shared_damping_.AddTimes(1 / g_, x, y);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    if (model.inverse_mass[i] > 0) {
      y.col(i) = diagonal_[i] * x.col(i) + g_ * g_ * y.col(i);
    } else {
      y.col(i).setZero();
    }
  }
}

void ImplicitSystem::Precondition(const Points& r, Points& z) const {
  for (Eigen::Index i = 0; i < r.cols(); ++i) {
    if (diagonal_[i] > 0) {
      z.col(i) = inverses_[i] * r.col(i);
    } else {
      z.col(i).setZero();
    }
  }
}

absl::Status ImplicitSystem::Solve(const Model& model, const Points& b, double tolerance, Points& y) {
  if (!b.allFinite()) return absl::AbortedError("a force is not finite: lower time_step");
  if (!factorised_ && ConjugateGradients(model, b, tolerance, y)) return absl::OkStatus();
  return Factorise(model, b, y);
}

bool ImplicitSystem::ConjugateGradients(const Model& model, const Points& b, double tolerance, Points& y) {
  y.setZero();
  residual_ = b;
  for (Eigen::Index i = 0; i < b.cols(); ++i) {
    if (diagonal_[i] == 0) residual_.col(i).setZero();
  }
  Precondition(residual_, scaled_);
  direction_ = scaled_;
  double rho = residual_.cwiseProduct(scaled_).sum();
  const double enough = tolerance * tolerance * rho;  // in the preconditioner's norm
  for (iterations_ = 0; iterations_ < kIterations; ++iterations_) {
    if (rho <= enough) return true;
    Times(model, direction_, product_);
    const double along = rho / direction_.cwiseProduct(product_).sum();
    if (!std::isfinite(along)) return false;
    y += along * direction_;
    residual_ -= along * product_;
    Precondition(residual_, scaled_);
    const double next = residual_.cwiseProduct(scaled_).sum();
    direction_ = scaled_ + next / rho * direction_;
    rho = next;
  }
  return false;
}

absl::Status ImplicitSystem::Factorise(const Model& model, const Points& b, Points& y) {
  const Eigen::Index n = b.cols();
  iterations_ = 0;
  Eigen::VectorXd free(3 * n), mass(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    free.segment<3>(3 * i).setConstant(model.inverse_mass[i] > 0 ? 1 : 0);
    mass.segment<3>(3 * i).setConstant(model.inverse_mass[i] > 0 ? diagonal_[i] : 1);
  }
  if (!factorised_) {
    Eigen::SparseMatrix<double> matrix = free.asDiagonal() * stiffness_.ToSparse() * free.asDiagonal();
    matrix *= g_ * g_;
    matrix.diagonal() += mass;
    factor_.compute(matrix);
    if (factor_.info() != Eigen::Success)
      return absl::AbortedError("the implicit step's matrix is singular: lower time_step");
    factorised_ = true;
  }
  SolveFactored(model, b, y);
  const auto inverse = [&](const Points& right, Points& left) { SolveFactored(model, right, left); };
  stiffness_.outer().Correct(g_ * g_, inverse, y);
  // What damps comes on top of what the stiffness' products have made of the matrix.
  const auto stiffened = [&](const Points& right, Points& left) {
    SolveFactored(model, right, left);
    stiffness_.outer().Correct(g_ * g_, inverse, left);
  };
  shared_damping_.Correct(g_, stiffened, y);
  return absl::OkStatus();
}

void ImplicitSystem::SolveFactored(const Model& model, const Points& b, Points& y) const {
  Eigen::VectorXd right = b.reshaped();
  for (Eigen::Index i = 0; i < b.cols(); ++i) {
    if (model.inverse_mass[i] == 0) right.segment<3>(3 * i).setZero();
  }
  y = factor_.solve(right).reshaped(3, b.cols());
}

}  // namespace phrenic
