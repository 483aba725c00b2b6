// Collects the points and cells of VTK PolyData, legacy or XML, into a surface.
#ifndef PHRENIC_SERVER_MESHIO_VTK_CELLS_H_
#define PHRENIC_SERVER_MESHIO_VTK_CELLS_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/meshio/formats.h"

namespace phrenic::meshio {

enum class VtkCell { kVertex, kLine, kPolygon, kStrip };

// Not thread-safe. One parser owns it. Indices are checked at the end, by Fault.
class VtkCells {
 public:
  // Coordinates come as x, y, z of each point in turn, in the file's unit.
  void AddCoordinate(double coordinate) { builder_.coordinates.push_back(coordinate); }
  int points() const { return builder_.vertices(); }
  // Adds a cell. `first` is added to each corner's point index. Vertex cells are ignored; the triangles of a strip get
  // the winding of its first one. A line of several points becomes edges from each to the next.
  void Add(VtkCell kind, const std::vector<std::int64_t>& corners, std::int64_t first = 0);
  // Adds concatenated cells; `offsets` holds the end of each in `corners`, after a leading 0 if `from_zero`. Returns an
  // error message, or an empty string.
  std::string AddAll(VtkCell kind, const std::vector<std::int64_t>& offsets, const std::vector<std::int64_t>& corners,
                     bool from_zero, std::int64_t first = 0);
  // Returns an error message if there is nothing to show or an index is out of range, or an empty string.
  std::string Fault() const;
  // Requires: Fault is empty.
  Mesh ToMesh() const { return builder_.ToMesh(); }

 private:
  SurfaceBuilder builder_;
  std::vector<int> corners_;                     // of the present cell
  std::int64_t min_index_ = 0, max_index_ = -1;  // of all corners, before clamping
};

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_VTK_CELLS_H_
