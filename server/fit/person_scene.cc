#include "server/fit/person_scene.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/lungs/mode_parameters.h"

namespace phrenic::fit {
namespace {

constexpr double kBall = 0.0015, kRod = 0.0006;  // radii [m]
constexpr double kTimeStep = 0.01;               // [s]: nothing is integrated
constexpr double kLungMass = 0.5;                // [kg]: no force acts on it
constexpr int kMostLandmarks = 400;              // of a scene

// Returns the number with so many digits behind the point.
double Rounded(double value, int digits) {
  const double parts = std::pow(10, digits);
  return std::round(value * parts) / parts;
}

void Set(const Eigen::Vector3d& from, int digits, v1::Vector& to) {
  to.set_x(Rounded(from.x(), digits));
  to.set_y(Rounded(from.y(), digits));
  to.set_z(Rounded(from.z(), digits));
}

void AddLayer(const char* name, const char* title, const char* color, double opacity, v1::Scene& scene) {
  v1::Layer& layer = *scene.add_layers();
  layer.set_name(name);
  layer.set_title(title);
  layer.set_color(color);
  layer.set_opacity(opacity);
}

Eigen::Vector3d VectorOf(const v1::Vector& v) { return {v.x(), v.y(), v.z()}; }

// Adds the template's lung, scaled and shifted: p = s (s0 q + t0) + t.
void AddLung(const v1::Body& lung, const Registration& registration, v1::Scene& scene) {
  v1::Body& body = *scene.add_bodies();
  body = lung;
  body.set_layer("lungs");
  body.set_role(v1::ROLE_DEFORMABLE);
  body.clear_material();
  body.set_mass(kLungMass);
  const Eigen::Vector3d scale = lung.has_scale() ? VectorOf(lung.scale()) : Eigen::Vector3d(1, 1, 1);
  Set(registration.scale.cwiseProduct(scale), 4, *body.mutable_scale());
  Set(registration.scale.cwiseProduct(VectorOf(lung.offset())) + registration.shift, 5, *body.mutable_offset());
}

void AddProbe(const std::string& name, const std::string& body, const Eigen::Vector3d& at, v1::Scene& scene) {
  v1::Probe& probe = *scene.add_probes();
  probe.set_name(name);
  probe.set_body(body);
  Set(at, 4, *probe.mutable_nearest_to());
}

// Adds probes at the middle of the base and at the top of a lung.
void AddProbes(const std::string& side, const std::string& body, const Eigen::AlignedBox3d& box, v1::Scene& scene) {
  Eigen::Vector3d at = box.center();
  at.z() = box.min().z() + 0.2 * box.sizes().z();
  AddProbe(side + " base", body, at, scene);
  at.z() = box.max().z();
  AddProbe(side + " apex", body, at, scene);
}

void AddMeasures(v1::Scene& scene) {
  v1::Measure& volume = *scene.add_measures();
  volume.set_name("lung volume");
  volume.mutable_volume()->mutable_surface()->add_bodies("lungs");
  v1::Measure& flow = *scene.add_measures();
  flow.set_name("flow");
  flow.mutable_flow()->mutable_surface()->add_bodies("lungs");
}

// Returns the amplitudes of a preset in which only the base moves, or all but the base.
Eigen::VectorXd PartOf(const std::vector<Amplitude>& amplitudes, const Eigen::VectorXd& values, bool base) {
  Eigen::VectorXd part = values;
  for (size_t a = 0; a < amplitudes.size(); ++a) {
    const int mode = amplitudes[a].mode;
    const bool of_base = mode == kPiston || mode == kTiltFrontBack || mode == kTiltLeftRight || mode == kDome;
    if (of_base != base) part[static_cast<Eigen::Index>(a)] = 0;
  }
  return part;
}

void AddVertex(const Eigen::Vector3d& at, v1::Polyhedron& shape) { Set(at, 5, *shape.add_vertices()); }

void AddTriangle(int a, int b, int c, v1::Polyhedron& shape) {
  v1::IndexTriple& triangle = *shape.add_triangles();
  triangle.set_a(a);
  triangle.set_b(b);
  triangle.set_c(c);
}

// Adds an octahedron stretched from `from` to `to`, which faces outwards.
void AddRod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius, v1::Polyhedron& shape) {
  const int first = shape.vertices_size();
  const Eigen::Vector3d along = to - from, axis = along.norm() > 1e-9 ? along.normalized() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.cross(u), middle = (from + to) / 2;
  AddVertex(from - radius * axis, shape);
  for (const Eigen::Vector3d& side : {u, v, Eigen::Vector3d(-u), Eigen::Vector3d(-v)}) {
    AddVertex(middle + radius * side, shape);
  }
  AddVertex(to + radius * axis, shape);
  for (int k = 0; k < 4; ++k) {
    const int here = first + 1 + k, next = first + 1 + (k + 1) % 4;
    AddTriangle(first, next, here, shape);
    AddTriangle(first + 5, here, next, shape);
  }
}

v1::Polyhedron& AddShapes(const char* name, v1::Role role, v1::Scene& scene) {
  v1::Body& body = *scene.add_bodies();
  body.set_name(name);
  body.set_layer(name);
  body.set_role(role);
  if (role == v1::ROLE_DEFORMABLE) body.set_mass(kLungMass);
  return *body.mutable_polyhedron();
}

}  // namespace

