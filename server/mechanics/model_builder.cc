#include "server/mechanics/model_builder.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "server/mechanics/body_names.h"
#include "server/mesh/topology.h"

namespace phrenic {
absl::StatusOr<std::vector<int>> ModelBuilder::Bodies(const Names& names, std::string_view path) const {
  std::vector<int> found;
  for (int i = 0; i < names.size(); ++i) {
    if (stop.Stopped()) return stop.status();
    auto named = BodiesNamed(model, names[i], absl::StrCat(std::string(path), "[", i, "]"));
    if (!named.ok()) return named;
    found.insert(found.end(), named->begin(), named->end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

absl::StatusOr<int> ModelBuilder::Body(const std::string& name, std::string_view path) const {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (model.bodies[b].name == name) return b;
  }
  return FieldError(path, absl::StrCat("there is no body \"", name, "\"; there are ", KnownBodyNames(model)));
}

absl::StatusOr<std::vector<int>> ModelBuilder::DeformableBodies(const Names& names, std::string_view path) const {
  absl::StatusOr<std::vector<int>> bodies = Bodies(names, path);
  if (!bodies.ok()) return bodies;
  for (const int b : *bodies) {
    if (model.bodies[b].first_vertex < 0) {
      return FieldError(path, absl::StrCat("body \"", model.bodies[b].name,
                                           "\" has no mass to act on; its role must be ROLE_DEFORMABLE"));
    }
  }
  return bodies;
}

absl::StatusOr<std::vector<bool>> ModelBuilder::Region(int body, const std::string& region,
                                                       std::string_view path) const {
  const Mesh& mesh = model.bodies[body].mesh;
  if (region.empty()) return std::vector<bool>(mesh.vertices.cols(), true);
  const auto found = mesh.regions.find(region);
  if (found == mesh.regions.end()) {
    std::vector<std::string> names;
    for (const auto& [name, vertices] : mesh.regions) names.push_back(name);
    return FieldError(path, absl::StrCat("body \"", model.bodies[body].name, "\" has no region \"", region, "\"",
                                         names.empty() ? "; it has none" : "; it has ", absl::StrJoin(names, ", ")));
  }
  std::vector<bool> mask(mesh.vertices.cols(), false);
  for (const int vertex : found->second) mask[vertex] = true;
  return mask;
}

absl::StatusOr<Selection> ModelBuilder::Select(int body, const std::string& region, const std::string& exclude_region,
                                               std::string_view path) const {
  auto inside = Region(body, region, absl::StrCat(std::string(path), ".region"));
  if (!inside.ok()) return inside.status();
  if (exclude_region.empty()) return Selection{*inside, std::vector<bool>(inside->size(), false)};
  auto excluded = Region(body, exclude_region, absl::StrCat(std::string(path), ".exclude_region"));
  if (!excluded.ok()) return excluded.status();
  return Selection{*std::move(inside), *std::move(excluded)};
}

absl::StatusOr<std::vector<int>> ModelBuilder::FreeVertices(int body, const std::string& region,
                                                            const Indices& vertices, std::string_view path) const {
  auto mask = Region(body, region, absl::StrCat(std::string(path), ".region"));
  if (!mask.ok()) return mask.status();
  std::vector<bool> listed(mask->size(), vertices.empty());
  for (int i = 0; i < vertices.size(); ++i) {
    const std::string field = absl::StrCat(std::string(path), ".vertices[", i, "]");
    if (absl::Status status = CheckVertex(body, vertices[i], field); !status.ok()) return status;
    listed[vertices[i]] = true;
  }
  std::vector<int> free;
  for (int i = 0; i < static_cast<int>(mask->size()); ++i) {
    const int vertex = model.bodies[body].first_vertex + i;
    if ((*mask)[i] && listed[i] && model.inverse_mass[vertex] > 0) free.push_back(vertex);
  }
  return free;
}

absl::Status ModelBuilder::CheckVertex(int body, int vertex, std::string_view path) const {
  const auto vertices = model.bodies[body].mesh.vertices.cols();
  if (vertex >= 0 && vertex < vertices) return absl::OkStatus();
  return FieldError(path, absl::StrCat("there is no vertex ", vertex, " in body \"", model.bodies[body].name,
                                       "\": its vertices are 0 to ", vertices - 1));
}

const NearestSearch& ModelBuilder::Search(int body) const {
  searches_.resize(model.bodies.size());
  std::unique_ptr<NearestSearch>& search = searches_[body];
  if (search == nullptr) search = std::make_unique<NearestSearch>(model.bodies[body].mesh.vertices);
  return *search;
}

const Edges& ModelBuilder::EdgesOf(int body) const {
  edges_.resize(model.bodies.size());
  std::unique_ptr<Edges>& edges = edges_[body];
  if (edges == nullptr) edges = std::make_unique<Edges>(SpringEdges(model.bodies[body].mesh));
  return *edges;
}

const std::vector<int>& ModelBuilder::BorderOf(int body) const {
  borders_.resize(model.bodies.size());
  std::unique_ptr<std::vector<int>>& border = borders_[body];
  if (border == nullptr)
    border = std::make_unique<std::vector<int>>(BoundaryVertices(model.bodies[body].mesh.triangles));
  return *border;
}

int ModelBuilder::AddScalar(std::string name, std::string unit, double initial, double initial_rate) {
  ReportElement("coordinate", name, 1, "scalar", absl::StrFormat("starts at %g %s", initial, unit));
  model.scalars.push_back({std::move(name), std::move(unit), initial, initial_rate});
  return static_cast<int>(model.scalars.size()) - 1;
}

int ModelBuilder::AddInternalScalars(const std::string& name, const std::string& unit, int count) {
  const int first = static_cast<int>(model.scalars.size());
  for (int i = 0; i < count; ++i) {
    model.scalars.push_back({.name = absl::StrCat(name, "-", i), .unit = unit, .internal = true});
  }
  ReportElement("coordinate", name, count, "scalars", "internal, start at 0");
  return first;
}

void ModelBuilder::ReportElement(std::string_view family, std::string_view name, std::int64_t count,
                                 std::string_view counted, std::string_view detail) {
  v1::ElementReport* element = model.report.add_elements();
  element->set_family(std::string(family));
  element->set_name(std::string(name));
  element->set_count(count);
  element->set_counted(std::string(counted));
  element->set_detail(std::string(detail));
}

void ModelBuilder::ReportLeftOut(std::string_view what, std::string_view why) {
  v1::LeftOut* left_out = model.report.add_left_out();
  left_out->set_what(std::string(what));
  left_out->set_why(std::string(why));
}

std::string ElementName(const std::string& given, std::string_view kind, const Names& names) {
  if (!given.empty()) return given;
  return absl::StrCat(std::string(kind), ":", absl::StrJoin(names, "+"));
}

Eigen::Vector3d ToEigen(const v1::Vector& vector) { return {vector.x(), vector.y(), vector.z()}; }

}  // namespace phrenic
