#include "server/mechanics/forces/thorax_pressures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/breathing/expiratory_muscles.h"
#include "server/mechanics/breathing/posture.h"

namespace phrenic {
namespace {

constexpr std::array<Force::Output, 10> kThoraxOutputs = {{{"volume", "m^3"},
                                                           {"flow", "m^3/s"},
                                                           {"pleural_pressure_right", "Pa"},
                                                           {"pleural_pressure_left", "Pa"},
                                                           {"abdominal_pressure", "Pa"},
                                                           {"transdiaphragmatic_pressure", "Pa"},
                                                           {"alveolar_pressure", "Pa"},
                                                           {"displaced_volume", "m^3"},
                                                           {"space_right", "m^3"},
                                                           {"space_left", "m^3"}}};
constexpr double kLeastRoom = 0.02;  // of a lung's room: the curve continues along its tangent below

constexpr double kAtmosphere = 101325;  // [Pa]
constexpr double kClosingRange = 0.3;   // of the closing volume, over which the airways of a lung close
constexpr double kMostClosed = 1000;    // the resistance of closed airways over that of open ones
constexpr double kCollapsed = 0.3;      // volume of a collapsed lung, of that at rest

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
  const BodyModel& sheet = builder.model.bodies[body->front()];
  const int end = sheet.first_vertex + static_cast<int>(sheet.mesh.vertices.cols());
  for (const int vertex : (*wall)->border) {
    if (vertex >= sheet.first_vertex && vertex < end) continue;
    return FieldError(field + ".body", absl::StrCat("the insertion that names the wall \"", scene.wall(),
                                                    "\" inserts another body than \"", sheet.name, "\""));
  }
  std::unique_ptr<ThoraxPressures> force(
      new ThoraxPressures(ElementName(given, "thorax_pressures", named), scene, *std::move(wall)));
  const v1::LungPair& lungs = scene.lungs();
  force->shift_ = builder.AddCoordinate("mediastinal shift", "m^3", lungs.mediastinal_inertia());
  force->shift_damping_ = lungs.mediastinal_damping_rate() * lungs.mediastinal_inertia();
  force->AddSheet(sheet, builder.model);
  force->first_scalar_ = builder.AddInternalScalars(force->name() + ":closed-airway", "m^3", 2);
  force->expiration_ = builder.AddInternalScalars(force->name() + ":expiration", "1", 1);
  builder.ReportElement(
      "force", force->name(), sheet.mesh.triangles.cols(), "triangles",
      absl::StrFormat("lungs %g Pa s/m^3, abdomen %g m^3/Pa", lungs.resistance(), scene.abdomen().compliance()));
  return force;
}

void ThoraxPressures::AddSheet(const BodyModel& body, const Model& model) {
  const Triangles& triangles = body.mesh.triangles;
  const Points& rest = body.mesh.vertices;
  std::array<std::vector<Eigen::Index>, 2> of_side;
  double total = 0;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3d a = rest.col(triangles(0, t)), b = rest.col(triangles(1, t)), c = rest.col(triangles(2, t));
    const double area = (b - a).cross(c - a).norm() / 2;
    of_side[(a + b + c).x() < 0 ? kRight : kLeft].push_back(t);
    centre_ += area * (a + b + c) / 3;
    total += area;
  }
  if (total > 0) centre_ /= total;
  sheet_.first_vertex = body.first_vertex;
  std::vector<std::array<std::vector<std::int32_t>, 2>> around(static_cast<size_t>(rest.cols()));
  std::int32_t place = 0;
  for (const size_t side : {kRight, kLeft}) {
    Triangles chosen(3, static_cast<Eigen::Index>(of_side[side].size()));
    for (Eigen::Index i = 0; i < chosen.cols(); ++i) {
      const Eigen::Vector3i corners = triangles.col(of_side[side][i]);
      chosen.col(i) = corners.array() + body.first_vertex;
      for (const int corner : corners) around[corner][side].push_back(4 * (place + static_cast<std::int32_t>(i)));
    }
    sheet_.packets[side] = PackTriangles(chosen);
    place += kPacketTriangles * static_cast<std::int32_t>(sheet_.packets[side].size());
  }
  AddVertices(around);
  Slopes slopes;
  SetSlopes(model.rest, {}, slopes);
  rest_cones_ = slopes.cones;
}

