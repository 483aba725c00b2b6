// Surfaces with numbers as VTK's PolyData in XML (VTK File Formats, "XML File Formats"): what ParaView opens.
#ifndef PHRENIC_SERVER_MESH_VTP_H_
#define PHRENIC_SERVER_MESH_VTP_H_

#include <string>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

struct PolyData {
  struct Array {
    std::string name;
    Eigen::MatrixXd values;  // a column a point, or a cell; lines come before triangles
  };
  Points points;  // in the file's unit
  Triangles triangles = Triangles(3, 0);
  Edges lines = Edges(2, 0);
  std::vector<Array> point_arrays = {}, cell_arrays = {};
  std::vector<std::string> names = {};  // of the numbers of the cell array "body"
};

// The bytes of a .vtp: float64, appended raw, each array compressed by zlib; the frame as 3D Slicer writes it, SPACE
// LPS.
std::string WriteVtp(const PolyData& data);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_VTP_H_