v1::Preset BreathPreset(const std::string& name, const std::string& title, const std::string& description,
                        const std::vector<Amplitude>& amplitudes, const Eigen::VectorXd& values) {
  v1::Preset preset;
  preset.set_name(name);
  preset.set_title(title);
  preset.set_description(description);
  SetModeAmplitudes(amplitudes, values.unaryExpr([](double value) { return Rounded(value, 6); }),
                    *preset.mutable_parameters());
  return preset;
}

std::vector<v1::Preset> PresetsOf(const MotionFit& fit, const std::vector<Amplitude>& amplitudes) {
  const Eigen::VectorXd& fitted = fit.person.amplitudes;
  const int numbers = static_cast<int>(amplitudes.size());
  std::vector<v1::Preset> presets;
  presets.push_back(BreathPreset(
      "fitted", "Fitted",
      absl::StrFormat("The breath of %d numbers fitted to %d landmarks; off by %.2f mm at the %d it has not seen.",
                      numbers, fit.halves.fitting.size(), 1e3 * fit.held_out.mean, fit.halves.held_out.size()),
      amplitudes, fitted));
  presets.push_back(BreathPreset(
      "expected", "Expected of people",
      absl::StrFormat("What the descent of %.1f mm alone leads to expect of people: the difference is this person's.",
                      1e3 * fit.descent),
      amplitudes, fit.descent * ShippedPeople(numbers).mean));
  presets.push_back(BreathPreset("bases-alone", "Bases alone",
                                 "Only the lungs' bases move, as by the diaphragm: the tissue above follows.",
                                 amplitudes, PartOf(amplitudes, fitted, true)));
  presets.push_back(BreathPreset("walls-alone", "Walls alone",
                                 "Only the chest wall and the mediastinum move: the bases stay where they are.",
                                 amplitudes, PartOf(amplitudes, fitted, false)));
  return presets;
}

v1::Scene PersonScene(const PersonBreath& breath, const LungTemplates& templates) {
  v1::Scene scene;
  scene.set_name(breath.name);
  scene.set_title(absl::StrCat("Lungs of ", breath.name));
  scene.set_description(breath.description);
  AddLayer("lungs", "Lungs", "#e7a6a1", 0.6, scene);
  for (const Side side : {kRight, kLeft}) {
    const Registration& registration = breath.registered.lungs[side];
    AddLung(breath.lungs[side], registration, scene);
    const Eigen::AlignedBox3d& box = templates[side].box();
    const auto moved = [&](const Eigen::Vector3d& q) -> Eigen::Vector3d {
      return q.cwiseProduct(registration.scale) + registration.shift;
    };
    AddProbes(side == kLeft ? "left" : "right", breath.lungs[side].name(), {moved(box.min()), moved(box.max())}, scene);
  }
  scene.add_motions()->mutable_lung_modes()->add_lungs("structure:lung");
  scene.mutable_breath()->set_waveform(v1::WAVEFORM_RAISED_COSINE);
  *scene.mutable_parameters() = breath.presets.front().parameters();
  scene.mutable_parameters()->set_time_step(kTimeStep);
  AddMeasures(scene);
  for (const v1::Preset& preset : breath.presets) *scene.add_presets() = preset;
  return scene;
}

