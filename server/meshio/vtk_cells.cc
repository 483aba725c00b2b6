#include "server/meshio/vtk_cells.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"

namespace phrenic::meshio {

void VtkCells::Add(VtkCell kind, const std::vector<std::int64_t>& corners, std::int64_t first) {
  if (kind == VtkCell::kVertex) return;
  corners_.clear();
  for (const std::int64_t corner : corners) {
    const std::int64_t index = std::clamp<std::int64_t>(corner, INT32_MIN, INT32_MAX) + first;
    min_index_ = std::min(min_index_, index);
    max_index_ = std::max(max_index_, index);
    corners_.push_back(static_cast<int>(std::clamp<std::int64_t>(index, 0, INT32_MAX)));
  }
  if (kind == VtkCell::kPolygon) builder_.AddPolygon(corners_);
  for (std::size_t i = 1; kind == VtkCell::kLine && i < corners_.size(); ++i) {
    builder_.lines.insert(builder_.lines.end(), {corners_[i - 1], corners_[i]});
  }
  for (std::size_t i = 2; kind == VtkCell::kStrip && i < corners_.size(); ++i) {
    int a = corners_[i - 2], b = corners_[i - 1];
    if (i % 2 == 1) std::swap(a, b);
    builder_.triangles.insert(builder_.triangles.end(), {a, b, corners_[i]});
  }
}

std::string VtkCells::AddAll(VtkCell kind, const std::vector<std::int64_t>& offsets,
                             const std::vector<std::int64_t>& corners, bool from_zero, std::int64_t first) {
  const auto size = static_cast<std::int64_t>(corners.size());
  std::int64_t start = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const std::int64_t end = offsets[i];
    if (end < start || end > size || (from_zero && i == 0 && end != 0)) {
      return absl::StrCat("offset ", i, " is ", end, ", outside ", start, " to ", size, ", the number of corners");
    }
    if (from_zero && i == 0) continue;
    Add(kind, {corners.begin() + start, corners.begin() + end}, first);
    start = end;
  }
  return start == size ? "" : absl::StrCat("the last offset is ", start, " but there are ", size, " corners");
}

std::string VtkCells::Fault() const {
  if (builder_.coordinates.empty()) return "the file has no points";
  if (builder_.triangles.empty() && builder_.lines.empty()) return "the file has no polygons, strips or lines";
  if (min_index_ >= 0 && max_index_ < builder_.vertices()) return "";
  return absl::StrCat("a cell names point ", min_index_ < 0 ? min_index_ : max_index_, "; the file has ",
                      builder_.vertices(), ", from 0");
}

}  // namespace phrenic::meshio
