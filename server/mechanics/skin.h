// Skinning: how seen bodies follow the bodies that drive them.
//
// A vertex moves by the weighted mean of its drivers' displacements, u = sum_d w_d u_d. A driver is a pose, which moves
// the vertex as part of the rigid body, or a simulated vertex, which passes on its own displacement; if the weights sum
// to less than 1, the rest does not move. Or a vertex is bound to a triangle of simulated vertices. Skins are made at
// compile time (skinning/add_skins.h) and evaluated by BodyPoints (skinning/body_points.h).
#ifndef PHRENIC_SERVER_MECHANICS_SKIN_H_
#define PHRENIC_SERVER_MECHANICS_SKIN_H_

#include <memory>
#include <vector>

#include "server/mechanics/state.h"
#include "server/mesh/mesh.h"

namespace phrenic {

struct EvalContext;

// The weight of one driver for one vertex.
struct SkinWeight {
  int vertex = 0;             // of the skinned body
  int pose = -1;              // the driver: index into State::poses, or -1 and ...
  int simulated_vertex = -1;  // ... a simulated vertex
  double weight = 0;          // between 0 and 1
};

// The weights of a body as frames read them: vertex after vertex, its poses before its simulated vertices.
struct SkinWeights {
  // The drivers of a vertex: so many from `first` on.
  struct Row {
    int vertex = 0, first = 0, poses = 0, simulated = 0;
  };
  std::vector<Row> rows;        // of the vertices with weights, in ascending order
  std::vector<int> drivers;     // indices into State::poses, or simulated vertices
  std::vector<double> weights;  // one per driver
  bool follow_simulated = false;

  SkinWeights() = default;
  // Keeps the order of a vertex' poses and that of its simulated vertices. Requires: they are sorted by vertex.
  explicit SkinWeights(const std::vector<SkinWeight>& sorted);
};

// The position of a vertex relative to a triangle of simulated vertices: x = sum_i weights_i x_i + height n, n the unit
// normal (thesis 6.1.3); on a sheet the smooth one, with a height that changes (skinning/sheet_points.h).
struct TriangleBinding {
  Eigen::Vector3i corners = Eigen::Vector3i::Zero();
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();  // barycentric: their sum is 1
  double height = 0;                                  // [m]
};

// The middle surface of a sheet that keeps its volume, at rest.
struct DriverSheet {
  int first_vertex = 0;        // the lowest of its simulated vertices
  Triangles triangles;         // 3 x n, simulated vertices
  Eigen::VectorXd rest_areas;  // of all triangles at each vertex, from first_vertex on [m^2]; 0 for other vertices
};

// Corrects where a skin's weights have placed the vertices. Immutable; thread-safe, for threads with scratch memory of
// their own.
class SkinCorrection {
 public:
  virtual ~SkinCorrection() = default;
  // Corrects the positions x [m], 3 x vertices of the body. Uses the context's scratch memory.
  virtual void Place(const EvalContext& at, MutablePoints x) const = 0;
  // Also corrects the velocities v [m/s].
  virtual void Move(const EvalContext& at, MutablePoints x, MutablePoints v) const = 0;
};

// The skin of one seen body: weights or bindings.
struct Skin {
  int body = 0;
  SkinWeights weights;                       // or ...
  std::vector<TriangleBinding> triangles;    // ... one per vertex of the body
  std::shared_ptr<const DriverSheet> sheet;  // if not null, `triangles` are bound to this sheet
  std::vector<std::shared_ptr<const SkinCorrection>> corrections = {};  // of what the weights give, in this order
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKIN_H_
