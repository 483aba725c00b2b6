// Closed tubes of varying elliptic section along a smooth curve: ribs, cartilages, the plates of the sternum.
#ifndef PHRENIC_SERVER_ANATOMY_TUBE_H_
#define PHRENIC_SERVER_ANATOMY_TUBE_H_

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

using Curve = std::vector<Eigen::Vector3d>;

// The centripetal Catmull-Rom curve through the points (at least two), sampled at `count` >= 2 even arc lengths.
Curve SmoothCurve(const Curve& through, int count);

double Length(const Curve& curve);

struct TubeSection {
  double half_broad, half_thin;  // semi-axes [mm]
  Eigen::Vector3d thin;          // direction of the thin axis; need be neither unit nor square to the curve
};

// The section at the share s in [0, 1] of the length where the curve passes through `centre`.
using SectionAt = std::function<TubeSection(double s, const Eigen::Vector3d& centre)>;

// Rings of one count, each turned by half a step against the last, with rounded ends; edges near `edge_length`, at
// least six round a ring and three rings. Outward triangles, one component, genus 0. All lengths in one unit.
Mesh Tube(const Curve& through, const SectionAt& section, double edge_length);

// The mirror image in x = 0, again facing outwards.
Mesh Mirrored(Mesh mesh);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_TUBE_H_
