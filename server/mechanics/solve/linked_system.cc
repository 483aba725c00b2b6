#include "server/mechanics/solve/linked_system.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

constexpr int kLinkedIterations = 400;
constexpr int kMeetings = 3;      // of the wanted rates; each gains about ten digits unless links are nearly redundant
constexpr double kStiffer = 1e5;  // R, relative to the effective mass of a link
constexpr int kMultiplierSteps = 12;
constexpr double kMet = 1e-9;  // of the largest rate

}  // namespace

LinkedSystem::LinkedSystem(const Model& model) : inverse_(static_cast<size_t>(model.rest.cols())) {
  for (Points* each : {&residual_, &down_, &direction_, &product_}) each->setZero(3, model.rest.cols());
}

void LinkedSystem::Precondition(const ImplicitSystem& system, LinkEquations& links) {
  for (size_t i = 0; i < inverse_.size(); ++i) inverse_[i] = system.Diagonal(static_cast<int>(i));
  links.AddTension(inverse_);
  for (size_t i = 0; i < inverse_.size(); ++i) {
    const bool moves = !system.Diagonal(static_cast<int>(i)).isZero(0);
    inverse_[i] = moves ? Eigen::Matrix3d(inverse_[i].inverse()) : Eigen::Matrix3d::Zero();
  }
  links.Factorise(inverse_);
}

// Moves y by the least, in the norm of D, so that its rates are those wanted.
void LinkedSystem::Meet(LinkEquations& links, Points& y) {
  for (int pass = 0; pass < kMeetings; ++pass) {
    links.Rates(y, links.buffer);
    links.buffer -= links.wanted;
    if (links.buffer.isZero(0)) return;
    links.Solve(links.buffer);
    links.AddResponse(links.buffer, inverse_, y);
  }
}

void LinkedSystem::Times(ImplicitSystem& system, const LinkEquations& links, bool whole, const Points& p) {
  system.Times(whole, p, product_);
  links.AddTensionTimes(p, product_);
}

// Sets down_ to the residual's preconditioned direction that keeps all rates; takes from the residual what links bear.
// Returns their product.
double LinkedSystem::Descend(LinkEquations& links) {
  for (Eigen::Index i = 0; i < residual_.cols(); ++i)
    down_.col(i) = inverse_[static_cast<size_t>(i)] * residual_.col(i);
  for (int pass = 0; pass < 2; ++pass) {  // the second takes what rounding has left
    links.Rates(down_, links.buffer);
    links.Solve(links.buffer);
    links.AddImpulses(links.buffer, residual_);
    links.AddResponse(links.buffer, inverse_, down_);
    links.change += links.buffer;
  }
  return Dot(residual_, down_);
}

// Returns false if it does not converge.
bool LinkedSystem::Iterate(ImplicitSystem& system, LinkEquations& links, double tolerance, SolverEffort& effort,
                           Points& y) {
  const double first = Descend(links);
  double now = first;
  direction_ = down_;
  int iterations = 0;
  const auto spent = [&] { return iterations >= effort.most_iterations() || (iterations > 0 && effort.Spent()); };
  while (now > tolerance * tolerance * first && !spent()) {
    Times(system, links, true, direction_);
    const double step = now / Dot(direction_, product_);
    if (iterations == kLinkedIterations || !(step > 0) || !std::isfinite(step)) return effort.limited();
    y += step * direction_;
    residual_ -= step * product_;
    const double next = Descend(links);
    direction_ = down_ + next / now * direction_;
    now = next;
    ++iterations;
  }
  effort.Note(iterations, first > 0 ? std::sqrt(std::max(0.0, now) / first) : 0);
  return true;
}

absl::Status LinkedSystem::Solve(const Model& model, const EvalContext& at, ImplicitSystem& system,
                                 LinkEquations& links, const Points& b, double tolerance, SolverEffort& effort,
                                 Points& y) {
  if (!b.allFinite()) return absl::AbortedError("a force is not finite: lower time_step");
  Precondition(system, links);
  for (Eigen::Index i = 0; i < y.cols(); ++i) {
    if (model.inverse_mass[i] == 0) y.col(i).setZero();
  }
  Meet(links, y);
  Times(system, links, false, y);
  residual_ = b - product_ - y * system.inertia().asDiagonal();
  links.change.setZero();
  if (!Iterate(system, links, tolerance, effort, y)) {
    if (absl::Status solved = SolveDirectly(model, at, system, links, b, y); !solved.ok()) return solved;
    effort.Note(0, 0);
  }
  Meet(links, y);
  system.KeepSums(b, y);
  return absl::OkStatus();
}

absl::Status LinkedSystem::SolveDirectly(const Model& model, const EvalContext& at, ImplicitSystem& system,
                                         LinkEquations& links, const Points& b, Points& y) {
  links.EffectiveMasses(stiffness_);
  stiffness_ *= kStiffer;
  std::vector<Eigen::Triplet<double>> entries;
  links.AddEntries(stiffness_, entries);
  if (absl::Status factorised = system.FactoriseWith(model, at, entries); !factorised.ok()) return factorised;
  links.change.setZero();
  for (int step = 0; step < kMultiplierSteps; ++step) {
    residual_ = b;
    shift_ = links.change - stiffness_.cwiseProduct(links.wanted);
    links.AddImpulses(shift_, residual_);
    system.SolveWith(residual_, y);
    links.Rates(y, links.buffer);
    const double fastest = links.buffer.cwiseAbs().maxCoeff() + y.cwiseAbs().maxCoeff();
    links.buffer -= links.wanted;
    links.change += stiffness_.cwiseProduct(links.buffer);
    if (links.buffer.cwiseAbs().maxCoeff() <= kMet * fastest) break;
  }
  return absl::OkStatus();
}

}  // namespace phrenic