void ThoraxPressures::AddVertices(const std::vector<std::array<std::vector<std::int32_t>, 2>>& around) {
  for (size_t i = 0; i < around.size(); ++i) {
    sheet_.first.push_back(static_cast<std::int32_t>(sheet_.around.size()));
    for (const auto& places : around[i]) sheet_.around.insert(sheet_.around.end(), places.begin(), places.end());
    const auto nothing = static_cast<std::int32_t>(4 * sheet_.triangles());
    while (sheet_.around.size() % kRingPlaces != 0) sheet_.around.push_back(nothing);
    const auto& [right, left] = around[i];
    on_left_.insert(on_left_.end(), 3, right.empty() ? 1 : 0);
    if (!right.empty() && !left.empty()) midline_.push_back({static_cast<int>(i), left});
  }
  sheet_.first.push_back(static_cast<std::int32_t>(sheet_.around.size()));
}

LinearField ThoraxPressures::Weight(const v1::Parameters& parameters) const {
  const Eigen::Vector3d slope = DownIn(parameters.posture(), ToEigen(scene_.abdomen().weight()));
  Eigen::Vector3d from = centre_;
  if (parameters.posture() == v1::POSTURE_UPRIGHT) from.z() -= scene_.abdomen().upright_level();
  return {{slope.x(), slope.y(), slope.z()}, slope.dot(from)};
}

const ThoraxPressures::Slopes& ThoraxPressures::SlopesAt(const EvalContext& at) const {
  Slopes& slopes = at.scratch.Get<Slopes>();
  const auto x = at.x.middleCols(sheet_.first_vertex, sheet_.vertices());
  const LinearField weight = Weight(at.parameters);
  const bool same = slopes.of == this && slopes.x.cols() == x.cols() && slopes.weight == weight &&
                    std::memcmp(slopes.x.data(), x.data(), sizeof(double) * static_cast<size_t>(x.size())) == 0;
  if (same) return slopes;
  SetSlopes(at.x, weight, slopes);
  slopes.x = x;
  slopes.weight = weight;
  slopes.of = this;
  return slopes;
}

void ThoraxPressures::SetSlopes(const ConstPoints& x, const LinearField& weight, Slopes& slopes) const {
  slopes.areas.resize(static_cast<Eigen::Index>(4 * sheet_.triangles() + 4));
  slopes.areas.tail<4>().setZero();
  slopes.sum.resize(3, sheet_.vertices());
  slopes.push.resize(3, slopes.sum.cols());
  slopes.left.resize(3, static_cast<Eigen::Index>(midline_.size()));
  slopes.cones = SetAreas(sheet_, x.data(), wall_->apex.data(), weight, slopes.areas.data());
  GatherAreas(sheet_, slopes.areas.data(), x.data(), weight, slopes.sum.data(), slopes.push.data());
  for (size_t m = 0; m < midline_.size(); ++m) {
    Eigen::Vector3d left = Eigen::Vector3d::Zero();
    for (const std::int32_t at : midline_[m].left) left += Eigen::Map<const Eigen::Vector3d>(&slopes.areas[at]);
    slopes.left.col(static_cast<Eigen::Index>(m)) = left;
  }
  AddConeFaces(x, weight, slopes);
}

