#include "server/mechanics/constraints/link_network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace phrenic {
namespace {

constexpr double kTolerance = 1e-10;   // relative to the length
constexpr double kWorthAnother = 0.5;  // the chord iterations end if the error is not reduced to this fraction
constexpr int kFactorisations = 20;    // at most, with current directions, after the chord iterations
constexpr double kLargestMove = 0.5;   // largest change of a length per iteration, relative to the length
constexpr int kSweeps = 200;           // Gauss-Seidel, at most
constexpr int kSwitches = 30;          // changes of the active set, at most
constexpr double kAtRest = 1e-12;      // relative to the largest rate: slower limits count as at rest
constexpr int kRefinements = 3;        // of velocities; each gains about ten digits unless links are nearly redundant

constexpr std::size_t kMostPairs = 20'000'000;    // of links that share a vertex, in both orders
constexpr std::size_t kMostFactors = 20'000'000;  // of 20 bytes each

using Entry = std::pair<int, int>;  // row and column of the matrix

// Returns the links at each movable vertex: index i of a link that starts there, ~i (negative) of one that ends there.
std::map<int, std::vector<int>> LinksAtVertices(const std::vector<Link>& links) {
  std::map<int, std::vector<int>> at;
  for (int i = 0; i < static_cast<int>(links.size()); ++i) {
    if (links[i].inverse_a > 0) at[links[i].a].push_back(i);
    if (links[i].inverse_b > 0) at[links[i].b].push_back(~i);
  }
  return at;
}

int Index(int signed_index) { return signed_index < 0 ? ~signed_index : signed_index; }

// Returns the non-zero entries below the diagonal, sorted.
std::vector<Entry> EntriesBelow(const std::vector<Link>& links) {
  std::vector<Entry> entries;
  for (const auto& [vertex, there] : LinksAtVertices(links)) {
    for (const int a : there) {
      for (const int b : there) {
        if (Index(a) > Index(b)) entries.emplace_back(Index(a), Index(b));
      }
    }
  }
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  return entries;
}

}  // namespace

struct LinkNetwork::Memory {
  Points directions;         // unit vectors; 0 if not active
  Eigen::VectorXd diagonal;  // [1/kg]
  Eigen::VectorXd multipliers, taken,
      totals;                  // [kg m] or, of velocities, [kg m/s]; `multipliers` is [m] or [m/s] before the solve
  std::vector<double> values;  // below the diagonal [1/kg]
  std::vector<bool> active;    // equalities, and limits in the active set
  SparseLdlt::Factors factors;

  bool AnyActive(size_t links) const {
    const auto end = active.begin() + static_cast<std::ptrdiff_t>(links);
    return std::find(active.begin(), end, true) != end;
  }
};

LinkNetwork::Memory& LinkNetwork::Fit(const Scratch& scratch) const {
  auto& memory = scratch.Get<Memory>();
  const auto links = static_cast<Eigen::Index>(links_.size());
  if (memory.values.size() < values_) memory.values.resize(values_);
  if (memory.multipliers.size() >= links) return memory;
  memory.directions.resize(3, links);
  for (Eigen::VectorXd* vector : {&memory.diagonal, &memory.multipliers, &memory.taken, &memory.totals}) {
    vector->resize(links);
  }
  memory.active.resize(links_.size());
  return memory;
}

LinkNetwork::LinkNetwork(const std::vector<Link>& links) {
  std::size_t pairs = 0;
  for (const auto& [vertex, there] : LinksAtVertices(links)) pairs += there.size() * there.size();
  complete_ = pairs <= kMostPairs;
  if (!complete_) return;
  for (const int old : SparseLdlt::Order(static_cast<int>(links.size()), EntriesBelow(links))) {
    links_.push_back(links[old]);
  }
  FindCouplings();
}

