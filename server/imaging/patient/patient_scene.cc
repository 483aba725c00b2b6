#include "server/imaging/patient/patient_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "server/anatomy/inner_cage.h"
#include "server/anatomy/rib.h"
#include "server/imaging/rib_axis.h"
#include "server/mesh/units.h"
#include "server/schema/body_size.h"

namespace phrenic::imaging {
namespace {

using Names = google::protobuf::RepeatedPtrField<std::string>;

constexpr double kPatternWidth = 262;   // of the generated thorax [mm]
constexpr double kFurthestSeen = 5e-3;  // vertex of the seen sheet from its middle, which folds sharply at the wall [m]

const char* LayerOf(v1::Structure structure) {
  switch (structure) {
    case v1::STRUCTURE_DIAPHRAGM:
      return "diaphragm";
    case v1::STRUCTURE_RIB:
      return "ribs";
    case v1::STRUCTURE_COSTAL_CARTILAGE:
      return "cartilages";
    case v1::STRUCTURE_INNER_CAGE:
      return "mechanics";
    case v1::STRUCTURE_VERTEBRA:
      return "spine";
    case v1::STRUCTURE_LUNG:
      return "lungs";
    default:
      return "sternum";
  }
}

v1::Role RoleOf(v1::Structure structure) {
  switch (structure) {
    case v1::STRUCTURE_VERTEBRA:
      return v1::ROLE_AT_REST;
    case v1::STRUCTURE_COSTAL_CARTILAGE:
    case v1::STRUCTURE_LUNG:
      return v1::ROLE_SEEN;
    default:
      return v1::ROLE_DRIVEN;
  }
}

v1::Body BodyOf(const PatientBody& from, const v1::Scene& pattern) {
  const auto found = std::find_if(pattern.bodies().begin(), pattern.bodies().end(),
                                  [&](const v1::Body& body) { return body.name() == from.name; });
  if (found != pattern.bodies().end() && !found->has_for_each()) return *found;
  v1::Body body;
  body.set_name(from.name);
  body.set_layer(LayerOf(from.anatomy.structure()));
  body.set_role(RoleOf(from.anatomy.structure()));
  return body;
}

void AddBodies(const std::vector<PatientBody>& bodies, const v1::Scene& pattern, double scale,
               const std::string& folder, v1::Scene& scene) {
  scene.clear_bodies();
  for (const PatientBody& from : bodies) {
    v1::Body& body = *scene.add_bodies() = BodyOf(from, pattern);
    *body.mutable_anatomy() = from.anatomy;
    body.mutable_file()->set_path(absl::StrCat(folder, "/", from.name, ".msh"));
    if (body.has_mass()) body.set_mass(body.mass() * scale * scale);
  }
}

void KeepKnown(const std::set<std::string>& layers, Names* names) {
  names->erase(std::remove_if(names->begin(), names->end(), [&](const auto& name) { return !layers.contains(name); }),
               names->end());
}

// Returns the angle of an axis from the midsagittal plane [rad]; 0 points backwards.
double FromMidplane(const Eigen::Vector3d& axis) { return std::atan2(std::abs(axis.x()), axis.y()); }

// Returns how much further from the midsagittal plane the neck of a rib is than that of the generated one [rad].
double NeckTurn(const PatientBody& rib, double scale) {
  const anatomy::Curve path = anatomy::LeftRibPath(rib.anatomy.number());
  return FromMidplane(FindRibNeck(rib.mesh, scale).Axis()) - FromMidplane(path[2] - path[0]);
}

// A motion of its own for each rib: the language's end states go by number, and the two sides differ.
void AddRib(const PatientBody& rib, const v1::Ribs& pattern, double scale, v1::Scene& scene) {
  for (const v1::RibEndState& usual : pattern.end_states()) {
    if (usual.number() != rib.anatomy.number()) continue;
    const double angle = std::hypot(usual.pump_degrees(), usual.bucket_degrees());
    const double turned = std::atan2(usual.pump_degrees(), usual.bucket_degrees()) + NeckTurn(rib, scale);
    v1::Motion& motion = *scene.add_motions();
    motion.set_name(absl::StrCat("turn:", rib.name));
    v1::Ribs& ribs = *motion.mutable_ribs() = pattern;
    ribs.clear_bodies();
    ribs.clear_end_states();
    ribs.add_bodies(rib.name);
    v1::RibEndState& end = *ribs.add_end_states();
    end.set_number(usual.number());
    end.set_pump_degrees(angle * std::sin(turned));
    end.set_bucket_degrees(angle * std::cos(turned));
  }
}

// True if a motion moves the body by its own name.
bool IsMoved(const v1::Scene& scene, const std::string& body) {
  return std::ranges::any_of(scene.motions(), [&](const v1::Motion& motion) {
    return motion.has_skin() && std::ranges::find(motion.skin().bodies(), body) != motion.skin().bodies().end();
  });
}

// Skins the cartilages that the pattern does not know by name.
void AddCartilages(const std::vector<PatientBody>& bodies, const std::set<std::string>& layers, v1::Scene& scene) {
  v1::Skin skin;
  for (const PatientBody& body : bodies) {
    const bool cartilage = body.anatomy.structure() == v1::STRUCTURE_COSTAL_CARTILAGE;
    if (cartilage && !IsMoved(scene, body.name)) skin.add_bodies(body.name);
  }
  if (skin.bodies().empty()) return;
  skin.add_drivers("ribs");
  if (layers.contains("sternum")) skin.add_drivers("sternum");
  *scene.add_motions()->mutable_skin() = skin;
}

// Adds a motion of the pattern, unless the patient lacks what it moves.
void AddMotion(const v1::Motion& motion, const std::set<std::string>& known, v1::Scene& scene) {
  if (motion.has_for_each()) return;
  if (motion.has_sternum() && !known.contains("sternum")) return;
  if (motion.has_skin() && !known.contains(motion.skin().bodies(0))) return;
  v1::Motion& added = *scene.add_motions() = motion;
  if (!added.has_skin()) return;
  KeepKnown(known, added.mutable_skin()->mutable_drivers());
  if (added.skin().mode() == v1::SKIN_MODE_SHEET) added.mutable_skin()->set_thickness(kFurthestSeen);
}

// `known` has the names of the patient's layers and bodies.
void AddMotions(const v1::Scene& pattern, const std::vector<PatientBody>& bodies, const std::set<std::string>& known,
                const CageFrame& frame, v1::Scene& scene) {
  scene.clear_motions();
  for (const v1::Motion& motion : pattern.motions()) {
    if (!motion.has_ribs()) {
      AddMotion(motion, known, scene);
      continue;
    }
    for (const PatientBody& body : bodies) {
      if (body.anatomy.structure() == v1::STRUCTURE_RIB) AddRib(body, motion.ribs(), ScaleOf(frame), scene);
    }
  }
  AddCartilages(bodies, known, scene);
  for (v1::Motion& motion : *scene.mutable_motions()) {
    if (!motion.has_insertion()) continue;
    motion.mutable_insertion()->mutable_apex()->set_x(0);
    motion.mutable_insertion()->mutable_apex()->set_y(kMillimetre * frame.centre.y());
    motion.mutable_insertion()->mutable_apex()->set_z(kMillimetre * frame.lumbar[2]);
  }
}

// Returns the volume inside a tube of horizontal rings [m^3], by cones from its middle.
double VolumeInside(const Mesh& tube) {
  const Eigen::Vector3d middle = tube.vertices.rowwise().mean();
  const auto cone = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    return (a - middle).dot((b - middle).cross(c - middle)) / 6;
  };
  double volume = 0;
  for (const auto t : tube.triangles.colwise()) {
    volume += cone(tube.vertices.col(t[0]), tube.vertices.col(t[1]), tube.vertices.col(t[2]));
  }
  for (const auto& [name, outwards] : {std::pair("bottom", -1), std::pair("top", 1)}) {
    const std::vector<int>& ring = tube.regions.at(name);
    const Eigen::Vector3d lid = tube.vertices(Eigen::all, ring).rowwise().mean();
    for (size_t i = 0; i < ring.size(); ++i) {
      volume += outwards * cone(lid, tube.vertices.col(ring[i]), tube.vertices.col(ring[(i + 1) % ring.size()]));
    }
  }
  return volume;
}

// Returns the volume inside the patient's wall relative to that of the generated one; 1 without a wall.
double RelativeVolume(const std::vector<PatientBody>& bodies) {
  const double generated = std::pow(kMillimetre, 3) * VolumeInside(anatomy::InnerCage(8));
  for (const PatientBody& body : bodies) {
    if (body.name == kWallBody) return VolumeInside(body.mesh) / generated;
  }
  return 1;
}

// The patient's mesh has no openings: no muscle is passive tissue.
void AdaptForces(double length, double volume, v1::Scene& scene) {
  for (v1::Force& force : *scene.mutable_forces()) {
    if (force.has_muscle()) force.mutable_muscle()->clear_passive_regions();
  }
  schema::ScaleForces({.length = length, .volume = volume, .resting = volume, .inspired = volume}, &scene);
}

v1::Probe ProbeOf(const std::string& name, const std::string& body) {
  v1::Probe probe;
  probe.set_name(name);
  probe.set_body(body);
  return probe;
}

void AddProbes(const std::vector<PatientBody>& bodies, v1::Scene& scene) {
  scene.clear_probes();
  (*scene.add_probes() = ProbeOf("right summit", "diaphragm")).set_highest_on(v1::SIDE_RIGHT);
  (*scene.add_probes() = ProbeOf("left summit", "diaphragm")).set_highest_on(v1::SIDE_LEFT);
  for (const PatientBody& body : bodies) {
    Eigen::Index at = 0;
    if (body.anatomy.structure() == v1::STRUCTURE_STERNUM_BODY) {
      body.mesh.vertices.row(1).minCoeff(&at);
      (*scene.add_probes() = ProbeOf("sternum", body.name)).set_vertex(static_cast<int>(at));
    }
    if (body.anatomy.structure() == v1::STRUCTURE_RIB && body.anatomy.number() == 8) {
      body.mesh.vertices.row(0).cwiseAbs().maxCoeff(&at);
      const char* side = body.anatomy.side() == v1::SIDE_LEFT ? "left" : "right";
      (*scene.add_probes() = ProbeOf(absl::StrCat("rib 8 ", side), body.name)).set_vertex(static_cast<int>(at));
    }
  }
}

}  // namespace

double ScaleOf(const CageFrame& frame) { return frame.width / kPatternWidth; }

v1::Scene PatientScene(const v1::Scene& pattern, const std::vector<PatientBody>& bodies, const CageFrame& frame,
                       const std::string& name) {
  v1::Scene scene = pattern;
  scene.set_name(name);
  scene.set_title(absl::StrCat("Thorax of ", name, ", from a label volume"));
  scene.set_description("Made by `phrenic patient`; the report beside it says where it had to guess.");
  std::set<std::string> known;
  for (const PatientBody& body : bodies) known.insert({body.name, LayerOf(body.anatomy.structure())});
  auto& shown = *scene.mutable_layers();
  shown.erase(
      std::remove_if(shown.begin(), shown.end(), [&](const v1::Layer& layer) { return !known.contains(layer.name()); }),
      shown.end());
  AddBodies(bodies, pattern, ScaleOf(frame), name, scene);
  AddMotions(pattern, bodies, known, frame, scene);
  AdaptForces(ScaleOf(frame), RelativeVolume(bodies), scene);
  AddProbes(bodies, scene);
  return scene;
}

}  // namespace phrenic::imaging
