// VTK PolyData (surfaces and lines with data arrays) and its writer in XML format .vtp (VTK File Formats, "XML File
// Formats"), for ParaView and 3D Slicer. meshio/vtp.cc reads the format.
#ifndef PHRENIC_SERVER_VTK_POLYDATA_H_
#define PHRENIC_SERVER_VTK_POLYDATA_H_

#include <string>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

struct PolyData {
  struct Array {
    std::string name;
    Eigen::MatrixXd values;  // components x n, one column per point or cell; lines come before triangles
  };
  Points points;  // 3 x n, in the file's unit
  Triangles triangles = Triangles(3, 0);
  Edges lines = Edges(2, 0);
  std::vector<Array> point_arrays = {}, cell_arrays = {};
  std::vector<std::string> names = {};  // body i's name, where the cell array "body" holds i
};

// Returns the bytes of a .vtp file: float64, raw appended data, each array compressed by zlib, little-endian, with the
// field SPACE=LPS that 3D Slicer reads.
std::string WriteVtp(const PolyData& data);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_VTK_POLYDATA_H_