void LinkNetwork::FindCouplings() {
  const std::vector<Entry> entries = EntriesBelow(links_);
  for (const auto& [vertex, there] : LinksAtVertices(links_)) {
    for (const int a : there) {
      for (const int b : there) {
        const Entry entry(Index(a), Index(b));
        if (entry.first <= entry.second) continue;
        const auto at = std::lower_bound(entries.begin(), entries.end(), entry) - entries.begin();
        const Link& link = links_[entry.first];
        const double inverse = link.a == vertex ? link.inverse_a : link.inverse_b;
        const double sign = (a < 0) == (b < 0) ? 1 : -1;
        couplings_.push_back({static_cast<int>(at), entry.first, entry.second, sign * inverse});
      }
    }
  }
  values_ = entries.size();
  matrix_ = SparseLdlt(static_cast<int>(links_.size()), entries, kMostFactors);
  complete_ = matrix_.complete();
}

// Inactive links have direction 0 and hence no entries in the matrix.
void LinkNetwork::Factorise(const ConstPoints& x, Memory& memory) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d between = x.col(links_[i].b) - x.col(links_[i].a);
    const double length = memory.active[i] ? between.norm() : 0;
    memory.directions.col(column) = length > 0 ? Eigen::Vector3d(between / length) : Eigen::Vector3d::Zero();
    memory.diagonal[column] = length > 0 ? links_[i].inverse_a + links_[i].inverse_b : 0;
  }
  std::fill(memory.values.begin(), memory.values.begin() + static_cast<std::ptrdiff_t>(values_), 0.0);
  for (const Coupling& c : couplings_) {
    memory.values[c.at] += c.factor * memory.directions.col(c.i).dot(memory.directions.col(c.j));
  }
  matrix_.Factorise(memory.diagonal, memory.values, memory.factors);
}

double LinkNetwork::Errors(const State& state, Memory& memory) const {
  double worst = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const double error = memory.active[i] ? links_[i].RelativeError(state.x) : 0;
    memory.multipliers[static_cast<Eigen::Index>(i)] = error * links_[i].length;
    worst = std::max(worst, std::abs(error));
  }
  return worst;
}

double LinkNetwork::Rates(const State& state, Memory& memory) const {
  double worst = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d relative = state.v.col(links_[i].b) - state.v.col(links_[i].a);
    memory.multipliers[column] = memory.directions.col(column).dot(relative);
    worst = std::max(worst, std::abs(memory.multipliers[column]));
  }
  return worst;
}

// Returns the largest change of a length that the multipliers would cause, relative to the length.
double LinkNetwork::LargestMove(const Memory& memory) const {
  double largest = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const double multiplier = std::abs(memory.multipliers[static_cast<Eigen::Index>(i)]);
    largest = std::max(largest, multiplier * (links_[i].inverse_a + links_[i].inverse_b) / links_[i].length);
  }
  return largest;
}

void LinkNetwork::ApplyPositionImpulses(double sign, double dt, Memory& memory, State& state) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    ApplyPositionImpulse(links_[i], sign * memory.multipliers[column] * memory.directions.col(column), dt, state.x,
                         state.v);
    memory.totals[column] += sign * memory.multipliers[column];
  }
}

void LinkNetwork::ApplyVelocityImpulses(Memory& memory, State& state) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    ApplyVelocityImpulse(links_[i], memory.multipliers[column] * memory.directions.col(column), state);
    memory.totals[column] += memory.multipliers[column];
  }
}

// One Newton iteration with the factorised matrix; updates `error`. Returns false, and undoes it, if the error did not
// decrease.
bool LinkNetwork::Correct(double dt, Memory& memory, State& state, double& error) const {
  matrix_.Solve(memory.factors, memory.multipliers);
  const double part = std::min(1.0, kLargestMove / LargestMove(memory));
  memory.taken = memory.multipliers;
  ApplyPositionImpulses(part, dt, memory, state);
  const double before = error;
  error = Errors(state, memory);
  if (error < before) return true;
  memory.multipliers = memory.taken;
  ApplyPositionImpulses(-part, dt, memory, state);
  error = Errors(state, memory);
  return false;
}

