#include "server/compare/inspection.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/compare/refusals.h"
#include "server/mesh/normals.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"

namespace phrenic::compare {
namespace {

constexpr double kSquare = kMillimetresAMetre * kMillimetresAMetre;
constexpr double kMillilitres = 1e6;  // in a cubic metre

// Returns the triangles of each component, the largest component first.
std::vector<std::vector<int>> ComponentsBySize(const Mesh& mesh) {
  std::vector<std::vector<int>> components = Components(mesh);
  std::stable_sort(components.begin(), components.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return components;
}

// Returns a mesh of these triangles and the vertices that they use. `number` is scratch space, one entry per vertex of
// `mesh`: -1 before and after the call.
Mesh Extract(const Mesh& mesh, const std::vector<int>& triangles, std::vector<int>& number) {
  Mesh part;
  part.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  std::vector<int> used;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.triangles(k, triangles[t]);
      if (number[vertex] < 0) {
        number[vertex] = static_cast<int>(used.size());
        used.push_back(vertex);
      }
      part.triangles(k, static_cast<Eigen::Index>(t)) = number[vertex];
    }
  }
  part.vertices = mesh.vertices(Eigen::all, used);
  for (const int vertex : used) number[vertex] = -1;
  return part;
}

v1::SurfacePart PartOf(const Mesh& mesh) {
  const SurfaceTopology topology = AnalyseTopology(mesh);
  v1::SurfacePart part;
  part.set_vertices(topology.vertices);
  part.set_triangles(topology.triangles);
  part.set_boundary_edges(topology.boundary_edges);
  part.set_non_manifold_edges(topology.non_manifold_edges);
  part.set_misoriented_edges(topology.misoriented_edges);
  part.set_closed(topology.boundary_edges == 0 && topology.non_manifold_edges == 0);
  part.set_euler_characteristic(topology.euler_characteristic());
  part.set_pinched_vertices(static_cast<int>(PinchedVertices(mesh.triangles).size()));
  const bool whole = part.closed() && part.pinched_vertices() == 0;
  if (whole && part.euler_characteristic() % 2 == 0) part.set_genus(topology.genus());
  if (topology.watertight()) part.set_volume_ml(kMillilitres * SignedVolume(mesh.vertices, mesh.triangles));
  return part;
}

int UnusedVertices(const Mesh& mesh) {
  std::vector<bool> used(static_cast<std::size_t>(mesh.vertices.cols()), false);
  for (const int vertex : mesh.triangles.reshaped()) used[vertex] = true;
  for (const int vertex : mesh.edges.reshaped()) used[vertex] = true;
  return static_cast<int>(std::count(used.begin(), used.end(), false));
}

int DuplicateVertices(const Points& vertices) {
  std::vector<std::array<double, 3>> positions;
  positions.reserve(static_cast<std::size_t>(vertices.cols()));
  for (const auto vertex : vertices.colwise()) positions.push_back({vertex[0], vertex[1], vertex[2]});
  std::sort(positions.begin(), positions.end());
  return static_cast<int>(positions.end() - std::unique(positions.begin(), positions.end()));
}

void Count(const Mesh& mesh, v1::SurfaceReport& report) {
  const SurfaceTopology topology = AnalyseTopology(mesh);
  report.set_vertices(static_cast<int>(mesh.vertices.cols()));
  report.set_unused_vertices(UnusedVertices(mesh));
  report.set_duplicate_vertices(DuplicateVertices(mesh.vertices));
  report.set_triangles(topology.triangles);
  report.set_network_edges(static_cast<int>(mesh.edges.cols()));
  report.set_degenerate_triangles(topology.degenerate_triangles);
  report.set_boundary_edges(topology.boundary_edges);
  report.set_non_manifold_edges(topology.non_manifold_edges);
  report.set_misoriented_edges(topology.misoriented_edges);
  report.set_euler_characteristic(topology.euler_characteristic());
  std::vector<int> number(static_cast<std::size_t>(mesh.vertices.cols()), -1);
  for (const auto& triangles : ComponentsBySize(mesh))
    *report.add_components() = PartOf(Extract(mesh, triangles, number));
  report.set_pinched_vertices(static_cast<int>(PinchedVertices(mesh.triangles).size()));
}

void Measure(const Mesh& mesh, double unit_mm, v1::SurfaceReport& report) {
  const Eigen::Vector3d least = mesh.vertices.rowwise().minCoeff(), greatest = mesh.vertices.rowwise().maxCoeff();
  for (int axis = 0; axis < 3; ++axis) {
    report.add_least_mm(kMillimetresAMetre * least[axis]);
    report.add_greatest_mm(kMillimetresAMetre * greatest[axis]);
  }
  report.set_likely_unit(LikelyUnit(kMillimetresAMetre * (greatest - least).maxCoeff() / unit_mm));
  report.set_area_mm2(kSquare * VertexAreas(mesh.vertices, mesh.triangles).sum());
  double volume = 0;
  bool whole = report.components_size() > 0;
  for (const v1::SurfacePart& part : report.components()) {
    whole = whole && part.has_volume_ml();
    volume += part.volume_ml();
  }
  if (whole) report.set_volume_ml(volume);
}

template <typename... Args>
// Adds the sentence, which begins with the count, if the count is positive.
void AddIf(int count, google::protobuf::RepeatedPtrField<std::string>* sentences,
           const absl::FormatSpec<int, Args...>& format, const Args&... args) {
  if (count > 0) *sentences->Add() = absl::StrFormat(format, count, args...);
}

void JudgeRepairs(v1::SurfaceReport& report) {
  int inwards = 0;
  for (const v1::SurfacePart& part : report.components()) inwards += part.volume_ml() < 0 ? 1 : 0;
  auto* repairs = report.mutable_repairs();
  AddIf(report.duplicate_vertices(), repairs,
        "%d vertices have the same position as another vertex: weld them (phrenic convert --repair weld)");
  AddIf(report.unused_vertices(), repairs, "%d vertices belong to no triangle: remove them (--repair weld)");
  AddIf(report.degenerate_triangles(), repairs,
        "%d triangles have no area: finite elements skip them (--repair slivers)");
  AddIf(
      report.non_manifold_edges(), repairs,
      "%d edges have three or more triangles, so the inside is not defined there: remove the extra triangles (--repair "
      "fins)");
  AddIf(report.misoriented_edges(), repairs,
        "%d edges join triangles of opposite orientation: volumes and normals are wrong there (--repair orient)");
  AddIf(report.pinched_vertices(), repairs,
        "%d vertices join surfaces that touch in a point, where genus and normals are wrong: separate them (--repair "
        "pinches)");
  AddIf(report.boundary_edges(), repairs,
        "%d edges are open: close the surface if it is an organ, not a sheet (--repair cuts,holes; those larger than "
        "--hole-mm stay)");
  AddIf(inwards, repairs,
        "%d closed components face inwards: flip them unless they are cavities of other components (--repair orient)");
  if (report.unit_mm() == 1 && (report.likely_unit() == "cm" || report.likely_unit() == "m")) {
    repairs->Add(absl::StrCat("the size fits a body part in ", report.likely_unit(),
                              ", but mm are assumed: set --unit-mm here, or unit in a scene"));
  }
}

}  // namespace

std::string LikelyUnit(double extent) {
  // Parts of a trunk are 3 cm (a vertebra's process, a cartilage) to 1 m (the whole trunk) long.
  if (extent >= 30 && extent < 1000) return "mm";
  if (extent >= 3 && extent < 30) return "cm";
  return extent >= 0.03 && extent < 1 ? "m" : "";
}

v1::SurfaceReport Inspect(const std::string& name, const meshio::Surface& surface, double unit_mm) {
  v1::SurfaceReport report;
  report.set_name(name);
  report.set_unit_mm(unit_mm);
  if (surface.frame != meshio::Frame::kUnspecified)
    report.set_frame(surface.frame == meshio::Frame::kRas ? "RAS" : "LPS");
  Count(surface.mesh, report);
  Measure(surface.mesh, unit_mm, report);
  for (const auto& [region, vertices] : surface.mesh.regions) report.add_regions(region);
  JudgeRepairs(report);
  for (std::string& refusal : Refusals(surface.mesh)) report.add_refusals(std::move(refusal));
  return report;
}

}  // namespace phrenic::compare
