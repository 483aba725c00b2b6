#include "server/mechanics/forces/spring_rows.h"

#include <algorithm>

#include "server/mesh/locality.h"

namespace phrenic {
namespace {

// Rows that may change places to lie beside others of their length: more pads less and is less local.
constexpr int kWindow = 256;
// Ends of springs this many vertices apart, on the mean, no longer meet in a core's cache.
constexpr double kFarApart = 8192;

// One end of a spring as its row sees it.
struct RowSpring {
  int other = 0;  // simulated vertex
  double stiffness = 0, rest_length = 0;
};
using Rows = std::vector<std::vector<RowSpring>>;  // a simulated vertex

Rows ByVertex(const std::vector<Spring>& springs, int vertices) {
  Rows rows(vertices);
  for (const Spring& spring : springs) {
    rows[spring.a].push_back({spring.b, spring.stiffness, spring.rest_length});
    rows[spring.b].push_back({spring.a, spring.stiffness, spring.rest_length});
  }
  return rows;
}

// The vertices that have springs: as they come, which reads and writes them in one go, unless what a spring joins is
// too far apart for that.
std::vector<int> LocalRows(const std::vector<Spring>& springs, const Rows& rows) {
  Edges edges(2, static_cast<Eigen::Index>(springs.size()));
  for (size_t s = 0; s < springs.size(); ++s) edges.col(static_cast<Eigen::Index>(s)) << springs[s].a, springs[s].b;
  const double apart = springs.empty() ? 0 : (edges.row(1) - edges.row(0)).cwiseAbs().cast<double>().mean();
  if (apart > kFarApart) return LocalOrder(edges, static_cast<int>(rows.size()));
  std::vector<int> order;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].empty()) order.push_back(static_cast<int>(i));
  }
  return order;
}

std::vector<int> RowOrder(const std::vector<Spring>& springs, const Rows& rows) {
  std::vector<int> order = LocalRows(springs, rows);
  const auto longer = [&rows](int a, int b) { return rows[a].size() > rows[b].size(); };
  for (size_t first = 0; first < order.size(); first += kWindow) {
    const size_t end = std::min(first + kWindow, order.size());
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                     order.begin() + static_cast<std::ptrdiff_t>(end), longer);
  }
  return order;
}

}  // namespace

SpringRows::SpringRows(const std::vector<Spring>& springs, int vertices) {
  const Rows rows = ByVertex(springs, vertices);
  slices_.vertices = RowOrder(springs, rows);
  std::vector<std::int32_t> place(vertices, 0);
  for (size_t r = 0; r < slices_.vertices.size(); ++r) {
    place[slices_.vertices[r]] = static_cast<std::int32_t>(r) * kPackedStride;
  }
  slices_.first_column.push_back(0);
  for (size_t first = 0; first < slices_.vertices.size(); first += kSliceRows) {
    const size_t height = std::min<size_t>(kSliceRows, slices_.vertices.size() - first);
    size_t width = 0;
    for (size_t i = 0; i < height; ++i) width = std::max(width, rows[slices_.vertices[first + i]].size());
    const size_t column = slices_.columns.size();
    slices_.columns.resize(column + width);
    slices_.neighbours.resize(column + width);
    for (size_t i = 0; i < kSliceRows; ++i) {
      const std::int32_t own = static_cast<std::int32_t>(first + i) * kPackedStride;
      for (size_t c = 0; c < width; ++c) slices_.neighbours[column + c].place[i] = own;
      if (i >= height) continue;
      const std::vector<RowSpring>& row = rows[slices_.vertices[first + i]];
      for (size_t c = 0; c < row.size(); ++c) {
        slices_.neighbours[column + c].place[i] = place[row[c].other];
        slices_.columns[column + c].stiffness[i] = row[c].stiffness;
        slices_.columns[column + c].at_rest[i] = row[c].stiffness * row[c].rest_length;
      }
    }
    slices_.first_column.push_back(static_cast<std::int64_t>(slices_.columns.size()));
  }
}

void SpringRows::SetLoad(const Points& load) {
  slices_.load.assign(slices_.first_column.size() - 1, {});
  for (size_t r = 0; r < slices_.vertices.size(); ++r) {
    const auto force = load.col(slices_.vertices[r]);
    SliceLoad& slice = slices_.load[r / kSliceRows];
    slice.x[r % kSliceRows] = force.x(), slice.y[r % kSliceRows] = force.y(), slice.z[r % kSliceRows] = force.z();
  }
}

void SpringRows::AddForce(double scale, const ConstPoints& x, MutablePoints f) const {
  thread_local std::vector<PackedPoint> packed;
  const size_t rows = slices_.vertices.size();
  if (packed.size() < rows + kSliceRows) packed.resize(rows + kSliceRows);
  const double* const from = x.data();
  for (size_t r = 0; r < rows; ++r) {
    const double* const point = from + 3 * static_cast<std::ptrdiff_t>(slices_.vertices[r]);
    packed[r] = {point[0], point[1], point[2], 0};
  }
  AddSlices(slices_, scale, packed.data(), f.data());
}

}  // namespace phrenic
