#include "server/physiology/parts.h"

#include <string_view>

#include "server/mechanics/skinning/body_points.h"
#include "server/mechanics/skinning/tissue_bodies.h"

namespace phrenic::physiology {
namespace {

void AddBody(const BodyModel& body, int index, Parts& parts) {
  switch (body.anatomy.structure()) {
    case v1::STRUCTURE_DIAPHRAGM:
      if (body.first_vertex >= 0) parts.muscle = index;
      return;
    case v1::STRUCTURE_STERNUM_BODY:
      parts.sternum = index;
      return;
    case v1::STRUCTURE_INNER_CAGE:
      parts.wall = index;
      return;
    case v1::STRUCTURE_RIB:
      parts.ribs.push_back(index);
      return;
    case v1::STRUCTURE_LUNG:
      parts.lungs.push_back(index);
      return;
    default:
      return;
  }
}

}  // namespace

absl::StatusOr<Parts> FindParts(const Model& model) {
  Parts parts;
  for (const int body : TissueBodies(model)) {
    if (parts.sheet < 0 && model.bodies[body].anatomy.structure() == v1::STRUCTURE_DIAPHRAGM) parts.sheet = body;
  }
  if (parts.sheet < 0) {
    return absl::FailedPreconditionError(
        "the scene has no deformable body with the anatomy STRUCTURE_DIAPHRAGM, so there is nothing to compare with a "
        "person's breath");
  }
  for (size_t b = 0; b < model.bodies.size(); ++b) AddBody(model.bodies[b], static_cast<int>(b), parts);
  for (const auto& force : model.forces) {
    for (const Force::Output& output : force->outputs()) {
      if (std::string_view(output.name) == "pleural_pressure_right") parts.pressures = force.get();
    }
  }
  return parts;
}

Points Placed(const Model& model, const State& state, int body) {
  Points placed(3, model.bodies[static_cast<size_t>(body)].mesh.vertices.cols());
  PlaceBody(model, state, body, placed);
  return placed;
}

double ReadOutput(const Force* force, std::string_view output, const EvalContext& at) {
  if (force == nullptr) return kNone;
  const auto outputs = force->outputs();
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (output == outputs[i].name) return force->Read(i, at);
  }
  return kNone;
}

}  // namespace phrenic::physiology
