#include "server/mechanics/skinning/tissue_bodies.h"

#include <algorithm>

namespace phrenic {
namespace {

// True if a vertex of the body is one of the sheet's.
bool IsMiddleOf(const DriverSheet& sheet, const BodyModel& body) {
  const auto end = body.first_vertex + static_cast<int>(body.mesh.vertices.cols());
  const auto& triangles = sheet.triangles.array();
  return body.first_vertex >= 0 && ((triangles >= body.first_vertex) && (triangles < end)).any();
}

}  // namespace

bool FollowsTissue(const Model& model, const BodyModel& body) {
  if (body.first_vertex >= 0) return true;
  if (body.skin < 0) return false;
  const Skin& skin = model.skins[body.skin];
  return !skin.triangles.empty() || skin.weights.follow_simulated;
}

std::vector<int> TissueBodies(const Model& model) {
  std::vector<int> tissue;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const BodyModel& body = model.bodies[b];
    const bool is_layer = body.skin >= 0 && model.skins[body.skin].sheet != nullptr;
    const bool is_middle = std::any_of(model.skins.begin(), model.skins.end(), [&](const Skin& skin) {
      return skin.sheet != nullptr && IsMiddleOf(*skin.sheet, body);
    });
    if (is_layer || (body.first_vertex >= 0 && !is_middle)) tissue.push_back(b);
  }
  return tissue;
}

}  // namespace phrenic
