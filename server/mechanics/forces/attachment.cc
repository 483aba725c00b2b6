#include "server/mechanics/forces/attachment.h"

#include <algorithm>
#include <cmath>
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
  for (const int b : *bodies) {
    auto region = draft.Region(b, scene.region(), absl::StrCat(std::string(path), ".region"));
    if (!region.ok()) return region.status();
    force->AddHolds(scene, *carriers, *region, b, draft);
  }
  force->Sort();
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

void Attachment::Sort() {
  const auto place = [this](const Hold& hold) {
    return std::pair(hold.vertex / kVertexBlock, hold.shares > 0 ? shares_[hold.first_share].pose : -1);
  };
  std::stable_sort(holds_.begin(), holds_.end(),
                   [&place](const Hold& a, const Hold& b) { return place(a) < place(b); });
}

void Attachment::AddHolds(const v1::Attachment& scene, const std::vector<int>& carriers,
                          const std::vector<bool>& region, int b, Draft& draft) {
  const BodyModel& body = draft.model.bodies[b];
  const Carriers search(draft, carriers);
  for (int i = 0; i < body.mesh.vertices.cols(); ++i) {
    const int vertex = body.first_vertex + i;
    if (!region[i]) continue;
    const Carriers::Contact contact = search.Nearest(body.mesh.vertices.col(i));
    if (contact.distance >= scene.radius() || draft.model.inverse_mass[vertex] == 0) continue;
    const double stiffness = (1 - contact.distance / scene.radius()) * scene.stiffness();
    const double damping = 2 * scene.damping_ratio() * std::sqrt(stiffness * draft.model.mass[vertex]);
    const std::vector<RideShare> shares = search.Shares(contact, vertex);
    holds_.push_back({vertex, stiffness, damping, body.mesh.vertices.col(i), static_cast<int>(shares_.size()),
                      static_cast<int>(shares.size())});
    shares_.insert(shares_.end(), shares.begin(), shares.end());
    draft.model.attached_vertices.push_back(vertex);
  }
}

void Attachment::AddForceIn(const VertexRange& range, const Instant& at, MutablePoints f) const {
  // A block's holds are sorted by carrier, so that a pose becomes a matrix once and not once a vertex.
  int current = -1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  const auto before = [](const Hold& hold, Eigen::Index vertex) {
    return hold.vertex / kVertexBlock < vertex / kVertexBlock;
  };
  for (auto next = std::lower_bound(holds_.begin(), holds_.end(), range.first, before);
       next != holds_.end() && next->vertex < range.end; ++next) {
    const Hold& hold = *next;
    Eigen::Vector3d carried = hold.rest;
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    for (int s = hold.first_share; s < hold.first_share + hold.shares; ++s) {
      const Pose& pose = at.poses[shares_[s].pose];
      if (shares_[s].pose != current) rotation = pose.rotation.toRotationMatrix();
      current = shares_[s].pose;
      const Eigen::Vector3d turned = rotation * hold.rest;
      carried += shares_[s].weight * (turned + pose.translation - hold.rest);
      velocity += shares_[s].weight * (pose.velocity + pose.angular_velocity.cross(turned));
    }
    const std::ptrdiff_t place = 3 * static_cast<std::ptrdiff_t>(hold.vertex);
    Eigen::Map<Eigen::Vector3d> force(f.data() + place);
    if (thesis_) {
      force += hold.stiffness * at.parameters.time_step() * velocity;
      continue;
    }
    const Eigen::Map<const Eigen::Vector3d> x(at.x.data() + place), v(at.v.data() + place);
    force += hold.stiffness * (carried - x) + hold.damping * (velocity - v);
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
