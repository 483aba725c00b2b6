#include "server/mechanics/constraints/swept_links.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/constraints/link.h"

namespace phrenic {
namespace {

constexpr double kRelaxation = 1.1;  // successive over-relaxation: errors over many links leave sooner
constexpr double kTolerated = 0.05;  // of the longest link: more is no longer what sweeps leave

// Returns the links by colour: links of one colour have no common movable vertex. Each takes the first colour that is
// free at both ends.
std::vector<std::vector<Link>> ByColour(const std::vector<Link>& links) {
  std::map<int, std::vector<bool>> taken;  // colours at each movable vertex
  std::vector<std::vector<Link>> colours;
  for (const Link& link : links) {
    const auto free = [&](int vertex, double inverse_mass, size_t colour) {
      return inverse_mass == 0 || taken[vertex].size() <= colour || !taken[vertex][colour];
    };
    size_t colour = 0;
    while (!free(link.a, link.inverse_a, colour) || !free(link.b, link.inverse_b, colour)) ++colour;
    for (const int vertex : {link.a, link.b}) {
      if (taken[vertex].size() <= colour) taken[vertex].resize(colour + 1);
      taken[vertex][colour] = true;
    }
    if (colours.size() <= colour) colours.resize(colour + 1);
    colours[colour].push_back(link);
  }
  return colours;
}

// Returns the vertices at the ends of links, in ascending order.
std::vector<int> EndsOf(const std::vector<Link>& links) {
  std::vector<int> vertices;
  vertices.reserve(2 * links.size());
  for (const Link& link : links) vertices.insert(vertices.end(), {link.a, link.b});
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

int PlaceIn(const std::vector<int>& vertices, int vertex) {
  return static_cast<int>(std::lower_bound(vertices.begin(), vertices.end(), vertex) - vertices.begin());
}

void Fetch(const ConstPoints& x, const ConstPoints& v, int vertex, SweptEnd& end) {
  for (int k = 0; k < 3; ++k) end.x[k] = x(k, vertex), end.v[k] = v(k, vertex);
}

void PutInto(const SweptEnd& end, int vertex, State& state) {
  for (int k = 0; k < 3; ++k) state.x(k, vertex) = end.x[k], state.v(k, vertex) = end.v[k];
}

// True if the link is to be restored.
bool Violated(const Link& link, const ConstPoints& x) { return link.sign == 0 || link.Violation(x) > 0; }

}  // namespace

struct SweptLinks::Memory {
  std::vector<LinkVectors> directions;  // one entry per packet
  std::vector<SweptEnd> ends;           // one per vertex
};

std::unique_ptr<Constraint> SweptLinks::Make(const std::string& name, const std::vector<Link>& links, int sweeps,
                                             ModelBuilder& builder) {
  builder.ReportElement("constraint", name, static_cast<std::int64_t>(links.size()), "links",
                        absl::StrCat("mass-weighted, velocities corrected; ", sweeps, " Gauss-Seidel sweeps a step"));
  return std::unique_ptr<Constraint>(new SweptLinks(name, links, sweeps));
}

SweptLinks::SweptLinks(std::string name, const std::vector<Link>& links, int sweeps)
    : Constraint(std::move(name)), vertices_(EndsOf(links)), sweeps_(sweeps) {
  for (std::vector<Link>& colour : ByColour(links)) {
    std::stable_sort(colour.begin(), colour.end(), [](const Link& p, const Link& q) { return p.a < q.a; });
    colour_start_.push_back(packets_.size());
    std::vector<Link> of_ends = colour;
    for (Link& link : of_ends) link.a = PlaceIn(vertices_, link.a), link.b = PlaceIn(vertices_, link.b);
    std::vector<LinkPacket> packets = PackSweptLinks(of_ends, static_cast<int>(links_.size()));
    for (LinkPacket& packet : packets) packet.relaxation = kRelaxation;
    packets_.insert(packets_.end(), packets.begin(), packets.end());
    links_.insert(links_.end(), colour.begin(), colour.end());
  }
  for (const Link& link : links) tolerated_ = std::max(tolerated_, kTolerated * link.length);
  colour_start_.push_back(packets_.size());
}

SweptEnd& SweptLinks::EndOf(int vertex, Memory& memory) const { return memory.ends[PlaceIn(vertices_, vertex)]; }

void SweptLinks::RestoreTurned(const Link& link, const Eigen::Vector3d& direction, double dt, Memory& memory,
                               State& state) const {
  for (const int vertex : {link.a, link.b}) PutInto(EndOf(vertex, memory), vertex, state);
  if (!Violated(link, state.x)) return;
  Restore(link, direction, dt, state.x, state.v);
  for (const int vertex : {link.a, link.b}) Fetch(state.x, state.v, vertex, EndOf(vertex, memory));
}

void SweptLinks::RestoreColour(size_t first, size_t end, double dt, Memory& memory, State& state) const {
  for (size_t p = first; p < end; p += kPacketsTogether) {
    const auto some = absl::MakeConstSpan(packets_).subspan(p, std::min<size_t>(kPacketsTogether, end - p));
    std::uint64_t missed = RestorePackets(some, &memory.directions[p], dt, memory.ends.data());
    for (; missed != 0; missed &= missed - 1) {
      const int bit = std::countr_zero(missed), lane = bit % kPacketLinks;
      const size_t packet = bit / kPacketLinks;
      const LinkVectors& of = memory.directions[p + packet];
      RestoreTurned(links_[some[packet].first + lane], {of.x[lane], of.y[lane], of.z[lane]}, dt, memory, state);
    }
  }
}

void SweptLinks::Sweep(bool backwards, double dt, Memory& memory, State& state) const {
  const size_t colours = colour_start_.size() - 1;
  for (size_t i = 0; i < colours; ++i) {
    const size_t colour = backwards ? colours - 1 - i : i;
    RestoreColour(colour_start_[colour], colour_start_[colour + 1], dt, memory, state);
  }
}

void SweptLinks::Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
                         State& state) const {
  if (!parameters.apply_links()) return;
  auto& memory = scratch.Get<Memory>();
  memory.directions.resize(packets_.size());
  memory.ends.resize(vertices_.size());
  for (size_t i = 0; i < vertices_.size(); ++i) Fetch(before, state.v, vertices_[i], memory.ends[i]);
  FindDirections(packets_, memory.ends.data(), memory.directions.data());
  for (size_t i = 0; i < vertices_.size(); ++i) Fetch(state.x, state.v, vertices_[i], memory.ends[i]);
  for (int i = 0; i < sweeps_; ++i) Sweep(i % 2 == 1, dt, memory, state);
  for (size_t i = 0; i < vertices_.size(); ++i) PutInto(memory.ends[i], vertices_[i], state);
}

void SweptLinks::ProjectVelocities(const v1::Parameters& parameters, const Scratch&, State& state) const {
  if (!parameters.apply_links()) return;
  for (int i = 0; i < sweeps_; ++i) {
    for (const Link& link : links_) {
      const bool holds = link.sign == 0 || (link.Reached(state.x) && link.sign * link.Rate(state) > 0);
      if (holds) StopStretching(link, state);
    }
  }
}

bool SweptLinks::SameMotion(const ConstPoints& before, const ConstPoints& after) const {
  return std::none_of(links_.begin(), links_.end(),
                      [&](const Link& link) { return link.sign != 0 && link.Reached(before) != link.Reached(after); });
}

void SweptLinks::ListLinks(std::vector<Link>& links) const { links.insert(links.end(), links_.begin(), links_.end()); }

double SweptLinks::Residual(const State& state) const {
  double worst = 0;
  for (const Link& link : links_) worst = std::max(worst, link.Violation(link.Stretch(state.x)));
  return worst;
}

}  // namespace phrenic