// The face of the cones between an edge of the border and the apex moves with the edge's vertices: like a triangle of
// the sheet it adds its area vector, and the weight's pressure on it, to both.
void ThoraxPressures::AddConeFaces(const ConstPoints& x, const LinearField& weight, Slopes& slopes) const {
  const Eigen::Map<const Eigen::Vector3d> slope(weight.slope);
  const auto pressure = [&](const Eigen::Vector3d& point) { return slope.dot(point) - weight.offset; };
  const std::vector<int>& border = wall_->border;
  for (size_t i = 0; i < border.size(); ++i) {
    const int ends[] = {border[i], border[(i + 1) % border.size()]};
    const Eigen::Vector3d a = x.col(ends[0]), b = x.col(ends[1]);
    const Eigen::Vector3d area = (b - wall_->apex).cross(a - wall_->apex) / 6;
    const double mean = (pressure(wall_->apex) + pressure(a) + pressure(b)) / 3;
    for (const int end : ends) {
      slopes.sum.col(end - sheet_.first_vertex) += area;
      slopes.push.col(end - sheet_.first_vertex) += (pressure(x.col(end)) + 3 * mean) / 4 * area;
    }
  }
}

std::array<double, 2> ThoraxPressures::Swept(const ConstPoints& v, const Slopes& slopes) const {
  std::array<double, 2> swept = SumBySide(on_left_, v.col(sheet_.first_vertex).data(), slopes.sum.data());
  for (size_t m = 0; m < midline_.size(); ++m) {
    const double left =
        slopes.left.col(static_cast<Eigen::Index>(m)).dot(v.col(sheet_.first_vertex + midline_[m].vertex));
    swept[kLeft] += left, swept[kRight] -= left;
  }
  return swept;
}

void ThoraxPressures::AddSlopes(double right, double left, const Slopes& slopes, MutablePoints g) const {
  AddBySide(on_left_, right, left, slopes.sum.data(), g.col(sheet_.first_vertex).data());
  AddMidline(right, left, slopes, g);
}

void ThoraxPressures::SetSlopesAlone(double right, double left, const Slopes& slopes, Points& g) const {
  const Eigen::Index end = sheet_.first_vertex + slopes.sum.cols();
  g.leftCols(sheet_.first_vertex).setZero();
  g.rightCols(g.cols() - end).setZero();
  SetBySide(on_left_, right, left, slopes.sum.data(), g.col(sheet_.first_vertex).data());
  AddMidline(right, left, slopes, g);
}

