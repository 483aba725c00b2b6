#include "server/mechanics/solve/link_equations.h"

#include <algorithm>
#include <map>
#include <utility>

namespace phrenic {
namespace {

constexpr int kLimitReleases = 30;        // at most: then limits that alternate stay
constexpr double kLimitViolated = 1e-10;  // of the length: a limit that is exceeded by more acts
constexpr double kSlowLimit = 1e-6;       // of the fastest velocity: a slower rate is taken as 0
constexpr std::size_t kMostLinkFactors = 20'000'000;
using LinkPair = std::pair<int, int>;

// A link at one of its ends.
struct LinkEnd {
  int link;
  double sign;  // of the impulse of its multiplier
};

std::map<int, std::vector<LinkEnd>> EndsAtVertices(const std::vector<Link>& links) {
  std::map<int, std::vector<LinkEnd>> at;
  for (int i = 0; i < static_cast<int>(links.size()); ++i) {
    if (links[i].inverse_a > 0) at[links[i].a].push_back({i, 1});
    if (links[i].inverse_b > 0) at[links[i].b].push_back({i, -1});
  }
  return at;
}

// Returns the pairs of links with a common vertex, (i, j) with j < i, sorted.
std::vector<LinkPair> PairsOf(const std::vector<Link>& links) {
  std::vector<LinkPair> pairs;
  for (const auto& [vertex, there] : EndsAtVertices(links)) {
    for (const LinkEnd& a : there) {
      for (const LinkEnd& b : there) {
        if (a.link > b.link) pairs.emplace_back(a.link, b.link);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace

void SetInverseMasses(const Model& model, VertexBlocks& blocks) {
  blocks.resize(static_cast<size_t>(model.rest.cols()));
  for (size_t i = 0; i < blocks.size(); ++i) {
    blocks[i] = model.inverse_mass[static_cast<Eigen::Index>(i)] * Eigen::Matrix3d::Identity();
  }
}

LinkEquations::LinkEquations(const Model& model) {
  std::vector<Link> listed;
  for (const auto& constraint : model.constraints) constraint->ListLinks(listed);
  if (listed.empty()) return;
  for (const int i : SparseLdlt::Order(static_cast<int>(listed.size()), PairsOf(listed))) links_.push_back(listed[i]);
  FindCouplings();
  const auto count = static_cast<Eigen::Index>(links_.size());
  active_.resize(links_.size());
  directions_.resize(3, count);
  for (Eigen::VectorXd* each : {&multipliers, &change, &wanted, &buffer, &lengths_, &tension_, &diagonal_}) {
    each->setZero(count);
  }
}

void LinkEquations::FindCouplings() {
  const std::vector<LinkPair> pairs = PairsOf(links_);
  for (const auto& [vertex, there] : EndsAtVertices(links_)) {
    for (const LinkEnd& a : there) {
      for (const LinkEnd& b : there) {
        if (a.link <= b.link) continue;
        const auto at = std::lower_bound(pairs.begin(), pairs.end(), LinkPair(a.link, b.link)) - pairs.begin();
        couplings_.push_back({static_cast<int>(at), a.link, b.link, vertex, a.sign * b.sign});
      }
    }
  }
  values_.resize(pairs.size());
  matrix_ = SparseLdlt(static_cast<int>(links_.size()), pairs, kMostLinkFactors);
}

void LinkEquations::Restart() {
  for (size_t i = 0; i < links_.size(); ++i) active_[i] = links_[i].sign == 0;
  releases_ = 0;
  multipliers.setZero();
  tension_.setZero();
}

bool LinkEquations::Release() {
  if (releases_ == kLimitReleases) return false;
  bool any = false;
  for (size_t i = 0; i < links_.size(); ++i) {
    double& multiplier = multipliers[static_cast<Eigen::Index>(i)];
    if (!active_[i] || links_[i].sign * multiplier >= 0) continue;
    active_[i] = false;
    multiplier = 0;
    any = true;
  }
  releases_ += any ? 1 : 0;
  return any;
}

void LinkEquations::Turn(const ConstPoints& x) {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d between = x.col(links_[i].b) - x.col(links_[i].a);
    lengths_[column] = between.norm();
    directions_.col(column).setZero();
    if (active_[i] && lengths_[column] > 0) directions_.col(column) = between / lengths_[column];
  }
}

void LinkEquations::Place(const ConstPoints& x) {
  Release();
  for (size_t i = 0; i < links_.size(); ++i) {
    if (links_[i].sign != 0 && links_[i].Violation(x) > kLimitViolated) active_[i] = true;
  }
  Turn(x);
}

void LinkEquations::PlaceReached(const State& state) {
  Restart();
  const double slow = kSlowLimit * state.v.cwiseAbs().maxCoeff();
  for (size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    active_[i] = link.sign == 0 || (link.Reached(state.x) && link.sign * link.Rate(state) >= -slow);
  }
  Turn(state.x);
}

double LinkEquations::LargestGap() const {
  double largest = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const double gap = lengths_[static_cast<Eigen::Index>(i)] - links_[i].length;
    if (active_[i]) largest = std::max(largest, std::abs(gap) / links_[i].length);
  }
  return largest;
}

void LinkEquations::Factorise(const VertexBlocks& inverse) {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d u = directions_.col(column);
    diagonal_[column] = u.dot((inverse[links_[i].a] + inverse[links_[i].b]) * u);
  }
  std::fill(values_.begin(), values_.end(), 0.0);
  for (const Coupling& c : couplings_) {
    values_[c.at] += c.sign * directions_.col(c.i).dot(inverse[c.vertex] * directions_.col(c.j));
  }
  matrix_.Factorise(diagonal_, values_, factors_);
}

void LinkEquations::Rates(const ConstPoints& y, Eigen::VectorXd& rates) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    rates[column] = directions_.col(column).dot(y.col(links_[i].b) - y.col(links_[i].a));
  }
}

void LinkEquations::AddImpulses(const Eigen::VectorXd& m, Points& f) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d impulse = m[column] * directions_.col(column);
    f.col(links_[i].a) += impulse;
    f.col(links_[i].b) -= impulse;
  }
}

