#include "server/mechanics/constraints/rigid_links.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/constraints/link_pairing.h"
#include "server/mechanics/constraints/swept_links.h"
#include "server/mechanics/constraints/thesis_links.h"
#include "server/mechanics/linalg/state_bounds.h"

namespace phrenic {
namespace {

absl::StatusOr<std::vector<Link>> PairedLinks(const v1::LinkPairing& scene, int body, const std::string& path,
                                              const ModelBuilder& builder) {
  auto pairs = PairLinks(scene, body, path, builder);
  if (!pairs.ok()) return pairs.status();
  const int first = builder.model.bodies[body].first_vertex;
  std::vector<Link> links;
  for (const auto pair : pairs->colwise()) links.push_back(MakeLink(builder.model, first + pair[0], first + pair[1]));
  return links;
}

absl::StatusOr<std::vector<Link>> FindLinks(const v1::RigidLinks& scene, int body, const std::string& path,
                                            const ModelBuilder& builder) {
  switch (scene.which_case()) {
    case v1::RigidLinks::kPairing:
      return PairedLinks(scene.pairing(), body, path + ".pairing", builder);
    case v1::RigidLinks::kList:
      return ListedLinks(scene.list(), body, path + ".list", builder);
    case v1::RigidLinks::WHICH_NOT_SET:
      break;
  }
  return FieldError(path, "selects no vertices to link: set pairing or list");
}

// Returns the number of links at each movable vertex.
std::vector<int> LinksPerVertex(const std::vector<Link>& links, const Model& model) {
  std::vector<int> count(static_cast<size_t>(model.rest.cols()), 0);
  for (const Link& link : links) {
    count[link.a] += link.inverse_a > 0;
    count[link.b] += link.inverse_b > 0;
  }
  return count;
}

// True if both ends are movable and in the same block.
bool InOneBlock(const Link& link) {
  return link.inverse_a > 0 && link.inverse_b > 0 && link.a / kVertexBlock == link.b / kVertexBlock;
}

// Returns the index of each block's first packet, and the number of packets.
std::vector<size_t> BlockStarts(const std::vector<Link>& links, const std::vector<LinkPacket>& packets,
                                Eigen::Index vertices) {
  std::vector<size_t> starts((vertices + kVertexBlock - 1) / kVertexBlock + 1, 0);
  for (const LinkPacket& packet : packets) ++starts[links[packet.first].a / kVertexBlock + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  return starts;
}

// Adds the links to the list that viewers display.
void AddToDisplay(const std::vector<Link>& links, Model& model) {
  Eigen::Index at = model.rigid_links.cols();
  model.rigid_links.conservativeResize(2, at + static_cast<Eigen::Index>(links.size()));
  for (const Link& link : links) model.rigid_links.col(at++) = Eigen::Vector2i(link.a, link.b);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Constraint>> RigidLinks::Make(const v1::RigidLinks& scene, const std::string& given,
                                                             std::string_view path, ModelBuilder& builder) {
  const std::string name = given.empty() ? absl::StrCat("rigid-links:", scene.body()) : given;
  const std::string field(path);
  auto b = DeformableBody(scene.body(), absl::StrCat(field, ".body"), builder);
  if (!b.ok()) return b.status();
  auto links = FindLinks(scene, *b, field, builder);
  if (!links.ok()) return links.status();
  if (links->empty()) {
    builder.ReportLeftOut(name, "no two vertices match the pairing");
    return nullptr;
  }
  AddToDisplay(*links, builder.model);
  const auto count = static_cast<std::int64_t>(links->size());
  builder.model.report.set_rigid_links(builder.model.report.rigid_links() + count);
  if (scene.projection() == v1::PROJECTION_THESIS) {
    if (scene.sweeps() > 0) return FieldError(absl::StrCat(field, ".sweeps"), "has no meaning with PROJECTION_THESIS");
    builder.ReportElement("constraint", name, count, "links", "correction split by displacement (thesis 2.10-2.11)");
    return std::make_unique<ThesisLinks>(name, *std::move(links));
  }
  if (scene.sweeps() > 0) {
    std::erase_if(*links, [](const Link& link) { return !link.Movable(); });
    return SweptLinks::Make(name, *links, scene.sweeps(), builder);
  }
  std::unique_ptr<RigidLinks> constraint(new RigidLinks(name, *links, builder.model));
  if (!constraint->network_.complete()) return TooTangled(path, links->size());
  builder.ReportElement("constraint", name, count, "links",
                        absl::StrCat("mass-weighted, velocities corrected; ", constraint->network_.links().size(),
                                     " solved simultaneously"));
  return constraint;
}

RigidLinks::RigidLinks(std::string name, const std::vector<Link>& links, const Model& model)
    : BlockConstraint(std::move(name)) {
  const std::vector<int> count = LinksPerVertex(links, model);
  std::vector<Link> joined;
  for (const Link& link : links) {
    if (count[link.a] < 2 && count[link.b] < 2) {
      alone_.push_back(link);
    } else if (link.Movable()) {
      joined.push_back(link);
    }
  }
  if (!joined.empty()) network_ = LinkNetwork(joined);
  PackAlone(model.rest.cols());
}

void RigidLinks::PackAlone(Eigen::Index vertices) {
  const auto key = [](const Link& link) { return std::tuple(!InOneBlock(link), link.a / kVertexBlock, !IsPair(link)); };
  std::stable_sort(alone_.begin(), alone_.end(), [&](const Link& p, const Link& q) { return key(p) < key(q); });
  const auto across = std::partition_point(alone_.begin(), alone_.end(), InOneBlock);
  const auto inside = static_cast<size_t>(across - alone_.begin());
  const absl::Span<const Link> all(alone_);
  packets_ = PackLinks(all.first(inside), 0, true);
  block_start_ = BlockStarts(alone_, packets_, vertices);
  const std::vector<LinkPacket> others = PackLinks(all.subspan(inside), static_cast<int>(inside), false);
  packets_.insert(packets_.end(), others.begin(), others.end());
  for (const auto links : {all.subspan(inside), absl::Span<const Link>(network_.links())}) {
    for (const Link& link : links) across_.insert(across_.end(), {link.a, link.b});
  }
  std::sort(across_.begin(), across_.end());
  across_.erase(std::unique(across_.begin(), across_.end()), across_.end());
}

double RigidLinks::RestoreAlone(absl::Span<const LinkPacket> packets, Eigen::Index from, const LinkVectors* directions,
                                double dt, Points& x, Points& v) const {
  double largest = 0;
  for (size_t p = 0; p < packets.size(); p += kPacketsTogether) {
    const absl::Span<const LinkPacket> some = packets.subspan(p, kPacketsTogether);
    auto [missed, furthest] = RestorePackets(some, directions + p, dt, x.data() + 3 * from, v.data() + 3 * from);
    largest = LargerMagnitude(missed == 0 ? furthest : std::numeric_limits<double>::infinity(), largest);
    for (; missed != 0; missed &= missed - 1) {
      const int bit = std::countr_zero(missed), lane = bit % kPacketLinks;
      const LinkVectors& of = directions[p + bit / kPacketLinks];
      Restore(alone_[some[bit / kPacketLinks].first + lane], {of.x[lane], of.y[lane], of.z[lane]}, dt, x, v);
    }
  }
  return largest;
}

void RigidLinks::RestoreAcross(const ConstPoints& before, double dt, const Scratch& scratch, State& state) const {
  const absl::Span<const LinkPacket> packets = absl::MakeConstSpan(packets_).subspan(block_start_.back());
  LinkVectors directions[kPacketsTogether];
  for (size_t p = 0; p < packets.size(); p += kPacketsTogether) {
    const absl::Span<const LinkPacket> some = packets.subspan(p, kPacketsTogether);
    FindDirections(some, before.data(), directions);
    RestoreAlone(some, 0, directions, dt, state.x, state.v);
  }
  network_.Project(before, dt, scratch, state);
}

absl::Span<const LinkPacket> RigidLinks::PacketsIn(const VertexRange& block) const {
  const Eigen::Index b = block.first / kVertexBlock;
  return absl::MakeConstSpan(packets_).subspan(block_start_[b], block_start_[b + 1] - block_start_[b]);
}

void RigidLinks::RecordStart(const VertexRange& block, const ConstPoints& x, double* start) const {
  FindDirections(PacketsIn(block), x.data() + 3 * block.first, reinterpret_cast<LinkVectors*>(start));
}

double RigidLinks::ProjectBlock(const VertexRange& block, const double* start, double dt, Points& x, Points& v) const {
  return RestoreAlone(PacketsIn(block), block.first, reinterpret_cast<const LinkVectors*>(start), dt, x, v);
}

void RigidLinks::ProjectAcrossBlocks(const v1::Parameters& parameters, const ConstPoints& before, double dt,
                                     const Scratch& scratch, State& state) const {
  if (parameters.apply_links()) RestoreAcross(before, dt, scratch, state);
}

void RigidLinks::Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
                         State& state) const {
  if (!parameters.apply_links()) return;
  alignas(LinkVectors) double start[3 * kVertexBlock];
  for (Eigen::Index first = 0; first < state.x.cols(); first += kVertexBlock) {
    const VertexRange block = {first, std::min(first + kVertexBlock, state.x.cols())};
    RecordStart(block, before, start);
    ProjectBlock(block, start, dt, state.x, state.v);
  }
  RestoreAcross(before, dt, scratch, state);
}

void RigidLinks::ProjectVelocities(const v1::Parameters& parameters, const Scratch& scratch, State& state) const {
  if (!parameters.apply_links()) return;
  for (const Link& link : alone_) StopStretching(link, state);
  network_.ProjectVelocities(scratch, state);
}

void RigidLinks::ListLinks(std::vector<Link>& links) const {
  std::copy_if(alone_.begin(), alone_.end(), std::back_inserter(links),
               [](const Link& link) { return link.Movable(); });
  links.insert(links.end(), network_.links().begin(), network_.links().end());
}

double RigidLinks::Residual(const State& state) const {
  double worst = 0;
  for (const Link& link : alone_) {
    if (link.Movable()) worst = std::max(worst, std::abs(link.Stretch(state.x)));
  }
  for (const Link& link : network_.links()) worst = std::max(worst, std::abs(link.Stretch(state.x)));
  return worst;
}

}  // namespace phrenic
