// Lungs of elastic tissue whose walls move by a few boundary modes:
//   x = x0 + s sum_m a_m u_m(x0),  v = s' sum_m a_m u_m(x0)   [m], [m/s],
// with a_m the live parameters lung_* [m], s the breath's signal times breath_force [1], and u_m the response of the
// elastic, sliding tissue to mode m (lungs/boundary_modes.h, lungs/lung_tissue.h). The responses are solved once, when
// the scene is compiled; a step costs a product of 3 n x 12. A change of a parameter moves the lungs at once: v leaves
// its rate out.
#ifndef PHRENIC_SERVER_MECHANICS_MOTIONS_LUNG_MODES_H_
#define PHRENIC_SERVER_MECHANICS_MOTIONS_LUNG_MODES_H_

#include <vector>

#include "server/mechanics/lungs/mode_parameters.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class LungModes final : public Motion {
 public:
  // Drives every vertex of the bodies: sets their inverse mass to 0. INVALID_ARGUMENT if a body is not deformable, a
  // lung has no anatomy of a lung with a side or no closed surface that faces outwards, or two bodies are of one side.
  static absl::StatusOr<std::unique_ptr<Motion>> Make(const v1::LungModes& scene, const std::string& name,
                                                      std::string_view path, ModelBuilder& builder);

  void Drive(const EvalContext& at, State& state) const override;
  // Warns of a lung with less than a quarter or more than four times its volume at rest: from the residual volume to
  // the total capacity, lungs of people have 0.5 to 2.5 times that at the end of a quiet expiration. What is turned
  // inside out has a negative volume.
  std::string Warning(const State& state) const override;

  // The inside of a lung: what tissue probes and fields read.
  struct Inside {
    int body;  // in Model::bodies
    BrickGrid grid;
    Eigen::AlignedBox3d box;  // of the surface [m]
    Eigen::MatrixXd shapes;   // displacement of the nodes per amplitude, row 3 node + axis (3 nodes x parameters) [1]
  };
  const std::vector<Inside>& insides() const { return insides_; }
  // Returns s a_m [m], by which the shapes are multiplied at this moment.
  static Eigen::Vector<double, kModeParameters> AmplitudesAt(const EvalContext& at);
  // Returns the motion of this kind that the model has; null without. It lives as long as the model.
  static const LungModes* Find(const Model& model);

 private:
  using Responses = Eigen::Matrix<double, Eigen::Dynamic, kModeParameters>;  // row 3 i + axis of vertex i [1]

  // The vertices of a body.
  struct Moved {
    int first;  // simulated vertex
    Points rest;
    Responses responses;
    Triangles faces;         // of a lung; empty for what is inside
    double rest_volume = 0;  // [m^3]
    std::string body;
  };
  struct Lung;

  explicit LungModes(std::string name) : Motion(std::move(name)) {}
  // Returns the lung that is this body, or the one that holds the point or is nearest to it.
  static const Lung& LungAt(const Eigen::Vector3d& point, int body, const std::vector<Lung>& lungs);
  // Adds the body, each vertex with the tissue of its lung.
  void Add(int body, const std::vector<Lung>& lungs, ModelBuilder& builder);
  static absl::StatusOr<std::vector<Lung>> Solve(const Names& names, std::string_view path,
                                                 const ModelBuilder& builder);

  std::vector<Moved> moved_;
  std::vector<Inside> insides_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTIONS_LUNG_MODES_H_
