// The model while it is compiled: what an element's Make function reads and writes.
#ifndef PHRENIC_SERVER_MECHANICS_MODEL_BUILDER_H_
#define PHRENIC_SERVER_MECHANICS_MODEL_BUILDER_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "google/protobuf/repeated_field.h"
#include "google/protobuf/repeated_ptr_field.h"
#include "server/mechanics/field_error.h"
#include "server/mechanics/model.h"
#include "server/mechanics/stop_check.h"
#include "server/mesh/nearest.h"

namespace phrenic {

using Names = google::protobuf::RepeatedPtrField<std::string>;
using Indices = google::protobuf::RepeatedField<std::int32_t>;

// The edges, triangles or tetrahedra of a body that an element uses: those with all vertices inside, except those with
// all vertices excluded. If one element names a region and another excludes it, they cover the mesh without gap or
// overlap.
struct Selection {
  std::vector<bool> inside, excluded;  // one per vertex

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

// Bodies, rest positions and masses are complete before the first element is made. Not thread-safe. A `path` is the
// scene field that errors name, such as "forces[2].springs.bodies".
struct ModelBuilder {
  Model model;
  // Loops over vertices leave when it has stopped, with an incomplete element: Compile then returns its status.
  StopCheck stop;

  // Returns the bodies that the names select, each once, in the scene's order. A name is a body's or a layer's, or is
  // qualified: "body:NAME", "layer:NAME", or "structure:STRUCTURE" for all bodies of that anatomy. INVALID_ARGUMENT
  // with the path and the existing names, also for a layer or a structure without bodies; the status of `stop`.
  absl::StatusOr<std::vector<int>> Bodies(const Names& names, std::string_view path) const;
  absl::StatusOr<int> Body(const std::string& name, std::string_view path) const;
  // The same. INVALID_ARGUMENT if one is not deformable.
  absl::StatusOr<std::vector<int>> DeformableBodies(const Names& names, std::string_view path) const;
  // Returns the mask of a body's vertices in a region; all if `region` is empty.
  absl::StatusOr<std::vector<bool>> Region(int body, const std::string& region, std::string_view path) const;
  // Returns the selection by the fields `region` and `exclude_region` of the element at `path`; all if both are empty.
  absl::StatusOr<Selection> Select(int body, const std::string& region, const std::string& exclude_region,
                                   std::string_view path) const;
  // Returns the free vertices of a deformable body, as simulated vertices: those listed, or if none are, those of the
  // region. By the fields `region` and `vertices` of the element at `path`.
  absl::StatusOr<std::vector<int>> FreeVertices(int body, const std::string& region, const Indices& vertices,
                                                std::string_view path) const;
  // INVALID_ARGUMENT if the body has no such vertex.
  absl::Status CheckVertex(int body, int vertex, std::string_view path) const;
  // Returns a search over the vertices of a body at rest, made at the first call. Valid as long as the builder.
  const NearestSearch& Search(int body) const;
  // Returns a body's edges: its mesh's own, otherwise those of its triangles (mesh/topology.h). Valid in the same way.
  const Edges& EdgesOf(int body) const;
  // Returns the vertices of a body's border; none if it is closed. Valid in the same way.
  const std::vector<int>& BorderOf(int body) const;

  // Adds a generalised coordinate and returns its index in State::scalars. It starts at `initial` [unit] with
  // `initial_rate` [unit/s]. No integrator advances it: the element that adds it drives it. Requires: no other
  // coordinate has the name.
  int AddScalar(std::string name, std::string unit, double initial, double initial_rate = 0);

  // Adds a coordinate with inertia [J s^2/unit^2], at rest at 0, which forces move; see Coordinate. Requires: no force
  // and no constraint has been made yet; no other coordinate has the name.
  Coordinate AddCoordinate(std::string name, std::string unit, double inertia);
  // Returns the coordinate of that name. INVALID_ARGUMENT with the path and the remedy if it does not exist.
  absl::StatusOr<Coordinate> FindCoordinate(std::string_view name, std::string_view path) const;
  // Adds `count` coordinates that are an element's memory (ScalarCoordinate::internal), which start at 0 and which a
  // force advances (Force::AdvanceScalars). Returns the index of the first.
  int AddInternalScalars(const std::string& name, const std::string& unit, int count);

  // Adds an element to the report, or something that the scene does not need.
  void ReportElement(std::string_view family, std::string_view name, std::int64_t count, std::string_view counted,
                     std::string_view detail);
  void ReportLeftOut(std::string_view what, std::string_view why);

 private:
  // One per body; null until asked for.
  mutable std::vector<std::unique_ptr<NearestSearch>> searches_;
  mutable std::vector<std::unique_ptr<Edges>> edges_;
  mutable std::vector<std::unique_ptr<std::vector<int>>> borders_;
};

// Returns the given name, or if it is empty the kind and the bodies' names: "springs:diaphragm".
std::string ElementName(const std::string& given, std::string_view kind, const Names& names);

Eigen::Vector3d ToEigen(const v1::Vector& vector);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MODEL_BUILDER_H_
