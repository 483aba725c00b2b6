// VTK UnstructuredGrid of cubic cells and its writer in XML format .vtu, for ParaView.
#ifndef PHRENIC_SERVER_VTK_UNSTRUCTURED_GRID_H_
#define PHRENIC_SERVER_VTK_UNSTRUCTURED_GRID_H_

#include <Eigen/Core>
#include <string>
#include <vector>

namespace phrenic {

struct UnstructuredGrid {
  struct Array {
    std::string name;
    Eigen::MatrixXf values;  // components x points or cells
  };
  Eigen::Matrix3Xd points;                      // in the file's unit
  Eigen::Matrix<int, 8, Eigen::Dynamic> cells;  // corners, x fastest: VTK_VOXEL
  std::vector<Array> point_arrays, cell_arrays;
};

// Returns the bytes of a .vtu file, with the field SPACE=LPS. Requires: each array has a column per point or cell.
std::string WriteVtu(const UnstructuredGrid& grid);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_VTK_UNSTRUCTURED_GRID_H_