void LinkNetwork::Newton(const ConstPoints& before, double dt, Memory& memory, State& state) const {
  Factorise(before, memory);
  double error = Errors(state, memory), last = std::numeric_limits<double>::infinity();
  while (error > kTolerance && error <= kWorthAnother * last) {
    last = error;
    if (!Correct(dt, memory, state, error)) break;
  }
  for (int i = 0; i < kFactorisations && error > kTolerance; ++i) {
    Factorise(state.x, memory);
    if (!Correct(dt, memory, state, error)) break;
  }
}

// Releases limits that push a cable or pull a strut, undoing their displacements, and activates violated ones.
bool LinkNetwork::UpdateActiveSet(double dt, Memory& memory, State& state) const {
  bool changed = false;
  for (size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    double& total = memory.totals[static_cast<Eigen::Index>(i)];
    if (link.sign == 0) continue;
    if (memory.active[i] && link.sign * total * (link.inverse_a + link.inverse_b) < -kTolerance * link.length) {
      ApplyPositionImpulse(link, -total * memory.directions.col(static_cast<Eigen::Index>(i)), dt, state.x, state.v);
      total = 0;
      memory.active[i] = false;
      changed = true;
    } else if (!memory.active[i] && link.Violation(state.x) > kTolerance) {
      memory.active[i] = true;
      changed = true;
    }
  }
  return changed;
}

void LinkNetwork::Project(const ConstPoints& before, double dt, const Scratch& scratch, State& state) const {
  Memory& memory = Fit(scratch);
  for (size_t i = 0; i < links_.size(); ++i) {
    memory.active[i] = links_[i].sign == 0 || links_[i].Violation(state.x) > kTolerance;
  }
  if (!memory.AnyActive(links_.size())) return;
  memory.totals.setZero();
  for (int round = 0; round < kSwitches; ++round) {
    Newton(before, dt, memory, state);
    if (!UpdateActiveSet(dt, memory, state)) break;
  }
  for (int sweep = 0; sweep < kSweeps && LargestViolation(state) > kTolerance; ++sweep) {
    for (const Link& link : links_) {
      if (link.Violation(state.x) > 0) Restore(link, before.col(link.b) - before.col(link.a), dt, state.x, state.v);
    }
  }
}

double LinkNetwork::LargestViolation(const State& state) const {
  double worst = 0;
  for (const Link& link : links_) worst = std::max(worst, link.Violation(state.x));
  return worst;
}

bool LinkNetwork::UpdateActiveSetOfVelocities(double slow, Memory& memory, State& state) const {
  bool changed = false;
  for (size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    double& total = memory.totals[static_cast<Eigen::Index>(i)];
    if (link.sign == 0) continue;
    if (memory.active[i] && link.sign * total * (link.inverse_a + link.inverse_b) < -slow) {
      ApplyVelocityImpulse(link, -total * memory.directions.col(static_cast<Eigen::Index>(i)), state);
      total = 0;
      memory.active[i] = false;
      changed = true;
    } else if (!memory.active[i] && link.Reached(state.x) && link.sign * link.Rate(state) > slow) {
      memory.active[i] = true;
      changed = true;
    }
  }
  return changed;
}

void LinkNetwork::ProjectVelocities(const Scratch& scratch, State& state) const {
  Memory& memory = Fit(scratch);
  double fastest = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    const double rate = link.sign == 0 ? std::abs(link.Rate(state)) : link.sign * link.Rate(state);
    memory.active[i] = link.sign == 0 || (rate > 0 && link.Reached(state.x));
    if (memory.active[i]) fastest = std::max(fastest, rate);
  }
  if (fastest == 0) return;
  memory.totals.setZero();
  for (int round = 0; round < kSwitches; ++round) {
    Factorise(state.x, memory);
    for (int pass = 0; pass < kRefinements && Rates(state, memory) > 0; ++pass) {
      matrix_.Solve(memory.factors, memory.multipliers);
      ApplyVelocityImpulses(memory, state);
    }
    if (!UpdateActiveSetOfVelocities(kAtRest * fastest, memory, state)) return;
  }
}

}  // namespace phrenic
