// VTK ImageData (values on a regular grid) and its writer in XML format .vti, for ParaView and 3D Slicer.
#ifndef PHRENIC_SERVER_VTK_IMAGE_DATA_H_
#define PHRENIC_SERVER_VTK_IMAGE_DATA_H_

#include <Eigen/Core>
#include <string>
#include <vector>

namespace phrenic {

struct ImageData {
  struct Array {
    std::string name;
    Eigen::MatrixXf values;  // components x points, x fastest
  };
  Eigen::Vector3i size = Eigen::Vector3i::Zero();     // points along x, y and z
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();   // of the first point, in the file's unit
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();  // in the file's unit
  std::vector<Array> arrays = {};
};

// Returns the bytes of a .vti file: float32, with the field SPACE=LPS. Requires: each array has a column per point.
std::string WriteVti(const ImageData& data);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_VTK_IMAGE_DATA_H_
