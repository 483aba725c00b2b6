#include "server/mechanics/compile/shape_size.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace phrenic {
namespace {

constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();

std::int64_t Product(std::initializer_list<std::int64_t> factors) {
  std::int64_t product = 1;
  for (const std::int64_t factor : factors) product = SaturatingProduct(product, std::max<std::int64_t>(0, factor));
  return product;
}

MeshSize SizeOfPolyhedron(const v1::Polyhedron& shape) {
  const std::int64_t triangles = shape.triangles_size();
  const std::int64_t edges = shape.edges_size() > 0 ? shape.edges_size() : 3 * triangles;
  return {shape.vertices_size(), edges, triangles, 0};
}

MeshSize SizeOfGrid(const v1::Grid& shape) {
  const std::int64_t columns = shape.columns(), rows = shape.rows();
  const std::int64_t vertices = Product({columns, rows});
  return {vertices, SaturatingProduct(3, vertices), Product({2, columns - 1, rows - 1}), 0};
}

// Five tetrahedra per cell; their edges are those of the lattice and one diagonal per face.
MeshSize SizeOfCells(std::int64_t x, std::int64_t y, std::int64_t z) {
  const std::int64_t vertices = Product({x + 1, y + 1, z + 1});
  const std::int64_t faces =
      SaturatingSum(SaturatingSum(Product({x, y}), Product({y, z})), Product({z, x}));  // of one side of each axis
  return {vertices, SaturatingProduct(6, vertices), SaturatingProduct(4, faces), Product({5, x, y, z})};
}

MeshSize SizeOfEllipsoid(const v1::Ellipsoid& shape) {
  const std::int64_t square = Product({shape.divisions(), shape.divisions()});
  const std::int64_t triangles = SaturatingProduct(8, square);
  return {SaturatingSum(SaturatingProduct(4, square), 2), SaturatingProduct(12, square), triangles, 0};
}

std::int64_t CellsAlong(double length, double cell) {
  constexpr double kMost = 1e12;  // more than any limit
  return static_cast<std::int64_t>(std::clamp(std::ceil(std::abs(length) / cell), 1.0, kMost));
}

// The surface is built as well.
MeshSize SizeOfFilling(const v1::Body& body, const SizeSource& source) {
  const v1::Filling& filling = body.filling();
  if (!filling.has_ellipsoid()) {
    v1::Body surface;
    *surface.mutable_anatomy() = body.anatomy();
    if (filling.has_file()) *surface.mutable_file() = filling.file();
    if (filling.has_generated()) *surface.mutable_generated() = filling.generated();
    return SizeOfShape(surface, source);
  }
  const v1::Vector& radii = filling.ellipsoid().radii();
  const double cell = filling.cell();
  return SizeOfCells(CellsAlong(2 * radii.x(), cell), CellsAlong(2 * radii.y(), cell), CellsAlong(2 * radii.z(), cell));
}

}  // namespace

std::int64_t SaturatingSum(std::int64_t a, std::int64_t b) {
  std::int64_t sum = 0;
  return __builtin_add_overflow(a, b, &sum) ? kLargest : sum;
}

std::int64_t SaturatingProduct(std::int64_t a, std::int64_t b) {
  std::int64_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? kLargest : product;
}

MeshSize SizeOfShape(const v1::Body& body, const SizeSource& source) {
  switch (body.shape_case()) {
    case v1::Body::kPolyhedron:
      return SizeOfPolyhedron(body.polyhedron());
    case v1::Body::kGrid:
      return SizeOfGrid(body.grid());
    case v1::Body::kBlock:
      return SizeOfCells(body.block().columns(), body.block().rows(), body.block().layers());
    case v1::Body::kFilling:
      return SizeOfFilling(body, source);
    case v1::Body::kEllipsoid:
      return SizeOfEllipsoid(body.ellipsoid());
    case v1::Body::kFile:
    case v1::Body::kGenerated:
    case v1::Body::kDerived:
      return source == nullptr ? MeshSize{} : source(body);
    case v1::Body::SHAPE_NOT_SET:
      break;
  }
  return {};
}

}  // namespace phrenic