void ThoraxPressures::AddMidline(double right, double left, const Slopes& slopes, MutablePoints g) const {
  for (size_t m = 0; m < midline_.size(); ++m) {
    g.col(sheet_.first_vertex + midline_[m].vertex) += (left - right) * slopes.left.col(static_cast<Eigen::Index>(m));
  }
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

double ThoraxPressures::RecoilEnergy(double volume) const {
  const double room = scene_.lungs().room() / 2, rate = scene_.lungs().recoil_rate(), least = kLeastRoom * room;
  const double left = std::max(room - volume, least), beyond = std::max(volume - (room - least), 0.0);
  const double curve = left * std::log(left / room) + (room - left);
  return (curve - beyond * std::log(kLeastRoom) + beyond * beyond / (2 * least)) / rate;
}

double ThoraxPressures::GasElastance(const EvalContext& at) const {
  return at.airway_closed ? kAtmosphere / scene_.lungs().rest_volume() : 0;
}

double ThoraxPressures::GasPressure(const EvalContext& at, const Sides& now) const {
  const double elastance = GasElastance(at);
  if (elastance == 0 || at.scalars.q[first_scalar_] == 0) return 0;  // it closes in this step
  return -elastance * (Volume(now) - at.scalars.q[first_scalar_ + 1]);
}

void ThoraxPressures::SetScalarRates(const EvalContext& at, Eigen::VectorXd& rates) const {
  rates[expiration_] = ExpiratoryRate(at, at.scalars.q[expiration_]);
}

void ThoraxPressures::AdvanceScalars(const EvalContext& end, std::int64_t, double dt, ScalarState& scalars) const {
  scalars.q[expiration_] = AdvanceExpiratory(end, dt, scalars.q[expiration_]);
  double &closed = scalars.q[first_scalar_], &volume = scalars.q[first_scalar_ + 1];
  if (end.airway_closed && closed == 0) volume = Volume(SidesAt(end, SlopesAt(end)));
  closed = end.airway_closed ? 1 : 0;
  if (closed == 0) volume = 0;
}

double ThoraxPressures::AirwayPressure(const EvalContext& at, const Sides& now) const {
  if (at.airway_closed) return GasPressure(at, now);
  return at.parameters.airway_pressure() + at.parameters.ventilator_pressure() * std::max(0.0, at.breath);
}

double ThoraxPressures::AbdominalLoad(const EvalContext& at) const {
  const v1::Parameters& parameters = at.parameters;
  return scene_.pleural_pressure() + scene_.transdiaphragmatic_pressure() + parameters.abdominal_load() +
         scene_.abdomen().expiratory_pressure() * parameters.muscle_strength() * at.scalars.q[expiration_];
}

void ThoraxPressures::SetResistances(const EvalContext& at, Sides& now) const {
  const v1::LungPair& lungs = scene_.lungs();
  const v1::Parameters& parameters = at.parameters;
  now.open = {1 - parameters.pneumothorax_right(), 1 - parameters.pneumothorax_left()};
  const double factor = parameters.airway_resistance();
  now.common = factor * std::max(0.0, lungs.resistance() - lungs.peripheral_resistance());
  if (at.airway_closed) now.common = 0;
  const double closing = parameters.trapped_air() / 2;
  for (const size_t h : {kRight, kLeft}) {
    now.peripheral[h] = factor * lungs.peripheral_resistance();
    if (closing <= 0 || now.flow[h] >= 0 || now.volume[h] >= closing) continue;
    const double closed = std::min(1.0, (closing - now.volume[h]) / (kClosingRange * closing));
    now.peripheral[h] *= 1 + kMostClosed * closed * closed;
  }
}

ThoraxPressures::Sides ThoraxPressures::SidesAt(const EvalContext& at, const Slopes& slopes) const {
  Sides now;
  const std::array<double, 2> swept = Swept(at.v, slopes);
  now.cage = wall_->Position(at);
  const CagePosition rate = wall_->Rate(at);
  const double fluid[] = {at.parameters.pleural_fluid_right(), at.parameters.pleural_fluid_left()};
  for (const size_t h : {kRight, kLeft}) {
    const CageFunction& wall = WallVolume(h);
    const double cone = slopes.cones[h] - rest_cones_[h];
    now.volume[h] = wall.At(now.cage) - cone + WithSign(h) * shift_.Value(at.x) - fluid[h];
    now.flow[h] = wall.RateAt(now.cage, rate) - swept[h] + WithSign(h) * shift_.Rate(at.v);
    now.displaced -= cone;
    now.displaced_rate -= swept[h];
  }
  SetResistances(at, now);
  const double airway = AirwayPressure(at, now) - now.common * Flow(now);
  for (const size_t h : {kRight, kLeft}) {
    const double recoil = (scene_.pleural_pressure() - Recoil(now.volume[h])) / at.parameters.lung_compliance();
    now.pleural[h] = now.open[h] * (recoil - 2 * now.peripheral[h] * now.flow[h] + airway);
  }
  now.abdominal = AbdominalLoad(at) + AbdominalPressure(now.displaced) / at.parameters.abdominal_compliance() +
                  scene_.abdomen().resistance() * now.displaced_rate;
  return now;
}

void ThoraxPressures::AddForce(const EvalContext& at, MutablePoints f) const {
  const Slopes& slopes = SlopesAt(at);
  const Sides now = SidesAt(at, slopes);
  AddSlopes(now.abdominal - now.pleural[kRight], now.abdominal - now.pleural[kLeft], slopes, f);
  f.middleCols(sheet_.first_vertex, slopes.push.cols()) += slopes.push;
  AddToCage(now.pleural[kRight], 0, now.cage, at, f);
  AddToCage(0, now.pleural[kLeft], now.cage, at, f);
  const double shift = shift_.Value(at.x);
  shift_.AddForce(now.pleural[kRight] - now.pleural[kLeft] - shift / scene_.lungs().mediastinal_compliance() -
                      shift_damping_ * shift_.Rate(at.v),
                  f);
}

void ThoraxPressures::AddToCage(double right, double left, const CagePosition& k, const EvalContext& at,
                                MutablePoints f) const {
  const CageFunction &on_right = WallVolume(kRight), &on_left = WallVolume(kLeft);
  wall_->pump.AddForce(right * on_right.ByPump(k) + left * on_left.ByPump(k), f);
  wall_->bucket.AddForce(right * on_right.ByBucket(k) + left * on_left.ByBucket(k), f);
  std::array<double, kCageParts> parts = {};
  for (size_t i = 0; i < kCageParts; ++i) parts[i] = right * on_right.ByPart(k, i) + left * on_left.ByPart(k, i);
  wall_->AddPartForces(parts, at, f);
}

void ThoraxPressures::SetVolumeSlopes(double right, double left, const Slopes& slopes, const CagePosition& k,
                                      const EvalContext& at, Points& g) const {
  SetSlopesAlone(-right, -left, slopes, g);
  AddToCage(right, left, k, at, g);
  shift_.AddForce(right * WithSign(kRight) + left * WithSign(kLeft), g);
}

void ThoraxPressures::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const Slopes& slopes = SlopesAt(at);
  const Sides now = SidesAt(at, slopes);
  const v1::Parameters& parameters = at.parameters;
  Points g(3, at.x.cols());
  for (const size_t h : {kRight, kLeft}) {
    SetVolumeSlopes(h == kRight ? 1 : 0, h == kLeft ? 1 : 0, slopes, now.cage, at, g);
    sink.AddOuter(now.open[h] * RecoilSlope(now.volume[h]) / parameters.lung_compliance(), g);
  }
  SetSlopesAlone(1, 1, slopes, g);
  if (const double elastance = GasElastance(at); elastance > 0) {
    SetVolumeSlopes(now.open[kRight], now.open[kLeft], slopes, now.cage, at, g);
    sink.AddOuter(elastance, g);
    SetSlopesAlone(1, 1, slopes, g);
  }
  sink.AddOuter(AbdominalSlope(now.displaced) / parameters.abdominal_compliance(), g);
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  block(shift_.axis, shift_.axis) = 1 / (scene_.lungs().mediastinal_compliance() * shift_.scale * shift_.scale);
  sink.Add(shift_.vertex, shift_.vertex, block);
}

