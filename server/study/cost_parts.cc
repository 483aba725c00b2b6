#include "server/study/cost_parts.h"

#include <algorithm>

namespace phrenic::study {
namespace {

constexpr const char* kEmptyRegion = "nowhere";  // a region of one vertex: it has no edge, triangle or tetrahedron
constexpr const char* kAttachments = "attachments";
constexpr const char* kLinks = "links";
constexpr const char* kMuscles = "muscles";
constexpr const char* kRibs = "ribs";
constexpr const char* kSprings = "springs";
constexpr const char* kNone = "";  // elements that cost nothing in a step

std::string PartOf(const v1::Force& force) {
  switch (force.kind_case()) {
    case v1::Force::kSprings:
      return kSprings;
    case v1::Force::kFriction:
      return "friction";
    case v1::Force::kActionLine:
    case v1::Force::kFibres:
    case v1::Force::kMuscle:
      return kMuscles;
    case v1::Force::kAttachment:
      return kAttachments;
    case v1::Force::kGravity:
      return "gravity";
    case v1::Force::kContact:
      return "contact";
    case v1::Force::kCables:
      return "cables";
    case v1::Force::kMembrane:
      return "membrane";
    case v1::Force::kSolid:
      return "solid";
    case v1::Force::kBending:
      return "bending";
    case v1::Force::kCrossLayer:
      return "cross-layer springs";
    case v1::Force::kPressure:
      return "pressure";
    case v1::Force::kLungs:
      return "lungs";
    case v1::Force::kTargetSpring:
      return "target springs";
    case v1::Force::kWallContact:
      return "wall contact";
    case v1::Force::kChestWall:
      return "chest wall";
    case v1::Force::kThoraxPressures:
      return "thorax pressures";
    case v1::Force::kPointLoad:
      return "point loads";
    case v1::Force::KIND_NOT_SET:
      break;
  }
  return kNone;
}

std::string PartOf(const v1::Motion& motion) {
  switch (motion.kind_case()) {
    case v1::Motion::kRibs:
    case v1::Motion::kSternum:
      return kRibs;
    case v1::Motion::kOscillation:
      return "oscillation";
    case v1::Motion::kLungModes:
      return "lung modes";
    case v1::Motion::kSkin:
    case v1::Motion::kInsertion:  // forces need it
    case v1::Motion::KIND_NOT_SET:
      break;
  }
  return kNone;
}

std::string PartOf(const v1::Constraint& constraint) {
  switch (constraint.kind_case()) {
    case v1::Constraint::kRigidLinks:
      return kLinks;
    case v1::Constraint::kLengthLimits:
      return "length limits";
    case v1::Constraint::KIND_NOT_SET:
      break;
  }
  return kNone;
}

template <typename Elements>
void AddParts(const Elements& elements, std::vector<std::string>& parts) {
  for (const auto& element : elements) {
    const std::string part = PartOf(element);
    if (part == kNone || std::find(parts.begin(), parts.end(), part) != parts.end()) continue;
    parts.push_back(part);
  }
}

template <typename Elements>
void Drop(const std::string& part, Elements& elements) {
  elements.erase(std::remove_if(elements.begin(), elements.end(),
                                [&part](const auto& element) { return PartOf(element) == part; }),
                 elements.end());
}

// Gives each deformable body a region that contains only its first vertex.
void AddEmptyRegion(const Model& model, v1::Scene& scene) {
  for (int b = 0; b < scene.bodies_size(); ++b) {
    if (scene.bodies(b).role() != v1::ROLE_DEFORMABLE) continue;
    const Eigen::Vector3d at = model.bodies[static_cast<size_t>(b)].mesh.vertices.col(0);
    v1::Region& region = *scene.mutable_bodies(b)->add_regions();
    region.set_name(kEmptyRegion);
    region.mutable_low()->set_x(at.x());
    region.mutable_low()->set_y(at.y());
    region.mutable_low()->set_z(at.z());
    *region.mutable_high() = region.low();
  }
}

// Mass cannot be distributed by the stiffness of springs that are removed.
void SpreadMassByArea(v1::Scene& scene) {
  for (v1::Body& body : *scene.mutable_bodies()) body.clear_mass_lumping();
}

// Restricts an element to the empty region.
template <typename Element>
bool Confine(Element& element) {
  element.set_region(kEmptyRegion);
  return true;
}

// Makes a force empty; returns false if the compile step could not detect that.
bool MakeEmpty(v1::Force& force) {
  switch (force.kind_case()) {
    case v1::Force::kSprings:
      return Confine(*force.mutable_springs());
    case v1::Force::kFibres:
      return Confine(*force.mutable_fibres());
    case v1::Force::kMembrane:
      return Confine(*force.mutable_membrane());
    case v1::Force::kSolid:
      return Confine(*force.mutable_solid());
    case v1::Force::kBending:
      return Confine(*force.mutable_bending());
    case v1::Force::kCables:
      force.mutable_cables()->clear_list();
      return Confine(*force.mutable_cables());
    case v1::Force::kFriction:
      force.mutable_friction()->set_rate(0);
      return true;
    case v1::Force::kActionLine:
      force.mutable_action_line()->set_force(0);
      force.mutable_action_line()->clear_air_load();
      return true;
    case v1::Force::kAttachment:
      force.mutable_attachment()->set_radius(1e-6);
      return Confine(*force.mutable_attachment());
    case v1::Force::kGravity:
      force.mutable_gravity()->mutable_acceleration()->Clear();
      return true;
    case v1::Force::kCrossLayer:
      force.mutable_cross_layer()->set_distance(1e-9);
      return true;
    case v1::Force::kMuscle:
    case v1::Force::kWallContact:
    case v1::Force::kChestWall:
    case v1::Force::kThoraxPressures:
    case v1::Force::kContact:
    case v1::Force::kPressure:
    case v1::Force::kLungs:
    case v1::Force::kTargetSpring:
    case v1::Force::kPointLoad:
    case v1::Force::KIND_NOT_SET:
      break;
  }
  return false;
}

// The same for a constraint.
bool MakeEmpty(v1::Constraint& constraint) {
  switch (constraint.kind_case()) {
    case v1::Constraint::kRigidLinks:
      constraint.mutable_rigid_links()->mutable_pairing()->set_distance(1e-9);
      return Confine(*constraint.mutable_rigid_links()->mutable_pairing());
    case v1::Constraint::kLengthLimits:
      constraint.mutable_length_limits()->clear_list();
      return Confine(*constraint.mutable_length_limits());
    case v1::Constraint::KIND_NOT_SET:
      break;
  }
  return false;
}

}  // namespace

std::vector<std::string> PartsOf(const v1::Scene& scene) {
  std::vector<std::string> parts;
  AddParts(scene.motions(), parts);
  AddParts(scene.forces(), parts);
  AddParts(scene.constraints(), parts);
  return parts;
}

v1::Scene Without(v1::Scene scene, const std::string& part) {
  scene.clear_measures();  // they may refer to removed elements, and no step evaluates them
  Drop(part, *scene.mutable_forces());
  Drop(part, *scene.mutable_motions());
  Drop(part, *scene.mutable_constraints());
  if (part == kSprings) SpreadMassByArea(scene);
  if (part != kRibs) return scene;
  for (v1::Body& body : *scene.mutable_bodies()) {
    if (body.role() == v1::ROLE_DRIVEN) body.set_role(v1::ROLE_AT_REST);
  }
  return scene;
}

std::optional<v1::Scene> LeftOut(const Model& model, const std::string& part) {
  v1::Scene scene = model.scene;
  AddEmptyRegion(model, scene);
  if (part == kSprings) SpreadMassByArea(scene);
  bool any = false;
  for (v1::Force& force : *scene.mutable_forces()) {
    if (PartOf(force) != part) continue;
    if (!MakeEmpty(force)) return std::nullopt;
    any = true;
  }
  for (v1::Constraint& constraint : *scene.mutable_constraints()) {
    if (PartOf(constraint) != part) continue;
    if (!MakeEmpty(constraint)) return std::nullopt;
    any = true;
  }
  return any ? std::optional(scene) : std::nullopt;
}

bool SwitchOff(const std::string& part, v1::Parameters& parameters) {
  if (part == kLinks) {
    parameters.set_apply_links(false);
  } else if (part == kMuscles) {
    parameters.set_apply_muscles(false);
  } else if (part == kRibs) {
    parameters.set_rib_motion(0);
  } else {
    return false;
  }
  return true;
}

}  // namespace phrenic::study