v1::Scene FittedScene(const std::string& name, const std::string& source, const SceneLungs& lungs, const MotionFit& fit,
                      int numbers, bool landmarks) {
  const std::string description = absl::StrFormat(
      "Lungs and breath of a person: %d numbers fitted to half of %d landmark pairs (%s), off by %.2f mm at the rest.",
      numbers, fit.exhale.cols(), source, 1e3 * fit.held_out.mean);
  v1::Scene scene = PersonScene(
      {name, description, lungs.bodies, fit.registered, PresetsOf(fit, BreathAmplitudes(numbers))}, lungs.templates);
  if (landmarks) AddLandmarks(fit, kMostLandmarks, scene);
  return scene;
}

v1::Scene JointScene(const std::string& name, const std::string& source, const SceneLungs& lungs, const JointFit& fit,
                     int numbers, bool landmarks) {
  std::vector<v1::Preset> presets = PresetsOf(fit.motion, BreathAmplitudes(numbers));
  presets.front().set_description(absl::StrFormat("The breath of %d numbers fitted to %s.", numbers, source));
  const std::string description = absl::StrFormat("%s and breath of a person: %d numbers fitted to %s.",
                                                  fit.own_lungs ? "Lungs" : "Lungs of the template,", numbers, source);
  v1::Scene scene =
      PersonScene({name, description, lungs.bodies, fit.motion.registered, std::move(presets)}, lungs.templates);
  v1::Parameters& parameters = *scene.mutable_parameters();
  if (fit.breath_length > 0) {
    parameters.set_breath_length(Rounded(fit.breath_length, 3));
    parameters.set_inspiratory_share(Rounded(fit.inspiratory_share, 3));
    parameters.set_pause_share(Rounded(fit.pause_share, 3));
  }
  if (landmarks && !fit.motion.halves.held_out.empty()) AddLandmarks(fit.motion, kMostLandmarks, scene);
  return scene;
}

void AddLandmarks(const MotionFit& fit, int most, v1::Scene& scene) {
  AddLayer("landmarks", "Landmarks, fitted motion", "#2f6fb5", 1, scene);
  AddLayer("landmarks-inhale", "Landmarks at end inhale", "#d9a520", 1, scene);
  AddLayer("residuals", "Residuals at end inhale", "#c0392b", 1, scene);
  v1::Polyhedron predicted, inhale, residuals;
  const auto held_out = static_cast<int>(fit.halves.held_out.size());
  const int count = std::min(most, held_out);
  for (int k = 0; k < count; ++k) {
    const Eigen::Index i = fit.halves.held_out[static_cast<size_t>(k) * held_out / count];
    const Eigen::Vector3d exhale = fit.exhale.col(i), to = exhale + fit.motion.col(i),
                          expected = exhale + fit.predicted.col(i);
    AddRod(exhale, exhale, kBall, predicted);
    AddRod(to, to, kBall, inhale);
    AddRod(expected, to, kRod, residuals);
  }
  AddShapes("landmarks", v1::ROLE_DEFORMABLE, scene) = predicted;
  AddShapes("landmarks-inhale", v1::ROLE_AT_REST, scene) = inhale;
  AddShapes("residuals", v1::ROLE_AT_REST, scene) = residuals;
  for (v1::Motion& motion : *scene.mutable_motions()) {
    if (motion.has_lung_modes()) motion.mutable_lung_modes()->add_inside("body:landmarks");
  }
}

}  // namespace phrenic::fit
