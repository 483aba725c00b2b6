// Where each body's vertices are in a frame: constant for a session.
#ifndef PHRENIC_SERVER_STREAM_LAYOUT_H_
#define PHRENIC_SERVER_STREAM_LAYOUT_H_

#include <vector>

#include "phrenic/v1/frames.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::stream {

// Immutable; thread-safe. Publisher makes one for its model. Streamed bodies are those that deform: simulated ones, and
// surfaces skinned to them; a rigid body follows its pose, a still one stays at rest.
class Layout {
 public:
  // Keeps nothing of `model`.
  explicit Layout(const Model& model);

  // Requires, here and below: 0 <= body < model.bodies.size().
  v1::Placement placement(int body) const { return placements_[body].placement; }
  // Returns the index of the body's first vertex among the streamed vertices; 0 if the body is not streamed.
  int first_vertex(int body) const { return placements_[body].first_vertex; }
  // Returns the number of vertices of all streamed bodies.
  int vertices() const { return vertices_; }

 private:
  struct Place {
    v1::Placement placement = v1::PLACEMENT_STILL;
    int first_vertex = 0;
  };
  std::vector<Place> placements_;
  int vertices_ = 0;
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_LAYOUT_H_
