#include "server/mechanics/forces/thorax_pressures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {
namespace {

constexpr std::array<Force::Output, 8> kThoraxOutputs = {{{"volume", "m^3"},
                                                            {"flow", "m^3/s"},
                                                            {"pleural_pressure_right", "Pa"},
                                                            {"pleural_pressure_left", "Pa"},
                                                            {"abdominal_pressure", "Pa"},
                                                            {"transdiaphragmatic_pressure", "Pa"},
                                                            {"alveolar_pressure", "Pa"},
                                                            {"displaced_volume", "m^3"}}};
constexpr double kLeastRoom = 0.02;  // of a lung's room: the curve continues along its tangent below

double WithSign(size_t side) { return side == 0 ? 1 : -1; }

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> ThoraxPressures::Make(const v1::ThoraxPressures& scene, const std::string& given,
                                                             std::string_view path, ModelBuilder& builder) {
  const std::string field(path);
  Names named;
  *named.Add() = scene.body();
  const auto body = builder.DeformableBodies(named, field + ".body");
  if (!body.ok()) return body.status();
  auto wall = FindCageWall(scene.wall(), field + ".wall", builder);
  if (!wall.ok()) return wall.status();
  std::unique_ptr<ThoraxPressures> force(
      new ThoraxPressures(ElementName(given, "thorax_pressures", named), scene, *std::move(wall)));
  const v1::LungPair& lungs = scene.lungs();
  force->shift_ = builder.AddCoordinate("mediastinal shift", "m^3", lungs.mediastinal_inertia());
  force->shift_damping_ = lungs.mediastinal_damping_rate() * lungs.mediastinal_inertia();
  force->AddSheet(builder.model.bodies[body->front()], builder.model);
  builder.ReportElement(
      "force", force->name(), static_cast<std::int64_t>(force->triangles_.size()), "triangles",
      absl::StrFormat("lungs %g Pa s/m^3, abdomen %g m^3/Pa", lungs.resistance(), scene.abdomen().compliance()));
  return force;
}

void ThoraxPressures::AddSheet(const BodyModel& body, const Model& model) {
  double total = 0;
  for (Eigen::Index t = 0; t < body.mesh.triangles.cols(); ++t) {
    const Eigen::Vector3i corners = body.mesh.triangles.col(t).array() + body.first_vertex;
    const Eigen::Vector3d a = model.rest.col(corners[0]), b = model.rest.col(corners[1]), c = model.rest.col(corners[2]);
    const Eigen::Vector3d mean = (a + b + c) / 3;
    const double area = (b - a).cross(c - a).norm() / 2;
    triangles_.push_back({corners, mean.x() < 0 ? kRight : kLeft});
    centre_ += area * mean;
    total += area;
  }
  centre_ /= total;
  for (const int vertex : wall_->border) border_sides_.push_back(model.rest(0, vertex) < 0 ? kRight : kLeft);
  Slopes slopes;
  rest_cones_ = Cones(model.rest, slopes);
}

std::array<double, 2> ThoraxPressures::Cones(const ConstPoints& x, Slopes& slopes) const {
  std::array<double, 2> volume = {};
  for (Points& of : slopes.of) of.setZero(3, x.cols());
  for (const auto& [corners, side] : triangles_) {
    const Eigen::Vector3d a = x.col(corners[0]) - wall_->apex, b = x.col(corners[1]) - wall_->apex,
                          c = x.col(corners[2]) - wall_->apex;
    const Eigen::Vector3d third = (b - a).cross(c - a) / 6;
    volume[side] += a.dot(third);
    for (const int i : corners) slopes.of[side].col(i) += third;
  }
  // On the border the face of the cone towards the apex moves with the vertices.
  const std::vector<int>& border = wall_->border;
  for (size_t i = 0; i < border.size(); ++i) {
    const int before = border[(i + border.size() - 1) % border.size()], after = border[(i + 1) % border.size()];
    const Eigen::Vector3d at = x.col(border[i]) - wall_->apex, along = x.col(before) - x.col(after);
    slopes.of[border_sides_[i]].col(border[i]) += at.cross(along) / 6;
  }
  return volume;
}

double ThoraxPressures::Recoil(double volume) const {
  const double room = scene_.lungs().room() / 2, rate = scene_.lungs().recoil_rate();
  const double left = room - volume, least = kLeastRoom * room;
  if (left > least) return std::log(room / left) / rate;
  return (-std::log(kLeastRoom) + (least - left) / least) / rate;
}

double ThoraxPressures::RecoilSlope(double volume) const {
  const double room = scene_.lungs().room() / 2;
  return 1 / (scene_.lungs().recoil_rate() * std::max(room - volume, kLeastRoom * room));
}

double ThoraxPressures::AbdominalPressure(double displaced) const {
  const v1::Abdomen& abdomen = scene_.abdomen();
  const double ratio = displaced / (displaced > 0 ? abdomen.stiffening_volume_out() : abdomen.stiffening_volume_in());
  return displaced / abdomen.compliance() * (1 + ratio * ratio);
}

double ThoraxPressures::AbdominalSlope(double displaced) const {
  const v1::Abdomen& abdomen = scene_.abdomen();
  const double ratio = displaced / (displaced > 0 ? abdomen.stiffening_volume_out() : abdomen.stiffening_volume_in());
  return (1 + 3 * ratio * ratio) / abdomen.compliance();
}

ThoraxPressures::Sides ThoraxPressures::SidesAt(const EvalContext& at, Slopes& slopes) const {
  Sides now;
  const std::array<double, 2> cones = Cones(at.x, slopes);
  now.cage = wall_->Position(at);
  const CagePosition rate = wall_->Rate(at);
  for (const size_t h : {kRight, kLeft}) {
    const CageQuadratic& wall = WallVolume(h);
    const double swept = Dot(slopes.of[h], at.v);
    now.volume[h] = wall.At(now.cage) - (cones[h] - rest_cones_[h]) + WithSign(h) * shift_.Value(at.x);
    now.flow[h] = wall.ByPump(now.cage) * rate.pump + wall.ByBucket(now.cage) * rate.bucket - swept +
                  WithSign(h) * shift_.Rate(at.v);
    now.displaced -= cones[h] - rest_cones_[h];
    now.displaced_rate -= swept;
  }
  const v1::LungPair& lungs = scene_.lungs();
  const double common = std::max(0.0, lungs.resistance() - lungs.peripheral_resistance());
  for (const size_t h : {kRight, kLeft}) {
    now.pleural[h] = scene_.pleural_pressure() - Recoil(now.volume[h]) -
                     2 * lungs.peripheral_resistance() * now.flow[h] - common * (now.flow[kRight] + now.flow[kLeft]);
  }
  now.abdominal = scene_.pleural_pressure() + scene_.transdiaphragmatic_pressure() + AbdominalPressure(now.displaced) +
                  scene_.abdomen().resistance() * now.displaced_rate;
  return now;
}

void ThoraxPressures::AddForce(const EvalContext& at, MutablePoints f) const {
  Slopes& slopes = at.scratch.Get<Slopes>();
  const Sides now = SidesAt(at, slopes);
  for (const size_t h : {kRight, kLeft}) {
    f += (now.abdominal - now.pleural[h]) * slopes.of[h];
    const CageQuadratic& wall = WallVolume(h);
    wall_->pump.AddForce(now.pleural[h] * wall.ByPump(now.cage), f);
    wall_->bucket.AddForce(now.pleural[h] * wall.ByBucket(now.cage), f);
  }
  const double shift = shift_.Value(at.x);
  shift_.AddForce(now.pleural[kRight] - now.pleural[kLeft] - shift / scene_.lungs().mediastinal_compliance() -
                      shift_damping_ * shift_.Rate(at.v),
                  f);
  const Eigen::Vector3d weight = ToEigen(scene_.abdomen().weight());
  if (weight.isZero()) return;
  for (const auto& [corners, side] : triangles_) {
    const Eigen::Vector3d a = at.x.col(corners[0]), b = at.x.col(corners[1]), c = at.x.col(corners[2]);
    const Eigen::Vector3d push = weight.dot((a + b + c) / 3 - centre_) / 6 * (b - a).cross(c - a);
    for (const int i : corners) f.col(i) += push;
  }
}

void ThoraxPressures::AddVolumeSlope(size_t side, double factor, const Slopes& slopes, const CagePosition& k,
                                     Points& g) const {
  g -= factor * slopes.of[side];
  wall_->pump.AddForce(factor * WallVolume(side).ByPump(k), g);
  wall_->bucket.AddForce(factor * WallVolume(side).ByBucket(k), g);
  shift_.AddForce(factor * WithSign(side), g);
}

void ThoraxPressures::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  Slopes& slopes = at.scratch.Get<Slopes>();
  const Sides now = SidesAt(at, slopes);
  Points g(3, at.x.cols());
  for (const size_t h : {kRight, kLeft}) {
    g.setZero();
    AddVolumeSlope(h, 1, slopes, now.cage, g);
    sink.AddOuter(RecoilSlope(now.volume[h]), g);
  }
  g = slopes.of[kRight] + slopes.of[kLeft];
  sink.AddOuter(AbdominalSlope(now.displaced), g);
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  block(shift_.axis, shift_.axis) = 1 / (scene_.lungs().mediastinal_compliance() * shift_.scale * shift_.scale);
  sink.Add(shift_.vertex, shift_.vertex, block);
}

