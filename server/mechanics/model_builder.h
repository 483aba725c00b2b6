// What an element's Make sees of the scene while it is being compiled, and how it reports.
#ifndef PHRENIC_SERVER_MECHANICS_MODEL_BUILDER_H_
#define PHRENIC_SERVER_MECHANICS_MODEL_BUILDER_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "google/protobuf/repeated_field.h"
#include "google/protobuf/repeated_ptr_field.h"
#include "server/mechanics/model.h"
#include "server/mesh/nearest.h"

namespace phrenic {

using Names = google::protobuf::RepeatedPtrField<std::string>;
using Indices = google::protobuf::RepeatedField<std::int32_t>;

// Which elements of a body take part: those with all their vertices inside, but for those with all of them excluded.
// Two elements of which one names a region and the other excludes it share out a mesh with no gap and no overlap.
struct Selection {
  std::vector<bool> inside, excluded;  // a vertex

  template <typename Vertices>
  bool Takes(const Vertices& vertices) const {
    bool all_inside = true, all_excluded = true;
    for (const int vertex : vertices) {
      all_inside = all_inside && inside[vertex];
      all_excluded = all_excluded && excluded[vertex];
    }
    return all_inside && !all_excluded;
  }
};

// The model in the making: bodies, rest positions and masses are there before the first element is made.
struct ModelBuilder {
  Model model;

  // The bodies that the names mean, each once, in the scene's order. A name is a body's or a layer's, or says which:
  // "body:NAME", "layer:NAME", or "structure:STRUCTURE" for all bodies of that anatomy. INVALID_ARGUMENT with the
  // field's path and the names there are, also for a layer or a structure that has no body.
  absl::StatusOr<std::vector<int>> Bodies(const Names& names, std::string_view path) const;
  absl::StatusOr<int> Body(const std::string& name, std::string_view path) const;
  // The same, and each must be deformable.
  absl::StatusOr<std::vector<int>> DeformableBodies(const Names& names, std::string_view path) const;
  // Vertices of a region of a body, as a mask; every vertex where `region` is empty.
  absl::StatusOr<std::vector<bool>> Region(int body, const std::string& region, std::string_view path) const;
  // By fields `region` and `exclude_region` of the element at `path`; everything where both are empty.
  absl::StatusOr<Selection> Select(int body, const std::string& region, const std::string& exclude_region,
                                   std::string_view path) const;
  // The free ones of a deformable body's vertices, as simulated vertices: those listed, or where none are those of the
  // region. By fields `region` and `vertices` of the element at `path`.
  absl::StatusOr<std::vector<int>> FreeVertices(int body, const std::string& region, const Indices& vertices,
                                                std::string_view path) const;
  absl::Status CheckVertex(int body, int vertex, std::string_view path) const;
  // Over the vertices of a body at rest; made when first asked for. Valid while the builder is.
  const NearestSearch& Search(int body) const;
  // The same of a body's edges: its mesh's own, or else its triangles' (mesh/topology.h).
  const Edges& EdgesOf(int body) const;
  // And its border's vertices, none where it is closed.
  const std::vector<int>& BorderOf(int body) const;

  // Adds a generalised coordinate and returns its index in State::scalars. It starts at `initial` [unit] with
  // `initial_rate` [unit/s]. No integrator advances it: the element that adds it drives it. Requires: no other
  // coordinate has the name.
  int AddScalar(std::string name, std::string unit, double initial, double initial_rate = 0);

  void ReportElement(std::string_view family, std::string_view name, std::int64_t count, std::string_view counted,
                     std::string_view detail);
  void ReportLeftOut(std::string_view what, std::string_view why);

 private:
  // Of each body; null where none has asked.
  mutable std::vector<std::unique_ptr<NearestSearch>> searches_;
  mutable std::vector<std::unique_ptr<Edges>> edges_;
  mutable std::vector<std::unique_ptr<std::vector<int>>> borders_;
};

// Bodies' names joined for an element that has no name of its own: "springs:diaphragm".
std::string ElementName(const std::string& given, std::string_view kind, const Names& names);

Eigen::Vector3d ToEigen(const v1::Vector& vector);

// INVALID_ARGUMENT "path: what".
absl::Status FieldError(std::string_view path, std::string_view what);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MODEL_BUILDER_H_
