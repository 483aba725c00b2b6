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
    least_ = std::min(least_, index);
    greatest_ = std::max(greatest_, index);
    corners_.push_back(static_cast<int>(std::clamp<std::int64_t>(index, 0, INT32_MAX)));
  }
  if (kind == VtkCell::kPolygon) found_.AddPolygon(corners_);
  for (std::size_t i = 1; kind == VtkCell::kLine && i < corners_.size(); ++i) {
    found_.lines.insert(found_.lines.end(), {corners_[i - 1], corners_[i]});
  }
  for (std::size_t i = 2; kind == VtkCell::kStrip && i < corners_.size(); ++i) {
    int a = corners_[i - 2], b = corners_[i - 1];
    if (i % 2 == 1) std::swap(a, b);
    found_.triangles.insert(found_.triangles.end(), {a, b, corners_[i]});
  }
}

std::string VtkCells::AddAll(VtkCell kind, const std::vector<std::int64_t>& offsets,
                             const std::vector<std::int64_t>& corners, bool from_zero, std::int64_t first) {
  const auto size = static_cast<std::int64_t>(corners.size());
  std::int64_t start = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const std::int64_t end = offsets[i];
    if (end < start || end > size || (from_zero && i == 0 && end != 0)) {
      return absl::StrCat("offset ", i, " is ", end, ", not between ", start, " and the ", size, " corners there are");
    }
    if (from_zero && i == 0) continue;
    Add(kind, {corners.begin() + start, corners.begin() + end}, first);
    start = end;
  }
  return start == size ? "" : absl::StrCat("the offsets end at ", start, " of ", size, " corners");
}

std::string VtkCells::Fault() const {
  if (found_.coordinates.empty()) return "the file has no points";
  if (found_.triangles.empty() && found_.lines.empty()) return "the file has no polygons, strips or lines";
  if (least_ >= 0 && greatest_ < found_.vertices()) return "";
  return absl::StrCat("a cell names point ", least_ < 0 ? least_ : greatest_, "; the file has ", found_.vertices(),
                      ", from 0");
}

Frame FrameNamed(std::string_view text, Frame otherwise) {
  if (text == "RAS") return Frame::kRas;
  if (text == "LPS") return Frame::kLps;
  return FrameIn(text, otherwise);
}

}  // namespace phrenic::meshio
