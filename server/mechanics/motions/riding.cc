#include "server/mechanics/motions/riding.h"

#include "absl/strings/str_cat.h"
#include "server/mechanics/carriers.h"

namespace phrenic {
namespace {

absl::Status CheckRider(const BodyModel& body, std::string_view path) {
  if (body.role != v1::ROLE_SEEN) {
    return FieldError(path, absl::StrCat("body \"", body.name, "\" must have ROLE_SEEN to ride on others"));
  }
  if (body.ride >= 0) return FieldError(path, absl::StrCat("body \"", body.name, "\" rides already"));
  return absl::OkStatus();
}

}  // namespace

absl::Status AddRides(const v1::Ride& scene, const std::string& given, std::string_view path, Draft& draft) {
  const std::string name = ElementName(given, "ride", scene.bodies());
  const std::string field = absl::StrCat(std::string(path), ".bodies");
  auto bodies = draft.Bodies(scene.bodies(), field);
  if (!bodies.ok()) return bodies.status();
  auto carriers = draft.Bodies(scene.carriers(), absl::StrCat(std::string(path), ".carriers"));
  if (!carriers.ok()) return carriers.status();
  const Carriers search(draft, *carriers);
  std::int64_t vertices = 0;
  for (const int b : *bodies) {
    BodyModel& body = draft.model.bodies[b];
    if (absl::Status status = CheckRider(body, field); !status.ok()) return status;
    Ride ride{.body = b, .shares = {}};
    for (int i = 0; i < body.mesh.vertices.cols(); ++i) {
      const std::vector<RideShare> shares = search.Blend(body.mesh.vertices.col(i), i);
      ride.shares.insert(ride.shares.end(), shares.begin(), shares.end());
    }
    body.ride = static_cast<int>(draft.model.rides.size());
    draft.model.rides.push_back(std::move(ride));
    vertices += body.mesh.vertices.cols();
  }
  draft.ReportElement("seen", name, vertices, "vertices", "worked out with each frame, not with each step");
  return absl::OkStatus();
}

}  // namespace phrenic
