#include "server/stream/rest_shape.h"

#include "server/mesh/topology.h"

namespace phrenic::stream {
namespace {

Eigen::Index CountVertices(const Model& model, const std::vector<int>& bodies) {
  Eigen::Index count = 0;
  for (const int body : bodies) count += model.bodies[body].mesh.vertices.cols();
  return count;
}

}  // namespace

std::vector<int> StreamedBodies(const Model& model, const Layout& layout) {
  std::vector<int> streamed;
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    if (layout.placement(body) == v1::PLACEMENT_STREAMED) streamed.push_back(body);
  }
  return streamed;
}

RestShape MakeRestShape(const Model& model, const std::vector<int>& bodies) {
  RestShape shape;
  shape.rest.resize(3, CountVertices(model, bodies));
  int first = 0;
  for (const int body : bodies) {
    const Mesh& mesh = model.bodies[body].mesh;
    shape.rest.middleCols(first, mesh.vertices.cols()) = mesh.vertices.cast<float>();
    const Edges edges = SpringEdges(mesh);
    const Eigen::Index before = shape.edges.cols();
    shape.edges.conservativeResize(2, before + edges.cols());
    shape.edges.rightCols(edges.cols()) = edges.array() + first;
    first += static_cast<int>(mesh.vertices.cols());
  }
  return shape;
}

Floats Pick(const Model& model, const Layout& layout, const std::vector<int>& bodies, const Floats& all) {
  Floats picked(3, CountVertices(model, bodies));
  Eigen::Index first = 0;
  for (const int body : bodies) {
    const Eigen::Index count = model.bodies[body].mesh.vertices.cols();
    picked.middleCols(first, count) = all.middleCols(layout.first_vertex(body), count);
    first += count;
  }
  return picked;
}

}  // namespace phrenic::stream