// The resistances of both lungs, sum of 2 o_h R_p,h v_h'^2 plus R_c (sum of o_h v_h')^2, as two squares.
void ThoraxPressures::AddSharedDamping(const EvalContext& at, OuterProducts& shared) const {
  const Slopes& slopes = SlopesAt(at);
  const Sides now = SidesAt(at, slopes);
  const auto add = [&](double scale) -> Points& {
    Points& g = shared.AddTerm(scale);
    g.resize(3, at.x.cols());
    return g;
  };
  const auto own = [&](size_t h) {
    return 2 * now.open[h] * now.peripheral[h] + now.common * now.open[h] * now.open[h];
  };
  const double right = own(kRight), both = now.common * now.open[kRight] * now.open[kLeft];
  if (right > 0) SetVolumeSlopes(1, both / right, slopes, now.cage, at, add(right));
  const double left = own(kLeft) - (right > 0 ? both * both / right : 0);
  if (left > 0) SetVolumeSlopes(0, 1, slopes, now.cage, at, add(left));
  if (scene_.abdomen().resistance() <= 0) return;
  Points& g = add(scene_.abdomen().resistance());
  SetSlopesAlone(1, 1, slopes, g);
}

double ThoraxPressures::EnergyOfGas(const EvalContext& at, const Sides& now) const {
  if (!at.airway_closed) return -AirwayPressure(at, now) * Volume(now);
  const double pressure = GasPressure(at, now);
  return pressure * pressure / (2 * GasElastance(at));
}

