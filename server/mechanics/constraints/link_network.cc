#include "server/mechanics/constraints/link_network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace phrenic {
namespace {

constexpr double kTolerance = 1e-10;   // of the length
constexpr double kWorthAnother = 0.5;  // an iteration that leaves more of the error than this is the last
constexpr int kFactorisations = 20;    // along the directions of the moment, where those before do not get there
constexpr double kLargestMove = 0.5;   // of a link's length in one go
constexpr int kSweeps = 200;
constexpr int kSwitches = 30;      // rounds of limits that take hold or let go
constexpr double kAtRest = 1e-12;  // of the fastest rate: a limit that is left slower needs no stopping
constexpr int kRefinements = 3;    // of velocities; each gains about ten digits where no link is nearly redundant

using Place = std::pair<int, int>;

// The links at each vertex that moves, by their numbers; a link's number is negative (~i) where it ends there.
std::map<int, std::vector<int>> LinksAtVertices(const std::vector<Link>& links) {
  std::map<int, std::vector<int>> at;
  for (int i = 0; i < static_cast<int>(links.size()); ++i) {
    if (links[i].inverse_a > 0) at[links[i].a].push_back(i);
    if (links[i].inverse_b > 0) at[links[i].b].push_back(~i);
  }
  return at;
}

int Number(int signed_number) { return signed_number < 0 ? ~signed_number : signed_number; }

std::vector<Place> PlacesBelow(const std::vector<Link>& links) {
  std::vector<Place> places;
  for (const auto& [vertex, there] : LinksAtVertices(links)) {
    for (const int a : there) {
      for (const int b : there) {
        if (Number(a) > Number(b)) places.emplace_back(Number(a), Number(b));
      }
    }
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace

struct LinkNetwork::Memory {
  Points directions;                     // unit; 0 of what is not active
  Eigen::VectorXd diagonal;              // [1/kg]
  Eigen::VectorXd pulls, taken, totals;  // [kg m], of velocities [kg m/s]; errors [m] and rates [m/s] before the solve
  std::vector<double> values;            // [1/kg]
  std::vector<bool> active;
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
  if (memory.pulls.size() >= links) return memory;
  memory.directions.resize(3, links);
  for (Eigen::VectorXd* vector : {&memory.diagonal, &memory.pulls, &memory.taken, &memory.totals}) {
    vector->resize(links);
  }
  memory.active.resize(links_.size());
  return memory;
}

LinkNetwork::LinkNetwork(const std::vector<Link>& links) {
  for (const int old : SparseLdlt::Order(static_cast<int>(links.size()), PlacesBelow(links))) {
    links_.push_back(links[old]);
  }
  FindCouplings();
}

void LinkNetwork::FindCouplings() {
  const std::vector<Place> places = PlacesBelow(links_);
  for (const auto& [vertex, there] : LinksAtVertices(links_)) {
    for (const int a : there) {
      for (const int b : there) {
        const Place place(Number(a), Number(b));
        if (place.first <= place.second) continue;
        const auto at = std::lower_bound(places.begin(), places.end(), place) - places.begin();
        const Link& link = links_[place.first];
        const double inverse = link.a == vertex ? link.inverse_a : link.inverse_b;
        const double sign = (a < 0) == (b < 0) ? 1 : -1;
        couplings_.push_back({static_cast<int>(at), place.first, place.second, sign * inverse});
      }
    }
  }
  values_ = places.size();
  matrix_ = SparseLdlt(static_cast<int>(links_.size()), places);
}

// Links that are not active have no direction and so no part in the matrix.
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
    memory.pulls[static_cast<Eigen::Index>(i)] = error * links_[i].length;
    worst = std::max(worst, std::abs(error));
  }
  return worst;
}

double LinkNetwork::Rates(const State& state, Memory& memory) const {
  double worst = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d relative = state.v.col(links_[i].b) - state.v.col(links_[i].a);
    memory.pulls[column] = memory.directions.col(column).dot(relative);
    worst = std::max(worst, std::abs(memory.pulls[column]));
  }
  return worst;
}

// What the pulls would move links by, over their lengths.
double LinkNetwork::LargestMove(const Memory& memory) const {
  double largest = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const double pull = std::abs(memory.pulls[static_cast<Eigen::Index>(i)]);
    largest = std::max(largest, pull * (links_[i].inverse_a + links_[i].inverse_b) / links_[i].length);
  }
  return largest;
}

void LinkNetwork::PullAll(double sign, double dt, Memory& memory, State& state) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    Pull(links_[i], sign * memory.pulls[column] * memory.directions.col(column), dt, state.x, state.v);
    memory.totals[column] += sign * memory.pulls[column];
  }
}

void LinkNetwork::PushAll(Memory& memory, State& state) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    Push(links_[i], memory.pulls[column] * memory.directions.col(column), state);
    memory.totals[column] += memory.pulls[column];
  }
}

// One step along the directions that are factorised, `error` the one before it. False where it made things worse, and
// was taken back.
bool LinkNetwork::Correct(double dt, Memory& memory, State& state, double& error) const {
  matrix_.Solve(memory.factors, memory.pulls);
  const double part = std::min(1.0, kLargestMove / LargestMove(memory));
  memory.taken = memory.pulls;
  PullAll(part, dt, memory, state);
  const double before = error;
  error = Errors(state, memory);
  if (error < before) return true;
  memory.pulls = memory.taken;
  PullAll(-part, dt, memory, state);
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

// Limits that would push a cable, or pull a strut, are let go with what they did; those that are violated join.
bool LinkNetwork::Switch(double dt, Memory& memory, State& state) const {
  bool changed = false;
  for (size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    double& total = memory.totals[static_cast<Eigen::Index>(i)];
    if (link.sign == 0) continue;
    if (memory.active[i] && link.sign * total * (link.inverse_a + link.inverse_b) < -kTolerance * link.length) {
      Pull(link, -total * memory.directions.col(static_cast<Eigen::Index>(i)), dt, state.x, state.v);
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
    if (!Switch(dt, memory, state)) break;
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

bool LinkNetwork::SwitchVelocities(double slow, Memory& memory, State& state) const {
  bool changed = false;
  for (size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    double& total = memory.totals[static_cast<Eigen::Index>(i)];
    if (link.sign == 0) continue;
    if (memory.active[i] && link.sign * total * (link.inverse_a + link.inverse_b) < -slow) {
      Push(link, -total * memory.directions.col(static_cast<Eigen::Index>(i)), state);
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
      matrix_.Solve(memory.factors, memory.pulls);
      PushAll(memory, state);
    }
    if (!SwitchVelocities(kAtRest * fastest, memory, state)) return;
  }
}

}  // namespace phrenic
