#include "server/mechanics/constraints/link_network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace phrenic {
namespace {

constexpr double kTolerance = 1e-10;  // of the length
constexpr double kGain = 0.9;         // an iteration that leaves more of the error than this is the last
constexpr int kSweeps = 200;
constexpr int kRefinements = 3;  // of velocities; each gains about ten digits where no link is nearly redundant

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

struct LinkNetwork::Scratch {
  Points directions;                        // unit
  Eigen::VectorXd diagonal, errors, pulls;  // [1/kg], [m], [kg m] (of velocities: [kg m/s])
  std::vector<double> values;
  SparseLdlt::Factors factors;

  void Fit(Eigen::Index links, size_t below) {
    if (values.size() < below) values.resize(below);
    if (pulls.size() >= links) return;
    directions.resize(3, links);
    diagonal.resize(links);
    errors.resize(links);
    pulls.resize(links);
  }
};

LinkNetwork::Scratch& LinkNetwork::ThreadScratch() {
  thread_local Scratch scratch;
  return scratch;
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

void LinkNetwork::Factorise(const ConstPoints& x, Scratch& scratch) const {
  scratch.Fit(static_cast<Eigen::Index>(links_.size()), values_);
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d between = x.col(links_[i].b) - x.col(links_[i].a);
    const double length = between.norm();
    scratch.directions.col(column) = length > 0 ? Eigen::Vector3d(between / length) : Eigen::Vector3d::Zero();
    scratch.diagonal[column] = length > 0 ? links_[i].inverse_a + links_[i].inverse_b : 0;
  }
  std::fill(scratch.values.begin(), scratch.values.begin() + static_cast<std::ptrdiff_t>(values_), 0.0);
  for (const Coupling& c : couplings_) {
    scratch.values[c.at] += c.factor * scratch.directions.col(c.i).dot(scratch.directions.col(c.j));
  }
  matrix_.Factorise(scratch.diagonal, scratch.values, scratch.factors);
}

double LinkNetwork::Errors(const State& state, Scratch& scratch) const {
  double worst = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const double error = links_[i].RelativeError(state.x);
    scratch.errors[static_cast<Eigen::Index>(i)] = error * links_[i].length;
    worst = std::max(worst, std::abs(error));
  }
  return worst;
}

// What the pulls would move links by, over their lengths.
double LinkNetwork::LargestMove(const Scratch& scratch) const {
  double largest = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const double pull = std::abs(scratch.pulls[static_cast<Eigen::Index>(i)]);
    largest = std::max(largest, pull * (links_[i].inverse_a + links_[i].inverse_b) / links_[i].length);
  }
  return largest;
}

void LinkNetwork::PullAll(double sign, double dt, const Scratch& scratch, State& state) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    Pull(links_[i], sign * scratch.pulls[column] * scratch.directions.col(column), dt, state);
  }
}

void LinkNetwork::Project(const ConstPoints& before, double dt, State& state) const {
  if (links_.empty()) return;
  Scratch& scratch = ThreadScratch();
  Factorise(before, scratch);
  double error = Errors(state, scratch), last = std::numeric_limits<double>::infinity();
  while (error > kTolerance && error <= kGain * last) {
    scratch.pulls = scratch.errors;
    matrix_.Solve(scratch.factors, scratch.pulls);
    if (LargestMove(scratch) > 1) break;
    PullAll(1, dt, scratch, state);
    last = error;
    error = Errors(state, scratch);
    if (error <= last) continue;
    PullAll(-1, dt, scratch, state);  // it made things worse
    break;
  }
  for (int sweep = 0; sweep < kSweeps && error > kTolerance; ++sweep) {
    for (const Link& link : links_) Restore(link, before, dt, state);
    error = Errors(state, scratch);
  }
}

void LinkNetwork::ProjectVelocities(State& state) const {
  if (links_.empty()) return;
  Scratch& scratch = ThreadScratch();
  Factorise(state.x, scratch);
  for (int pass = 0; pass < kRefinements; ++pass) {
    for (size_t i = 0; i < links_.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      scratch.pulls[column] = scratch.directions.col(column).dot(state.v.col(links_[i].b) - state.v.col(links_[i].a));
    }
    matrix_.Solve(scratch.factors, scratch.pulls);
    for (size_t i = 0; i < links_.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const Eigen::Vector3d impulse = scratch.pulls[column] * scratch.directions.col(column);
      state.v.col(links_[i].a) += links_[i].inverse_a * impulse;
      state.v.col(links_[i].b) -= links_[i].inverse_b * impulse;
    }
  }
}

}  // namespace phrenic