void ThoraxPressures::AddSharedDamping(const EvalContext& at, OuterProducts& shared) const {
  struct Gradient {
    Points g;
  };
  Slopes& slopes = at.scratch.Get<Slopes>();
  Points& g = at.scratch.Get<Gradient>().g;
  Cones(at.x, slopes);
  const CagePosition k = wall_->Position(at);
  const v1::LungPair& lungs = scene_.lungs();
  const auto add = [&](double resistance, double right, double left) {
    if (resistance <= 0) return;
    g.setZero(3, at.x.cols());
    AddVolumeSlope(kRight, right, slopes, k, g);
    AddVolumeSlope(kLeft, left, slopes, k, g);
    shared.Add(resistance, g);
  };
  add(2 * lungs.peripheral_resistance(), 1, 0);
  add(2 * lungs.peripheral_resistance(), 0, 1);
  add(lungs.resistance() - lungs.peripheral_resistance(), 1, 1);
  if (scene_.abdomen().resistance() > 0) {
    g = slopes.of[kRight] + slopes.of[kLeft];
    shared.Add(scene_.abdomen().resistance(), g);
  }
}

double ThoraxPressures::Energy(const EvalContext& at) const {
  Slopes& slopes = at.scratch.Get<Slopes>();
  const Sides now = SidesAt(at, slopes);
  const double room = scene_.lungs().room() / 2, shift = shift_.Value(at.x);
  double energy = shift * shift / (2 * scene_.lungs().mediastinal_compliance());
  for (const double volume : now.volume) {
    const double left = std::max(room - volume, kLeastRoom * room);
    energy += (left * std::log(left / room) + (room - left)) / scene_.lungs().recoil_rate();
    energy -= scene_.pleural_pressure() * volume;
  }
  const double v = now.displaced;
  const double ratio = v / (v > 0 ? scene_.abdomen().stiffening_volume_out() : scene_.abdomen().stiffening_volume_in());
  energy += v * v / (2 * scene_.abdomen().compliance()) * (1 + ratio * ratio / 2);
  return energy + (scene_.pleural_pressure() + scene_.transdiaphragmatic_pressure()) * v;
}

std::span<const Force::Output> ThoraxPressures::outputs() const { return kThoraxOutputs; }

double ThoraxPressures::Read(size_t output, const EvalContext& at) const {
  Slopes& slopes = at.scratch.Get<Slopes>();
  const Sides now = SidesAt(at, slopes);
  const v1::LungPair& lungs = scene_.lungs();
  const double flow = now.flow[kRight] + now.flow[kLeft], pleural = (now.pleural[kRight] + now.pleural[kLeft]) / 2;
  switch (output) {
    case 0:
      return lungs.rest_volume() + now.volume[kRight] + now.volume[kLeft];
    case 1:
      return flow;
    case 2:
      return now.pleural[kRight];
    case 3:
      return now.pleural[kLeft];
    case 4:
      return now.abdominal;
    case 5:
      return now.abdominal - pleural;
    case 6:
      return -lungs.resistance() * flow;
    default:
      return now.displaced;
  }
}

}  // namespace phrenic
