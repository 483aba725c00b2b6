#include "tests/bench/subjects.h"

#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/step/step.h"
#include "server/mesh/locality.h"
#include "server/mesh/topology.h"
#include "server/schema/schema.h"
#include "server/session/meshes.h"
#include "server/session/scene_catalogue.h"

namespace phrenic::bench {
namespace {

constexpr int kColumns = 5;  // of the nets of rigid links

// The generated diaphragm under a force.
std::string Diaphragm(const std::string& force) {
  return absl::StrCat(
      "name: 'bench' bodies { name: 'diaphragm' role: ROLE_DEFORMABLE mass: 3 fixed_regions: 'rim' anatomy { "
      "structure: "
      "STRUCTURE_DIAPHRAGM } generated {} } forces { ",
      force, " }");
}

std::string Springs(const std::string& precision) {
  return Diaphragm("springs { bodies: 'diaphragm' stiffness: 40 rest_length_ratio: 0.9 balanced_at_rest: true " +
                   precision + " }");
}

// A dome of muscle, of the size of a diaphragm's middle surface at 5 mm.
std::string Muscle() {
  return "name: 'bench' bodies { name: 'dome' role: ROLE_DEFORMABLE mass: 6 fixed_regions: 'rim' ellipsoid { radii { "
         "x: "
         "0.12 y: 0.09 z: 0.09 } divisions: 44 upper_half: true } regions { name: 'tendon' low { x: -1 y: -1 z: 0.07 } "
         "high { x: 1 y: 1 z: 1 } } } forces { muscle { body: 'dome' from_region: 'rim' tendon_region: 'tendon' } }";
}

// A net of rigid links along columns and rows, several at each vertex, that hangs from its first row.
std::string Net(int rows) {
  std::string links;
  const auto link = [&links](int a, int b) { absl::StrAppend(&links, " links { a: ", a, " b: ", b, " }"); };
  for (int i = 0; i < kColumns * rows; ++i) {
    if (i % kColumns + 1 < kColumns && i >= kColumns) link(i, i + 1);
    if (i / kColumns + 1 < rows) link(i, i + kColumns);
  }
  return absl::StrCat(
      "name: 'net' bodies { name: 'net' role: ROLE_DEFORMABLE mass: 1 fixed_vertices: [0, 1, 2, 3, 4] grid { columns: ",
      kColumns, " rows: ", rows,
      " u { x: 0.01 } v { y: 0.01 } } } forces { gravity { bodies: 'net' acceleration { z: -9.81 } } } constraints { "
      "rigid_links { body: 'net' projection: PROJECTION_EXACT list {",
      links, " } } } parameters { time_step: 0.001 }");
}

MeshSource OnceEach() {
  return [source = session::MakeMeshSource(""),
          made = std::make_shared<std::map<std::string, Mesh>>()](const v1::Body& body) -> absl::StatusOr<Mesh> {
    const auto found = made->find(body.SerializeAsString());
    if (found != made->end()) return found->second;
    auto mesh = source(body);
    if (mesh.ok()) made->emplace(body.SerializeAsString(), *mesh);
    return mesh;
  };
}

}  // namespace

Run::Run(ModelPointer of)
    : model(std::move(of)), parameters(model->parameters), state(model->InitialState()), work(model->MakeWorkspace()) {}

void Run::Step() { status.Update(phrenic::Step(*model, parameters, parameters.time_step(), state, work)); }

Solver::Solver(ModelPointer model) : model_(std::move(model)), state_(model_->InitialState()), system_(*model_) {
  state_.x *= 1.02;
  b_ = Points::Random(3, state_.x.cols()) * model_->mass.asDiagonal();
  y_.resizeLike(b_);
}

void Solver::Solve() {
  const EvalContext at = MakeEvalContext(*model_, model_->parameters, state_);
  system_.Assemble(*model_, at, kFrame);
  y_.setZero();
  effort_.Begin(0, kIterations);
  system_.Solve(*model_, at, b_, 0, effort_, y_).IgnoreError();  // it is not to get there
}

absl::StatusOr<Subjects> MakeSubjects() {
  Subjects subjects;
  subjects.meshes = OnceEach();
  const session::SceneCatalogue scenes({PHRENIC_SCENES_DIR});
  const std::pair<ModelPointer*, absl::StatusOr<v1::Scene>> wanted[] = {
      {&subjects.thorax, scenes.Find("thorax")},
      {&subjects.thesis, scenes.Find("thorax-thesis")},
      {&subjects.springs, schema::ParseScene("springs", Springs(""))},
      {&subjects.single_springs, schema::ParseScene("springs", Springs("precision: PRECISION_SINGLE"))},
      {&subjects.membrane,
       schema::ParseScene("membrane", Diaphragm("membrane { bodies: 'diaphragm' youngs_modulus: 5000 }"))},
      {&subjects.muscle, schema::ParseScene("muscle", Muscle())},
      {&subjects.few_links, schema::ParseScene("net", Net(73))},
      {&subjects.many_links, schema::ParseScene("net", Net(721))},
  };
  for (const auto& [model, scene] : wanted) {
    if (!scene.ok()) return scene.status();
    auto compiled = Compile(*scene, subjects.meshes);
    if (!compiled.ok()) return compiled.status();
    *model = *std::move(compiled);
  }
  return subjects;
}

std::vector<Spring> SpringsOf(const Model& model) {
  std::vector<Spring> springs;
  const Edges edges = SpringEdges(model.bodies.front().mesh);
  for (const auto& edge : edges.colwise()) {
    const double length = (model.rest.col(edge[1]) - model.rest.col(edge[0])).norm();
    springs.push_back({edge[0], edge[1], 40, 0.9 * length});
  }
  return springs;
}

Renumbered::Renumbered(const std::vector<Spring>& of, const Points& from) : springs(of), x(from) {
  const std::vector<int> order = HilbertOrder(from);
  std::vector<int> place(order.size());
  for (size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<int>(i);
    x.col(static_cast<Eigen::Index>(i)) = from.col(order[i]);
  }
  for (Spring& spring : springs) spring.a = place[spring.a], spring.b = place[spring.b];
}

}  // namespace phrenic::bench