void LinkEquations::AddResponse(const Eigen::VectorXd& m, const VertexBlocks& inverse, Points& y) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d impulse = m[column] * directions_.col(column);
    y.col(links_[i].a) += inverse[links_[i].a] * impulse;
    y.col(links_[i].b) -= inverse[links_[i].b] * impulse;
  }
}

void LinkEquations::ClosingRates(double seconds, Eigen::VectorXd& rates) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    rates[column] = active_[i] ? (links_[i].length - lengths_[column]) / seconds : 0;
  }
}

void LinkEquations::Centripetal(const ConstPoints& v, Eigen::VectorXd& rates) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d u = directions_.col(column), between = v.col(links_[i].b) - v.col(links_[i].a);
    const double along = u.dot(between);
    const bool acts = active_[i] && lengths_[column] > 0;
    rates[column] = acts ? -(between.squaredNorm() - along * along) / lengths_[column] : 0;
  }
}

void LinkEquations::SetTension(double g) {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const bool pulls = active_[i] && multipliers[column] > 0 && lengths_[column] > 0;
    tension_[column] = pulls ? g * multipliers[column] / lengths_[column] : 0;
  }
}

void LinkEquations::AddTension(VertexBlocks& diagonal) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    if (tension_[column] == 0) continue;
    const Eigen::Vector3d u = directions_.col(column);
    const Eigen::Matrix3d block = tension_[column] * (Eigen::Matrix3d::Identity() - u * u.transpose());
    diagonal[links_[i].a] += block;
    diagonal[links_[i].b] += block;
  }
}

void LinkEquations::AddTensionTimes(const Points& y, Points& product) const {
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    if (tension_[column] == 0) continue;
    const Eigen::Vector3d u = directions_.col(column), between = y.col(links_[i].b) - y.col(links_[i].a);
    const Eigen::Vector3d across = tension_[column] * (between - u.dot(between) * u);
    product.col(links_[i].a) -= across;
    product.col(links_[i].b) += across;
  }
}

void LinkEquations::AddEntries(const Eigen::VectorXd& stiffness, std::vector<Eigen::Triplet<double>>& entries) const {
  const auto add = [&entries](int i, int j, double scale, const Eigen::Matrix3d& block) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) entries.emplace_back(3 * i + r, 3 * j + c, scale * block(r, c));
    }
  };
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Matrix3d along = directions_.col(column) * directions_.col(column).transpose();
    const Eigen::Matrix3d block = stiffness[column] * along + tension_[column] * (Eigen::Matrix3d::Identity() - along);
    const Link& link = links_[i];
    if (link.inverse_a > 0) add(link.a, link.a, 1, block);
    if (link.inverse_b > 0) add(link.b, link.b, 1, block);
    if (link.inverse_a > 0 && link.inverse_b > 0) add(link.a, link.b, -1, block), add(link.b, link.a, -1, block);
  }
}

}  // namespace phrenic
