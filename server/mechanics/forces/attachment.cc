#include "server/mechanics/forces/attachment.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/carriers.h"

namespace phrenic {
namespace {

bool CarriedByTissue(const Model& model, const BodyModel& body) {
  if (body.first_vertex >= 0) return true;
  if (body.ride < 0) return false;
  if (!model.rides[body.ride].triangles.empty()) return true;
  const std::vector<RideShare>& shares = model.rides[body.ride].shares;
  return std::any_of(shares.begin(), shares.end(), [](const RideShare& share) { return share.pose < 0; });
}

absl::StatusOr<std::vector<int>> CarrierBodies(const v1::Attachment& scene, std::string_view path, const Draft& draft) {
  const std::string field = absl::StrCat(std::string(path), ".carriers");
  auto carriers = draft.Bodies(scene.carriers(), field);
  if (!carriers.ok()) return carriers;
  for (const int c : *carriers) {
    if (CarriedByTissue(draft.model, draft.model.bodies[c])) {
      return FieldError(field,
                        absl::StrCat("body \"", draft.model.bodies[c].name,
                                     "\" is deformable, or rides on what is, and cannot carry; name driven bodies or "
                                     "ones at rest"));
    }
  }
  return carriers;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> Attachment::Make(const v1::Attachment& scene, const std::string& given,
                                                        std::string_view path, Draft& draft) {
  const std::string name = ElementName(given, "attachment", scene.bodies());
  auto bodies = draft.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  auto carriers = CarrierBodies(scene, path, draft);
  if (!carriers.ok()) return carriers.status();
  std::unique_ptr<Attachment> force(new Attachment(name));
  force->thesis_ = scene.mode() == v1::ATTACHMENT_MODE_THESIS;
  std::vector<RideShare> shares;
  for (const int b : *bodies) {
    auto region = draft.Region(b, scene.region(), absl::StrCat(std::string(path), ".region"));
    if (!region.ok()) return region.status();
    force->AddHolds(scene, *carriers, *region, b, shares, draft);
  }
  force->Pack(std::move(shares));
  if (force->holds_.empty()) {
    draft.ReportLeftOut(name, absl::StrFormat("no vertex is within %g m of a carrier", scene.radius()));
    return nullptr;
  }
  const auto count = static_cast<std::int64_t>(force->holds_.size());
  draft.model.report.set_attachments(draft.model.report.attachments() + count);
  draft.ReportElement("force", name, count, "vertices",
                      absl::StrFormat("within %g mm, k = %g N/m%s", 1e3 * scene.radius(), scene.stiffness(),
                                      force->thesis_ ? " of the carrier's step (thesis)" : ""));
  return force;
}

void Attachment::AddHolds(const v1::Attachment& scene, const std::vector<int>& carriers,
                          const std::vector<bool>& region, int b, std::vector<RideShare>& shares, Draft& draft) {
  const BodyModel& body = draft.model.bodies[b];
  const Carriers search(draft, carriers);
  for (int i = 0; i < body.mesh.vertices.cols(); ++i) {
    const int vertex = body.first_vertex + i;
    if (!region[i]) continue;
    const Carriers::Contact contact = search.Nearest(body.mesh.vertices.col(i), scene.radius());
    if (contact.distance >= scene.radius() || draft.model.inverse_mass[vertex] == 0) continue;
    const double stiffness = (1 - contact.distance / scene.radius()) * scene.stiffness();
    const double damping = 2 * scene.damping_ratio() * std::sqrt(stiffness * draft.model.mass[vertex]);
    holds_.push_back({vertex, stiffness, damping, body.mesh.vertices.col(i)});
    for (const RideShare& share : search.Shares(contact, vertex)) shares.push_back(share);
    draft.model.attached_vertices.push_back(vertex);
  }
}

// By block, pose and vertex, each pose's in packets.
void Attachment::Pack(std::vector<RideShare> shares) {
  const auto by_vertex = [](const Hold& hold, int vertex) { return hold.vertex < vertex; };
  std::sort(holds_.begin(), holds_.end(), [](const Hold& a, const Hold& b) { return a.vertex < b.vertex; });
  const auto place = [](const RideShare& share) {
    return std::tuple(share.vertex / kVertexBlock, share.pose, share.vertex);
  };
  std::sort(shares.begin(), shares.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  int last = -1;
  for (const RideShare& share : shares) {
    const Hold& hold = *std::lower_bound(holds_.begin(), holds_.end(), share.vertex, by_vertex);
    const Eigen::Index block = share.vertex / kVertexBlock;
    const bool goes_on = !carried_.empty() && carried_.back().block == block && carried_.back().pose == share.pose;
    if (!goes_on) carried_.push_back({block, share.pose, packets_.size(), packets_.size()});
    if (!goes_on || packets_.back().count == kPacketVertices || share.vertex == last) packets_.emplace_back();
    CarriedPacket& packet = packets_.back();
    const std::int64_t i = packet.count++;
    packet.x[i] = hold.rest.x(), packet.y[i] = hold.rest.y(), packet.z[i] = hold.rest.z();
    packet.stiffness[i] = thesis_ ? 0 : share.weight * hold.stiffness;
    packet.damping[i] = share.weight * (thesis_ ? hold.stiffness : hold.damping);
    packet.place[i] = 3 * (share.vertex % kVertexBlock);
    carried_.back().end_packet = packets_.size();
    last = share.vertex;
  }
}

// Towards the vertex's own rest position, whatever carries it.
void Attachment::AddOwn(const VertexRange& range, const Instant& at, MutablePoints f) const {
  auto hold = std::lower_bound(holds_.begin(), holds_.end(), range.first,
                               [](const Hold& each, Eigen::Index vertex) { return each.vertex < vertex; });
  for (; hold != holds_.end() && hold->vertex < range.end; ++hold) {
    const std::ptrdiff_t place = 3 * static_cast<std::ptrdiff_t>(hold->vertex);
    const double *const x = at.x.data() + place, *const v = at.v.data() + place;
    double* const force = f.data() + (place - 3 * range.first);
    for (int k = 0; k < 3; ++k) force[k] += hold->stiffness * (hold->rest[k] - x[k]) - hold->damping * v[k];
  }
}

void Attachment::AddForceIn(const VertexRange& range, const Instant& at, MutablePoints f) const {
  if (!thesis_) AddOwn(range, at, f);
  const double scale = thesis_ ? at.parameters.time_step() : 1;
  auto carried = std::lower_bound(carried_.begin(), carried_.end(), range.first / kVertexBlock,
                                  [](const Carried& each, Eigen::Index block) { return each.block < block; });
  for (; carried != carried_.end() && carried->block * kVertexBlock < range.end; ++carried) {
    const CarriedPacket* const packets = packets_.data();
    AddCarried(at.poses[carried->pose], scale, packets + carried->first_packet, packets + carried->end_packet,
               f.data() + 3 * (carried->block * kVertexBlock - range.first));
  }
}

void Attachment::AddStiffness(const Instant&, StiffnessSink& sink) const {
  if (thesis_) return;
  for (const Hold& hold : holds_) sink.Add(hold.vertex, hold.vertex, hold.stiffness * Eigen::Matrix3d::Identity());
}

void Attachment::AddDamping(const Instant&, Eigen::VectorXd& c) const {
  if (thesis_) return;
  for (const Hold& hold : holds_) c[hold.vertex] += hold.damping;
}

}  // namespace phrenic
