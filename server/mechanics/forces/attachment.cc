#include "server/mechanics/forces/attachment.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/skinning/skin_drivers.h"
#include "server/mechanics/skinning/tissue_bodies.h"

namespace phrenic {
namespace {

absl::StatusOr<std::vector<int>> AnchorBodies(const v1::Attachment& scene, std::string_view path,
                                              const ModelBuilder& builder) {
  const std::string field = absl::StrCat(std::string(path), ".anchors");
  auto anchors = builder.Bodies(scene.anchors(), field);
  if (!anchors.ok()) return anchors;
  for (const int c : *anchors) {
    if (FollowsTissue(builder.model, builder.model.bodies[c])) {
      return FieldError(field,
                        absl::StrCat("body \"", builder.model.bodies[c].name,
                                     "\" is deformable, or follows a deformable body, and cannot be an anchor; name "
                                     "bodies that are driven or at rest"));
    }
  }
  return anchors;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> Attachment::Make(const v1::Attachment& scene, const std::string& given,
                                                        std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "attachment", scene.bodies());
  auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  auto anchors = AnchorBodies(scene, path, builder);
  if (!anchors.ok()) return anchors.status();
  std::unique_ptr<Attachment> force(new Attachment(name));
  force->thesis_ = scene.mode() == v1::ATTACHMENT_MODE_THESIS;
  std::vector<SkinWeight> weights;
  for (const int b : *bodies) {
    auto region = builder.Region(b, scene.region(), absl::StrCat(std::string(path), ".region"));
    if (!region.ok()) return region.status();
    force->AddVertices(scene, *anchors, *region, b, weights, builder);
  }
  force->Pack(std::move(weights), builder.model.mass.size());
  if (force->vertices_.empty()) {
    builder.ReportLeftOut(name, absl::StrFormat("no vertex is within %g m of an anchor", scene.radius()));
    return nullptr;
  }
  const auto count = static_cast<std::int64_t>(force->vertices_.size());
  builder.model.report.set_attachments(builder.model.report.attachments() + count);
  builder.ReportElement("force", name, count, "vertices",
                        absl::StrFormat("within %g mm, k = %g N/m%s", 1e3 * scene.radius(), scene.stiffness(),
                                        force->thesis_ ? " times the anchor's displacement per step (thesis)" : ""));
  return force;
}

void Attachment::AddVertices(const v1::Attachment& scene, const std::vector<int>& anchors,
                             const std::vector<bool>& region, int b, std::vector<SkinWeight>& weights,
                             ModelBuilder& builder) {
  const BodyModel& body = builder.model.bodies[b];
  const SkinDrivers search(builder, anchors);
  for (int i = 0; i < body.mesh.vertices.cols() && !builder.stop.Stopped(); ++i) {
    const int vertex = body.first_vertex + i;
    if (!region[i]) continue;
    const SkinDrivers::Nearby nearby = search.Nearest(body.mesh.vertices.col(i), scene.radius());
    if (nearby.distance >= scene.radius() || builder.model.inverse_mass[vertex] == 0) continue;
    const double stiffness = (1 - nearby.distance / scene.radius()) * scene.stiffness();
    const double damping = 2 * scene.damping_ratio() * std::sqrt(stiffness * builder.model.mass[vertex]);
    vertices_.push_back({vertex, stiffness, damping, body.mesh.vertices.col(i)});
    search.AppendWeights(nearby, vertex, 1, weights);
    builder.model.attached_vertices.push_back(vertex);
  }
}

// Packs the springs to the rest positions by block, and the skin weights by block and pose.
void Attachment::Pack(std::vector<SkinWeight> weights, Eigen::Index vertices) {
  const auto precedes = [](const AttachedVertex& attached, int vertex) { return attached.vertex < vertex; };
  std::sort(vertices_.begin(), vertices_.end(),
            [](const AttachedVertex& a, const AttachedVertex& b) { return a.vertex < b.vertex; });
  for (const AttachedVertex& attached : vertices_) {
    if (!thesis_) PackInto(rest_groups_.of, -1, attached, attached.stiffness, attached.damping);
  }
  const auto key = [](const SkinWeight& weight) {
    return std::tuple(weight.vertex / kVertexBlock, weight.pose, weight.vertex);
  };
  std::sort(weights.begin(), weights.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  for (const SkinWeight& weight : weights) {
    const AttachedVertex& attached = *std::lower_bound(vertices_.begin(), vertices_.end(), weight.vertex, precedes);
    const double stiffness = thesis_ ? 0 : weight.weight * attached.stiffness;
    const double damping = weight.weight * (thesis_ ? attached.stiffness : attached.damping);
    PackInto(pose_groups_.of, weight.pose, attached, stiffness, damping);
  }
  rest_groups_.Index(vertices), pose_groups_.Index(vertices);
}

void Attachment::Groups::Index(Eigen::Index vertices) {
  first.assign(vertices / kVertexBlock + 2, 0);
  for (const Group& group : of) ++first[group.block + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
}

// If a vertex has two weights of one pose, it goes into two packets: a packet contains each vertex at most once.
void Attachment::PackInto(std::vector<Group>& groups, int pose, const AttachedVertex& attached, double stiffness,
                          double damping) {
  const Eigen::Index block = attached.vertex / kVertexBlock;
  const auto offset = static_cast<std::int32_t>(3 * (attached.vertex % kVertexBlock));
  const bool same_group = !groups.empty() && groups.back().block == block && groups.back().pose == pose;
  if (!same_group) groups.push_back({block, pose, packets_.size(), packets_.size()});
  const auto full = [offset](const HoldPacket& packet) {
    return packet.count == kPacketVertices || packet.offset[packet.count - 1] == offset;
  };
  if (!same_group || full(packets_.back())) packets_.emplace_back();
  HoldPacket& packet = packets_.back();
  const std::int32_t i = packet.count++;
  packet.x[i] = attached.rest.x(), packet.y[i] = attached.rest.y(), packet.z[i] = attached.rest.z();
  packet.stiffness[i] = stiffness;
  packet.damping[i] = damping;
  packet.offset[i] = offset;
  groups.back().end_packet = packets_.size();
}

void Attachment::AddForce(const EvalContext& at, MutablePoints f) const {
  BlockContext all{at};
  all.pose_matrices = PoseMatricesOf(at).data();
  AddForceToBlock({0, f.cols()}, all, f);
}

void Attachment::AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const {
  const double scale = thesis_ ? at.parameters.time_step() : 1;
  const HoldPacket* const packets = packets_.data();
  const auto for_each = [&range](const Groups& groups, const auto& add) {
    const size_t end = groups.first[(range.end + kVertexBlock - 1) / kVertexBlock];
    for (size_t g = groups.first[range.first / kVertexBlock]; g < end; ++g) {
      add(groups.of[g], 3 * groups.of[g].block * kVertexBlock);
    }
  };
  for_each(rest_groups_, [&](const Group& group, Eigen::Index block) {
    AddHeld(packets + group.first_packet, packets + group.end_packet, at.x.data() + block, at.v.data() + block,
            f.data() + (block - 3 * range.first));
  });
  if (pose_groups_.of.empty()) return;
  for_each(pose_groups_, [&](const Group& group, Eigen::Index block) {
    AddCarried(at.pose_matrices[group.pose], scale, packets + group.first_packet, packets + group.end_packet,
               f.data() + (block - 3 * range.first));
  });
}

void Attachment::AddStiffness(const EvalContext&, StiffnessSink& sink) const {
  if (thesis_) return;
  for (const AttachedVertex& attached : vertices_) {
    sink.Add(attached.vertex, attached.vertex, attached.stiffness * Eigen::Matrix3d::Identity());
  }
}

void Attachment::AddDamping(const EvalContext&, Eigen::VectorXd& c) const {
  if (thesis_) return;
  for (const AttachedVertex& attached : vertices_) c[attached.vertex] += attached.damping;
}

}  // namespace phrenic
