#include "server/mechanics/compile/shapes.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/model_builder.h"
#include "server/mesh/ellipsoid.h"
#include "server/mesh/tetrahedra.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

constexpr double kMostCells = 1e6;  // largest grid of a filling

Mesh FromPolyhedron(const v1::Polyhedron& shape) {
  Mesh mesh;
  mesh.vertices.resize(3, shape.vertices_size());
  for (int i = 0; i < shape.vertices_size(); ++i) mesh.vertices.col(i) = ToEigen(shape.vertices(i));
  mesh.edges.resize(2, shape.edges_size());
  for (int i = 0; i < shape.edges_size(); ++i)
    mesh.edges.col(i) = Eigen::Vector2i(shape.edges(i).a(), shape.edges(i).b());
  mesh.triangles.resize(3, shape.triangles_size());
  for (int i = 0; i < shape.triangles_size(); ++i) {
    const v1::IndexTriple& t = shape.triangles(i);
    mesh.triangles.col(i) = Eigen::Vector3i(t.a(), t.b(), t.c());
  }
  return mesh;
}

// Splits cells along alternating diagonals, so that the sheet has no preferred direction.
Mesh FromGrid(const v1::Grid& shape) {
  const int columns = shape.columns(), rows = shape.rows();
  const Eigen::Vector3d origin = ToEigen(shape.origin()), u = ToEigen(shape.u()), v = ToEigen(shape.v());
  Mesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(columns) * rows);
  mesh.triangles.resize(3, 2 * static_cast<Eigen::Index>(columns - 1) * (rows - 1));
  Eigen::Index triangle = 0;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const int i = r * columns + c;
      mesh.vertices.col(i) = origin + c * u + r * v;
      if (r + 1 == rows || c + 1 == columns) continue;
      const int right = i + 1, up = i + columns, across = up + 1;
      const bool odd = (r + c) % 2 == 1;
      mesh.triangles.col(triangle++) = Eigen::Vector3i(i, right, odd ? up : across);
      mesh.triangles.col(triangle++) = odd ? Eigen::Vector3i(right, across, up) : Eigen::Vector3i(i, across, up);
    }
  }
  return mesh;
}

Mesh FromEllipsoid(const v1::Ellipsoid& shape) {
  return EllipsoidSurface(ToEigen(shape.centre()), ToEigen(shape.radii()), shape.divisions(), shape.upper_half());
}

Mesh FromBlock(const v1::Block& shape, const StopCheck& stop) {
  const Eigen::Vector3i cells(shape.columns(), shape.rows(), shape.layers());
  const Eigen::Vector3d cell = ToEigen(shape.size()).array() / cells.array().cast<double>();
  return FillCells({ToEigen(shape.origin()), cell, cells}, [&stop](const Eigen::Vector3d&) { return !stop.Stopped(); });
}

// A generated part encloses something, or is open by design; a file may have small holes, which filling tolerates.
absl::StatusOr<Mesh> ClosedPart(const v1::Body& body, const MeshSource& source) {
  absl::StatusOr<Mesh> surface = source(body);
  if (!surface.ok() || BoundaryVertices(surface->triangles).empty()) return surface;
  return absl::InvalidArgumentError("the surface of a filling must be closed, and this generated part is open");
}

// Returns the surface to fill.
absl::StatusOr<Mesh> SurfaceToFill(const v1::Body& body, const MeshSource& source) {
  v1::Body surface = body;
  switch (body.filling().surface_case()) {
    case v1::Filling::kEllipsoid:
      if (body.filling().ellipsoid().upper_half())
        return absl::InvalidArgumentError("the surface of a filling must be closed: unset upper_half");
      return FromEllipsoid(body.filling().ellipsoid());
    case v1::Filling::kFile:
      *surface.mutable_file() = body.filling().file();
      return source(surface);
    case v1::Filling::kGenerated:
      *surface.mutable_generated() = body.filling().generated();
      return ClosedPart(surface, source);
    case v1::Filling::SURFACE_NOT_SET:
      break;
  }
  return absl::InvalidArgumentError("fills no surface: set file, generated or ellipsoid");
}

