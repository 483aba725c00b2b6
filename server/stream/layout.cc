#include "server/stream/layout.h"

namespace phrenic::stream {

Layout::Layout(const Model& model) {
  for (const BodyModel& body : model.bodies) {
    Place place;
    if (body.first_vertex >= 0 || (body.pose < 0 && body.skin >= 0)) {
      place = {v1::PLACEMENT_STREAMED, vertices_};
      vertices_ += static_cast<int>(body.mesh.vertices.cols());
    } else if (body.pose >= 0) {
      place.placement = v1::PLACEMENT_RIGID;
    }
    placements_.push_back(place);
  }
}

}  // namespace phrenic::stream
