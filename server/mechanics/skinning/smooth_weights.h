// Skin weights without jumps, for organs that lie beside a sheet or deep below it (SKIN_MODE_SMOOTH).
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_SMOOTH_WEIGHTS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_SMOOTH_WEIGHTS_H_

#include <vector>

#include "server/mechanics/skinning/skin_drivers.h"

namespace phrenic {

// Of the deformable drivers a point at rest follows all vertices with s < S, each with the weight
//   w ~ (1 / s - 1 / S)^2, S = 6 s_min,
//   s = (dx^2 + dy^2 + (0.35 dz)^2 + n^2) / (0.008 + 0.992 nz^2), n = 8 mm, nz the vertical part of the unit normal:
// mostly those straight above and below where the surface is level, least those on a steep wall, along which an organ
// slides. The larger S, the fewer vertices are used: those of a subset whose members are about sqrt(S) / 4 apart, of at
// most 6,000 vertices. All deformable drivers together and each other driver, by its nearest vertex, share the motion
// by s_min^(-2), here with dz^2 for (0.35 dz)^2 and nz = 1 at the other drivers; shares below 1 % of the largest are
// dropped. Weights are continuous functions of the point.
//
// The builder must outlive it and not change; then it is thread-safe.
class SmoothWeights {
 public:
  SmoothWeights(const ModelBuilder& builder, const std::vector<int>& drivers);
  // Appends the weights of a point at rest [m] as those of `for_vertex`. Their sum is 1, or less if a driver does not
  // move.
  void Append(const Eigen::Vector3d& point, int for_vertex, std::vector<SkinWeight>& weights) const;

 private:
  // A vertex of a deformable driver. Ordered so that each is as far as possible from those before it.
  struct Carrier {
    Eigen::Vector3d at;  // at rest, z scaled [m]
    double level;        // 0.008 + 0.992 nz^2
    double apart;        // its distance from those before it [m]
    int simulated_vertex;
  };
  // The part of the motion that one driver, or all deformable ones together, have.
  struct Share {
    int driver;  // index in others_; -1 for the deformable ones
    int vertex;
    double weight;
  };
  // The carriers as columns of numbers, so that a loop over all computes several at a time.
  struct Columns {
    Eigen::ArrayXd x, y, z;  // at rest [m]
    Eigen::ArrayXd scaled;   // z scaled [m]
    Eigen::ArrayXd level;
  };
  static std::vector<Carrier> FarthestFirst(const ModelBuilder& builder, const std::vector<int>& bodies);
  static double Softened(const Carrier& carrier, const Eigen::Vector3d& scaled);
  double Smallest(const Eigen::Vector3d& point, const Eigen::ArrayXd& z, double at_z) const;
  std::vector<Share> Shares(const Eigen::Vector3d& point) const;
  void AppendCarriers(const Eigen::Vector3d& scaled, double smallest, double share, int for_vertex,
                      std::vector<SkinWeight>& weights) const;

  std::vector<Carrier> carriers_;
  Columns columns_;     // of carriers_
  SkinDrivers others_;  // the drivers that are not deformable
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_SMOOTH_WEIGHTS_H_
