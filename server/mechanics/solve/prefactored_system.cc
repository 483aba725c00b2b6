#include "server/mechanics/solve/prefactored_system.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <tuple>
#include <utility>

#include "server/mechanics/damping.h"

namespace phrenic {
namespace {

// Returns the scalar that replaces a block: its symmetric part's largest eigenvalue, at least 0.
double Weight(const Eigen::Matrix3d& block) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(0.5 * (block + block.transpose()), Eigen::EigenvaluesOnly);
  return std::max(0.0, solver.eigenvalues()[2]);
}

}  // namespace

PrefactoredSystem::PrefactoredSystem(const Model& model) : translations_(model), stiffness_(model) {
  const int n = stiffness_.vertices();
  for (int i = 0; i < n; ++i) free_.push_back(model.inverse_mass[i] > 0);
  std::vector<std::pair<int, int>> below;
  stiffness_.ForEachBlock([&](int i, int j, const Eigen::Matrix3d&) {
    if (j > i && free_[i] && free_[j]) below.emplace_back(j, i);
  });
  const std::vector<int> order = SparseLdlt::Order(n, below);
  row_.resize(n);
  for (int k = 0; k < n; ++k) row_[order[k]] = k;
  const auto in_order = [this](int i, int j) {
    return std::make_pair(std::max(row_[i], row_[j]), std::min(row_[i], row_[j]));
  };
  for (auto& [i, j] : below) std::tie(i, j) = in_order(i, j);
  std::sort(below.begin(), below.end());
  pattern_ = SparseLdlt(n, below);
  stiffness_.ForEachBlock([&](int i, int j, const Eigen::Matrix3d&) {
    if (j <= i) return;
    const auto place = std::lower_bound(below.begin(), below.end(), in_order(i, j));
    place_.push_back(free_[i] && free_[j] ? static_cast<int>(place - below.begin()) : -1);
  });
  values_.resize(below.size());
  diagonal_.resize(n);
  right_.resize(3, n);
}

bool PrefactoredSystem::IsFor(const v1::Parameters& parameters, double g) {
  asked_.resize(parameters.ByteSizeLong());
  parameters.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(asked_.data()));
  return g == g_ && asked_ == key_;
}

void PrefactoredSystem::Prepare(const Model& model, const v1::Parameters& parameters, double g) {
  if (IsFor(parameters, g)) return;
  key_ = asked_;
  g_ = g;
  const Eigen::VectorXd diagonal = diagonal_;
  const std::vector<double> values = values_;
  const State rest = model.InitialState();
  const EvalContext at = MakeEvalContext(model, parameters, rest);
  Assemble(model, at);
  if (factors_.lower.empty() || diagonal != diagonal_ || values != values_) {
    pattern_.Factorise(diagonal_, values_, factors_);
  }
  PrepareShared(model, at);
}

void PrefactoredSystem::Assemble(const Model& model, const EvalContext& at) {
  stiffness_.Assemble(model, at, 1 / g_);
  Eigen::VectorXd diagonal(diagonal_.size());
  SumDamping(model, at, diagonal);
  diagonal = model.mass + g_ * diagonal;
  inertia_ = diagonal;
  std::vector<Eigen::Matrix3d> grounded(free_.size(), Eigen::Matrix3d::Zero());
  auto place = place_.begin();
  translations_.Begin();
  stiffness_.ForEachBlock([&](int i, int j, const Eigen::Matrix3d& block) {
    if (!translations_.empty() && free_[i] && free_[j]) translations_.Add(i, j, block);
    grounded[i] += block;
    if (j <= i) return;
    const double weight = g_ * g_ * Weight(-block);
    diagonal[i] += weight;
    diagonal[j] += weight;
    if (*place >= 0) values_[*place] = -weight;
    ++place;
  });
  for (size_t i = 0; i < free_.size(); ++i) {
    const auto vertex = static_cast<Eigen::Index>(i);
    diagonal_[row_[i]] = free_[i] ? diagonal[vertex] + g_ * g_ * Weight(grounded[i]) : 1;
  }
}

// The damping's products correct the matrix that the stiffness' products have corrected.
void PrefactoredSystem::PrepareShared(const Model& model, const EvalContext& at) {
  SumSharedDamping(model, at, shared_damping_);
  stiffness_.outer().Prepare(g_ * g_, [this](const Points& b, Points& y) { SolvePlain(b, y); });
  shared_damping_.Prepare(g_, [this](const Points& b, Points& y) {
    SolvePlain(b, y);
    stiffness_.outer().CorrectPrepared(g_ * g_, y);
  });
}

void PrefactoredSystem::Solve(const Points& b, Points& y) {
  SolvePlain(b, y);
  stiffness_.outer().CorrectPrepared(g_ * g_, y);
  shared_damping_.CorrectPrepared(g_, y);
}

void PrefactoredSystem::KeepSums(const Points& r, Points& v) {
  shift_.setZero(3, v.cols());
  translations_.Correct(r, inertia_, g_, stiffness_.outer(), shared_damping_, shift_);
  v += shift_;
}

void PrefactoredSystem::SolvePlain(const Points& b, Points& y) {
  for (size_t i = 0; i < free_.size(); ++i) {
    const auto vertex = static_cast<Eigen::Index>(i);
    right_.col(row_[i]) = free_[i] ? Eigen::Vector3d(b.col(vertex)) : Eigen::Vector3d::Zero();
  }
  pattern_.Solve(factors_, right_);
  y.resize(3, b.cols());
  for (Eigen::Index i = 0; i < b.cols(); ++i) y.col(i) = right_.col(row_[i]);
}

}  // namespace phrenic
