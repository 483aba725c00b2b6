#include "server/mesh/renumber.h"

#include <algorithm>

namespace phrenic {
namespace {

template <typename Indices>
void Renumber(const std::vector<int>& number, Indices& indices) {
  for (int& vertex : indices.reshaped()) vertex = number[vertex];
}

}  // namespace

void KeepTriangles(const std::vector<bool>& keep, Mesh& mesh) {
  std::vector<int> kept;
  for (int t = 0; t < static_cast<int>(keep.size()); ++t) {
    if (keep[t]) kept.push_back(t);
  }
  mesh.triangles = Triangles(mesh.triangles(Eigen::all, kept));
}

void RenumberVertices(const std::vector<int>& number, Mesh& mesh) {
  int same = 0;
  while (same < static_cast<int>(number.size()) && number[same] == same) ++same;
  if (same == static_cast<int>(number.size())) return;
  Renumber(number, mesh.triangles);
  Renumber(number, mesh.tetrahedra);
  Renumber(number, mesh.edges);
  for (auto& [region, vertices] : mesh.regions) {
    for (int& vertex : vertices) vertex = number[vertex];
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
}

void DropUnusedVertices(Mesh& mesh) {
  std::vector<bool> used(static_cast<size_t>(mesh.vertices.cols()), false);
  for (const int vertex : mesh.triangles.reshaped()) used[vertex] = true;
  for (const int vertex : mesh.tetrahedra.reshaped()) used[vertex] = true;
  for (const int vertex : mesh.edges.reshaped()) used[vertex] = true;
  std::vector<int> number(used.size(), -1), kept;
  for (int i = 0; i < static_cast<int>(used.size()); ++i) {
    if (!used[i]) continue;
    number[i] = static_cast<int>(kept.size());
    kept.push_back(i);
  }
  if (kept.size() == used.size()) return;
  for (auto& [region, vertices] : mesh.regions) std::erase_if(vertices, [&](int vertex) { return !used[vertex]; });
  mesh.vertices = Points(mesh.vertices(Eigen::all, kept));
  RenumberVertices(number, mesh);
}

}  // namespace phrenic
