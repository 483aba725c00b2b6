#include "server/mechanics/solve/implicit_system.h"

#include <algorithm>
#include <cmath>

#include "server/mechanics/damping.h"

namespace phrenic {
namespace {

constexpr int kIterations = 400;

auto Values(Lanes& lanes) { return Eigen::Map<Eigen::Array<float, kSliceLanes, 1>>(lanes.at); }
auto Values(const Lanes& lanes) { return Eigen::Map<const Eigen::Array<float, kSliceLanes, 1>>(lanes.at); }

// The largest magnitude of a vector's numbers, and the sum of their squares.
struct Size {
  double largest = 0, squares = 0;
};

Size SizeOf(const RowVector& r) {
  Size size;
  for (const Lanes& lanes : r) {
    size.largest = std::max(size.largest, static_cast<double>(Values(lanes).abs().maxCoeff()));
    size.squares += Values(lanes).cast<double>().square().sum();
  }
  return size;
}

}  // namespace

ImplicitSystem::ImplicitSystem(const Model& model) : rows_(model), inertia_(model.rest.cols()) {
  missing_.resize(3, model.rest.cols());
  for (RowVector* each : {&change_, &residual_, &product_}) each->resize(rows_.row_lanes());
}

void ImplicitSystem::Assemble(const Model& model, const EvalContext& at, double g) {
  g_ = g;
  factorised_ = false;
  SumDamping(model, at, inertia_);
  for (Eigen::Index i = 0; i < inertia_.size(); ++i) {
    inertia_[i] = model.inverse_mass[i] > 0 ? model.mass[i] + g * inertia_[i] : 0;
  }
  rows_.Assemble(model, at, g, inertia_);
}

absl::Status ImplicitSystem::Solve(const Model& model, const EvalContext& at, const Points& b, double tolerance,
                                   SolverEffort& effort, Points& y) {
  if (!b.allFinite()) return absl::AbortedError("a force is not finite: lower time_step");
  if (factorised_) return SolveDirectly(model, at, b, y);
  const double unit = StartFrom(b, y);
  if (unit == 0) return absl::OkStatus();
  Progress progress;
  Begin(tolerance, progress);
  const End end = Iterate(effort, progress);
  if (end == End::kTooLong && !effort.limited()) {
    effort.Note(0, 0);
    return SolveDirectly(model, at, b, y);
  }
  rows_.AddDisplacements(unit, change_, y);
  KeepSums(b, y);
  effort.Note(progress.iterations, std::sqrt(progress.now / progress.first));
  return absl::OkStatus();
}

// Sets residual_ to that of the guess y, in units of its largest number, and floor_. Returns the unit; 0 if the
// residual is 0.
double ImplicitSystem::StartFrom(const Points& b, Points& y) {
  for (Eigen::Index i = 0; i < y.cols(); ++i) {
    if (inertia_[i] == 0) y.col(i).setZero();
  }
  rows_.ForcesToRows(1, b, residual_);
  const Size whole = SizeOf(residual_);
  floor_ = kFinest * kFinest * whole.squares;
  double unit = whole.largest;
  if (!y.isZero(0)) {
    missing_ = b - y * inertia_.asDiagonal();
    rows_.ForcesToRows(1, missing_, residual_);
    rows_.DisplacementsToRows(y, product_);
    rows_.Face(product_);
    rows_.Times(false, product_);
    for (size_t k = 0; k < residual_.size(); ++k) Values(residual_[k]) -= Values(product_[k]);
    unit = SizeOf(residual_).largest;
  }
  if (unit == 0) return 0;
  for (Lanes& lanes : residual_) Values(lanes) *= static_cast<float>(1 / unit);
  floor_ /= unit * unit;
  return unit;
}

void ImplicitSystem::Begin(double tolerance, Progress& progress) {
  for (RowVector* each : {&change_, &product_}) std::fill(each->begin(), each->end(), Lanes());
  progress.now = progress.first = Descend(rows_.slices(), 0, product_, residual_);
  progress.enough = std::max(tolerance * tolerance * progress.first, floor_);
  rows_.Face(product_);
}

ImplicitSystem::End ImplicitSystem::Iterate(const SolverEffort& effort, Progress& progress) {
  for (; progress.iterations < kIterations; ++progress.iterations) {
    if (progress.now <= progress.enough) return End::kSolved;
    if (progress.iterations > 0 && effort.Spent()) return End::kSpent;
    if (progress.iterations == effort.most_iterations()) return End::kSpent;
    const double along = progress.now / rows_.Times(true, product_);
    if (!(along > 0) || !std::isfinite(along)) return End::kTooLong;
    const auto step = static_cast<float>(along);
    const double next = Descend(rows_.slices(), step, product_, residual_);
    rows_.Turn(step, static_cast<float>(next / progress.now), product_, change_);
    progress.now = next;
  }
  return End::kTooLong;
}

absl::Status ImplicitSystem::SolveDirectly(const Model& model, const EvalContext& at, const Points& b, Points& y) {
  if (!factorised_) {
    if (absl::Status status = FactoriseWith(model, at, {}); !status.ok()) return status;
    factorised_ = true;
  }
  SolveWith(b, y);
  KeepSums(b, y);
  return absl::OkStatus();
}

absl::Status ImplicitSystem::FactoriseWith(const Model& model, const EvalContext& at,
                                           const std::vector<Eigen::Triplet<double>>& entries) {
  const Eigen::Index n = inertia_.size();
  if (stiffness_ == nullptr) stiffness_ = std::make_unique<BlockMatrix>(model);
  factorised_ = false;
  stiffness_->Assemble(model, at, 1 / g_);
  Eigen::VectorXd free(3 * n), mass(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    free.segment<3>(3 * i).setConstant(inertia_[i] > 0 ? 1 : 0);
    mass.segment<3>(3 * i).setConstant(inertia_[i] > 0 ? inertia_[i] : 1);
  }
  Eigen::SparseMatrix<double> matrix = free.asDiagonal() * stiffness_->ToSparse() * free.asDiagonal();
  matrix *= g_ * g_;
  matrix.diagonal() += mass;
  if (!entries.empty()) {
    Eigen::SparseMatrix<double> more(3 * n, 3 * n);
    more.setFromTriplets(entries.begin(), entries.end());
    matrix += more;
  }
  if (factor_.Factorise(matrix)) return absl::OkStatus();
  return absl::AbortedError("the implicit step's matrix is singular: lower time_step");
}

void ImplicitSystem::SolveWith(const Points& b, Points& y) {
  SolveFactored(b, y);
  const auto inverse = [&](const Points& right, Points& left) { SolveFactored(right, left); };
  stiffness_->outer().Correct(g_ * g_, inverse, y);
  // The damping's products correct the matrix that the stiffness' products have corrected.
  const auto stiffened = [&](const Points& right, Points& left) {
    SolveFactored(right, left);
    stiffness_->outer().Correct(g_ * g_, inverse, left);
  };
  rows_.shared_damping().Correct(g_, stiffened, y);
}

void ImplicitSystem::Times(bool whole, const Points& p, Points& q) {
  rows_.DisplacementsToRows(p, product_);
  rows_.Face(product_);
  rows_.Times(whole, product_);
  rows_.RowsToForces(product_, q);
}

void ImplicitSystem::SolveFactored(const Points& b, Points& y) const {
  Eigen::VectorXd right = b.reshaped();
  for (Eigen::Index i = 0; i < b.cols(); ++i) {
    if (inertia_[i] == 0) right.segment<3>(3 * i).setZero();
  }
  Eigen::VectorXd solution;
  factor_.Solve(right, solution);
  y = solution.reshaped(3, b.cols());
}

}  // namespace phrenic