double ThoraxPressures::Energy(const EvalContext& at) const {
  const Sides now = SidesAt(at, SlopesAt(at));
  const double shift = shift_.Value(at.x);
  double energy = shift * shift / (2 * scene_.lungs().mediastinal_compliance());
  for (const size_t h : {kRight, kLeft}) {
    const double recoil = RecoilEnergy(now.volume[h]) - scene_.pleural_pressure() * now.volume[h];
    energy += now.open[h] * recoil / at.parameters.lung_compliance();
  }
  energy += EnergyOfGas(at, now);
  const double v = now.displaced;
  const double ratio = v / (v > 0 ? scene_.abdomen().stiffening_volume_out() : scene_.abdomen().stiffening_volume_in());
  const double compliance = scene_.abdomen().compliance() * at.parameters.abdominal_compliance();
  energy += v * v / (2 * compliance) * (1 + ratio * ratio / 2);
  return energy + AbdominalLoad(at) * v + EnergyOfWeight(at);
}

// The integral of the weight's pressure over the cones, with its sign reversed.
double ThoraxPressures::EnergyOfWeight(const EvalContext& at) const {
  const LinearField weight = Weight(at.parameters);
  const Eigen::Map<const Eigen::Vector3d> slope(weight.slope);
  if (slope.isZero()) return 0;
  const ConstPoints& x = at.x;
  double energy = 0;
  for (const auto& packets : sheet_.packets) {
    for (const TrianglePacket& packet : packets) {
      for (int lane = 0; lane < kPacketTriangles; ++lane) {
        const Eigen::Vector3d a = x.col(packet.a[lane] / 3), b = x.col(packet.b[lane] / 3),
                              c = x.col(packet.c[lane] / 3);
        const double cone = (a - wall_->apex).dot((b - a).cross(c - a)) / 6;
        energy -= cone * (slope.dot(wall_->apex + a + b + c) / 4 - weight.offset);
      }
    }
  }
  return energy;
}

std::span<const Force::Output> ThoraxPressures::outputs() const { return kThoraxOutputs; }

double ThoraxPressures::Read(size_t output, const EvalContext& at) const {
  const Sides now = SidesAt(at, SlopesAt(at));
  const double pleural = (now.pleural[kRight] + now.pleural[kLeft]) / 2;
  const double collapsed = kCollapsed * scene_.lungs().rest_volume() / 2;
  double volume = 0;
  switch (output) {
    case 0:
      for (const size_t h : {kRight, kLeft}) {
        const double aerated = scene_.lungs().rest_volume() / 2 + now.volume[h];
        volume += now.open[h] * aerated + (1 - now.open[h]) * collapsed;
      }
      return volume;
    case 1:
      return Flow(now);
    case 2:
      return now.pleural[kRight];
    case 3:
      return now.pleural[kLeft];
    case 4:
      return now.abdominal;
    case 5:
      return now.abdominal - pleural;
    case 6:
      return AirwayPressure(at, now) - now.common * Flow(now) -
             (now.peripheral[kRight] * now.flow[kRight] + now.peripheral[kLeft] * now.flow[kLeft]);
    case 7:
      return now.displaced;
    case 8:
      return now.volume[kRight] + at.parameters.pleural_fluid_right();
    default:
      return now.volume[kLeft] + at.parameters.pleural_fluid_left();
  }
}

}  // namespace phrenic
