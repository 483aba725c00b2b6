#include "server/mechanics/step/loose_parts.h"

#include <numeric>

namespace phrenic {
namespace {

// Unites what forces and links join.
class Joints final : public StiffnessSink {
 public:
  explicit Joints(int vertices) : parent_(vertices) { std::iota(parent_.begin(), parent_.end(), 0); }
  void Add(int i, int j, const Eigen::Matrix3d&) override { Unite(i, j); }
  void AddSpringsAt(std::span<const Spring> springs, const EvalContext&) override {
    for (const Spring& spring : springs) Unite(spring.a, spring.b);
  }
  void AddSprings(std::span<const SpringStiffness> springs) override {
    for (const SpringStiffness& spring : springs) Unite(spring.a, spring.b);
  }
  void AddOuter(double, const Points& g) override {
    int first = -1;
    for (int i = 0; i < g.cols(); ++i) {
      if (g.col(i).isZero(0)) continue;
      if (first >= 0) Unite(first, i);
      first = i;
    }
  }
  void Unite(int i, int j) { parent_[Root(i)] = Root(j); }
  int Root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

 private:
  std::vector<int> parent_;
};

void UniteAll(const Model& model, Joints& joints) {
  const State rest = model.InitialState();
  const EvalContext at = MakeEvalContext(model, model.parameters, rest);
  OuterProducts shared;
  for (const auto& force : model.forces) {
    force->AddStiffness(at, joints);
    force->AddLatentStiffness(at, joints);
    force->AddSharedDamping(at, shared);
  }
  shared.ForEach([&joints](double, const Points& g) { joints.AddOuter(1, g); });
  std::vector<Link> links;
  for (const auto& constraint : model.constraints) constraint->ListLinks(links);
  for (const Link& link : links) joints.Unite(link.a, link.b);
  for (Eigen::Index k = 0; k < model.rigid_links.cols(); ++k) {
    joints.Unite(model.rigid_links(0, k), model.rigid_links(1, k));  // also those that ListLinks leaves out
  }
}

}  // namespace

LooseParts::LooseParts(const Model& model) : of(model.rest.cols(), -1) {
  const int vertices = static_cast<int>(of.size());
  Joints joints(vertices);
  UniteAll(model, joints);
  std::vector<bool> held(vertices, false);
  for (int i = 0; i < vertices; ++i) {
    if (model.inverse_mass[i] == 0) held[joints.Root(i)] = true;
  }
  std::vector<int> part_of_root(vertices, -1);
  for (int i = 0; i < vertices; ++i) {
    const int root = joints.Root(i);
    if (held[root]) continue;
    if (part_of_root[root] < 0) part_of_root[root] = count++;
    of[i] = part_of_root[root];
  }
}

}  // namespace phrenic
