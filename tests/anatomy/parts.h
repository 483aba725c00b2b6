// Shorthands for the structures of the generated thorax and for measuring meshes.
#ifndef PHRENIC_TESTS_ANATOMY_PARTS_H_
#define PHRENIC_TESTS_ANATOMY_PARTS_H_

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "server/anatomy/anatomy.h"
#include "server/anatomy/double_layer.h"

namespace phrenic::anatomy {

inline v1::Anatomy Part(v1::Structure structure, int number = 0, v1::Side side = v1::SIDE_UNSPECIFIED) {
  v1::Anatomy part;
  part.set_structure(structure);
  part.set_number(number);
  part.set_side(side);
  return part;
}

// Returns the mesh of a part, which a process generates once; empty if it cannot be generated. Not thread-safe.
inline const Mesh& MeshOf(const v1::Anatomy& part, double resolution_mm = 0, v1::Sheet sheet = v1::SHEET_UNSPECIFIED) {
  static std::map<std::tuple<std::string, double, v1::Sheet>, Mesh> meshes;
  const auto [found, is_new] = meshes.try_emplace({part.SerializeAsString(), resolution_mm, sheet});
  if (is_new) {
    auto mesh = Generate(part, resolution_mm, sheet);
    if (mesh.ok()) found->second = *std::move(mesh);
  }
  return found->second;
}

inline const Mesh& Diaphragm(double resolution_mm = 0) { return MeshOf(Part(v1::STRUCTURE_DIAPHRAGM), resolution_mm); }

// The vertices of each layer of a double layer.
inline Points UpperLayer(const Mesh& mesh) {
  return mesh.vertices(Eigen::all, Eigen::seq(UpperVertex(0), Eigen::last, UpperVertex(1)));
}
inline Points LowerLayer(const Mesh& mesh) {
  return mesh.vertices(Eigen::all, Eigen::seq(LowerVertex(0), Eigen::last, UpperVertex(1)));
}

inline std::vector<v1::Anatomy> Bones() {
  std::vector<v1::Anatomy> parts = {Part(v1::STRUCTURE_MANUBRIUM), Part(v1::STRUCTURE_STERNUM_BODY),
                                    Part(v1::STRUCTURE_XIPHOID)};
  for (const v1::Side side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    for (int i = 1; i <= 12; ++i) parts.push_back(Part(v1::STRUCTURE_RIB, i, side));
    for (int i = 1; i <= 10; ++i) parts.push_back(Part(v1::STRUCTURE_COSTAL_CARTILAGE, i, side));
  }
  for (int i = 1; i <= 15; ++i) parts.push_back(Part(v1::STRUCTURE_VERTEBRA, i));
  for (int i = 1; i <= 14; ++i) parts.push_back(Part(v1::STRUCTURE_DISC, i));
  return parts;
}

// What lies between the lungs, and what lies below the diaphragm.
inline std::vector<v1::Anatomy> Mediastinum() {
  return {Part(v1::STRUCTURE_HEART),        Part(v1::STRUCTURE_AORTA),      Part(v1::STRUCTURE_VENA_CAVA, 1),
          Part(v1::STRUCTURE_VENA_CAVA, 2), Part(v1::STRUCTURE_OESOPHAGUS), Part(v1::STRUCTURE_TRACHEA)};
}
inline std::vector<v1::Anatomy> AbdominalOrgans() {
  return {Part(v1::STRUCTURE_LIVER), Part(v1::STRUCTURE_STOMACH), Part(v1::STRUCTURE_SPLEEN)};
}

inline std::vector<v1::Anatomy> Kidneys() {
  return {Part(v1::STRUCTURE_KIDNEY, 0, v1::SIDE_RIGHT), Part(v1::STRUCTURE_KIDNEY, 0, v1::SIDE_LEFT)};
}
inline std::vector<v1::Anatomy> ShoulderGirdle() {
  return {Part(v1::STRUCTURE_CLAVICLE, 0, v1::SIDE_RIGHT), Part(v1::STRUCTURE_CLAVICLE, 0, v1::SIDE_LEFT),
          Part(v1::STRUCTURE_SCAPULA, 0, v1::SIDE_RIGHT), Part(v1::STRUCTURE_SCAPULA, 0, v1::SIDE_LEFT)};
}
inline std::vector<v1::Anatomy> LobesOf(v1::Side side) {
  std::vector<v1::Anatomy> lobes = {Part(v1::STRUCTURE_LUNG_LOBE, 1, side), Part(v1::STRUCTURE_LUNG_LOBE, 3, side)};
  if (side == v1::SIDE_RIGHT) lobes.push_back(Part(v1::STRUCTURE_LUNG_LOBE, 2, side));
  return lobes;
}
inline std::vector<v1::Anatomy> Fissures() {
  return {Part(v1::STRUCTURE_FISSURE, 1, v1::SIDE_RIGHT), Part(v1::STRUCTURE_FISSURE, 1, v1::SIDE_LEFT),
          Part(v1::STRUCTURE_FISSURE, 2, v1::SIDE_RIGHT)};
}

inline std::vector<v1::Anatomy> AllParts() {
  std::vector<v1::Anatomy> parts = Bones();
  parts.push_back(Part(v1::STRUCTURE_DIAPHRAGM));
  parts.push_back(Part(v1::STRUCTURE_LUNG, 0, v1::SIDE_RIGHT));
  parts.push_back(Part(v1::STRUCTURE_LUNG, 0, v1::SIDE_LEFT));
  for (const v1::Anatomy& organ : Mediastinum()) parts.push_back(organ);
  for (const v1::Anatomy& organ : AbdominalOrgans()) parts.push_back(organ);
  for (const v1::Anatomy& kidney : Kidneys()) parts.push_back(kidney);
  for (const v1::Anatomy& bone : ShoulderGirdle()) parts.push_back(bone);
  for (const v1::Side side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    for (const v1::Anatomy& lobe : LobesOf(side)) parts.push_back(lobe);
  }
  for (const v1::Anatomy& fissure : Fissures()) parts.push_back(fissure);
  return parts;
}

inline Eigen::Vector3d Corner(const Mesh& mesh, Eigen::Index t, int k) {
  return mesh.vertices.col(mesh.triangles(k % 3, t));
}

// Returns the smallest angle of all triangles [degrees].
inline double SmallestAngle(const Mesh& mesh) {
  double smallest = 180;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d u = Corner(mesh, t, k + 1) - Corner(mesh, t, k);
      const Eigen::Vector3d v = Corner(mesh, t, k + 2) - Corner(mesh, t, k);
      smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / M_PI);
    }
  }
  return smallest;
}

inline double Area(const Mesh& mesh, Eigen::Index t) {
  return (Corner(mesh, t, 1) - Corner(mesh, t, 0)).cross(Corner(mesh, t, 2) - Corner(mesh, t, 0)).norm() / 2;
}

inline Eigen::Vector3d Low(const Mesh& mesh) { return mesh.vertices.rowwise().minCoeff(); }
inline Eigen::Vector3d High(const Mesh& mesh) { return mesh.vertices.rowwise().maxCoeff(); }

}  // namespace phrenic::anatomy

#endif  // PHRENIC_TESTS_ANATOMY_PARTS_H_