absl::StatusOr<Mesh> FromFilling(const v1::Body& body, const MeshSource& source, const StopCheck& stop) {
  absl::StatusOr<Mesh> surface = SurfaceToFill(body, source);
  if (!surface.ok()) return surface;
  if (absl::Status status = Validate(*surface); !status.ok()) return status;
  const double cell = body.filling().cell();
  const Eigen::Vector3d low = surface->vertices.rowwise().minCoeff(),
                        size = surface->vertices.rowwise().maxCoeff() - low;
  const Eigen::Array3d cells = (size.array() / cell).ceil().max(1);
  if (cells.prod() > kMostCells) {
    return absl::InvalidArgumentError(
        absl::StrFormat("would be filled by %g cells: make them larger than %g m", cells.prod(), cell));
  }
  const Eigen::Vector3d margin = 0.5 * (cells * cell - size.array());
  Mesh solid = FillCells(
      {low - margin, Eigen::Vector3d::Constant(cell), cells.cast<int>()},
      [&](const Eigen::Vector3d& centre) { return !stop.Stopped() && WindingNumber(*surface, centre) > 0.5; });
  if (stop.Stopped()) return stop.status();
  if (solid.vertices.cols() > 0) return solid;
  return absl::InvalidArgumentError(
      absl::StrFormat("has no cell of %g m inside: make cells smaller, or turn a surface that faces inwards", cell));
}

absl::StatusOr<Mesh> UncheckedShape(const v1::Body& body, const MeshSource& source, const StopCheck& stop) {
  switch (body.shape_case()) {
    case v1::Body::kPolyhedron:
      return FromPolyhedron(body.polyhedron());
    case v1::Body::kGrid:
      return FromGrid(body.grid());
    case v1::Body::kBlock:
      return FromBlock(body.block(), stop);
    case v1::Body::kFilling:
      return FromFilling(body, source, stop);
    case v1::Body::kEllipsoid:
      return FromEllipsoid(body.ellipsoid());
    case v1::Body::kFile:
    case v1::Body::kGenerated:
    case v1::Body::kDerived:
      return source(body);
    case v1::Body::SHAPE_NOT_SET:
      break;
  }
  return absl::InvalidArgumentError(
      "has no shape: set file, generated, derived, polyhedron, grid, block, filling or ellipsoid");
}

absl::Status InBody(const v1::Body& body, const absl::Status& status) {
  return {status.code(), absl::StrCat("body \"", body.name(), "\": ", status.message())};
}

}  // namespace

absl::StatusOr<Mesh> MakeShape(const v1::Body& body, const MeshSource& source, const StopCheck& stop) {
  if (stop.Stopped()) return stop.status();
  absl::StatusOr<Mesh> mesh = UncheckedShape(body, source, stop);
  if (stop.Stopped()) return stop.status();
  if (!mesh.ok()) return InBody(body, mesh.status());
  if (body.has_scale()) {
    const Eigen::Vector3d scale = ToEigen(body.scale());
    if (!(scale.array() >= 0.001 && scale.array() <= 1000).all()) {
      return InBody(body, absl::InvalidArgumentError("scale: each axis needs a factor from 0.001 to 1000"));
    }
    mesh->vertices.array().colwise() *= scale.array();
  }
  mesh->vertices.colwise() += ToEigen(body.offset());
  if (absl::Status status = Validate(*mesh); !status.ok()) return InBody(body, status);
  if (const double largest = mesh->vertices.cwiseAbs().maxCoeff(); largest > kMaxCoordinate) {
    return InBody(
        body, absl::InvalidArgumentError(absl::StrFormat(
                  "has a coordinate of %g m; at most %g m is accepted: is the unit right?", largest, kMaxCoordinate)));
  }
  return mesh;
}

}  // namespace phrenic
