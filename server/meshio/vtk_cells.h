// What the cells of VTK's PolyData, of whichever kind of file, say of a surface.
#ifndef PHRENIC_SERVER_MESHIO_VTK_CELLS_H_
#define PHRENIC_SERVER_MESHIO_VTK_CELLS_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/meshio/formats.h"

namespace phrenic::meshio {

enum class VtkCell { kVertex, kLine, kPolygon, kStrip };

class VtkCells {
 public:
  void AddCoordinate(double coordinate) { found_.coordinates.push_back(coordinate); }
  int points() const { return found_.vertices(); }
  // Corners are numbers of points, `first` more than written. Cells of single points are passed over; a strip's
  // triangles face as its first one does.
  void Add(VtkCell kind, const std::vector<std::int64_t>& corners, std::int64_t first = 0);
  // Cells one after the other: where each ends, after a zero at the beginning where `from_zero` holds. What is wrong,
  // in words, or empty.
  std::string AddAll(VtkCell kind, const std::vector<std::int64_t>& offsets, const std::vector<std::int64_t>& corners,
                     bool from_zero, std::int64_t first = 0);
  // What is wrong with the whole, in words; empty where it is a surface or a network.
  std::string Fault() const;
  Mesh ToMesh() const { return found_.ToMesh(); }

 private:
  Collected found_;
  std::vector<int> corners_;
  std::int64_t least_ = 0, greatest_ = -1;  // corner
};

// The frame that the field "SPACE" names: "RAS", "LPS", or "SPACE=RAS".
Frame FrameNamed(std::string_view text, Frame otherwise);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_VTK_CELLS_H_
