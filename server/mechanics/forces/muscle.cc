#include "server/mechanics/forces/muscle.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/forces/muscle_layout.h"
#include "server/mechanics/forces/packed_points.h"
#include "server/mesh/harmonic.h"
#include "server/mesh/normals.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"

namespace phrenic {
namespace {

constexpr std::int64_t kBatchesPerPart = 16;                         // of one thread's share of the triangles
constexpr std::int64_t kSlicesPerPart = kVertexBlock / kGatherRows;  // and of the vertices

template <typename Number>
struct MuscleMemory {
  AlignedNumbers<Number> x, v, corners;
};

// The regions of the body that the element names.
struct MuscleRegions {
  std::vector<bool> from, tendon;
  std::vector<std::vector<bool>> passive;

  Tissue TissueOf(const Eigen::Vector3i& corner) const {
    const auto inside = [&corner](const std::vector<bool>& region) {
      return std::count_if(corner.begin(), corner.end(), [&](int v) { return region[v]; });
    };
    if (std::any_of(passive.begin(), passive.end(), [&](const auto& region) { return inside(region) == 3; })) {
      return Tissue::kPassive;
    }
    return inside(tendon) >= 2 ? Tissue::kTendon : Tissue::kMuscle;
  }
};

absl::StatusOr<MuscleRegions> FindRegions(const v1::Muscle& scene, int body, const std::string& path,
                                          const ModelBuilder& builder) {
  MuscleRegions regions;
  auto from = builder.Region(body, scene.from_region(), path + ".from_region");
  if (!from.ok()) return from.status();
  auto tendon = builder.Region(body, scene.tendon_region(), path + ".tendon_region");
  if (!tendon.ok()) return tendon.status();
  for (int i = 0; i < scene.passive_regions_size(); ++i) {
    auto passive = builder.Region(body, scene.passive_regions(i), absl::StrCat(path, ".passive_regions[", i, "]"));
    if (!passive.ok()) return passive.status();
    regions.passive.push_back(*std::move(passive));
  }
  regions.from = *std::move(from), regions.tendon = *std::move(tendon);
  return regions;
}

// INVALID_ARGUMENT if a part of the surface has no vertex of the region that the fibres start from and none that is
// fixed.
absl::Status CheckHeld(const BodyModel& body, const std::vector<bool>& from, const Eigen::VectorXd& inverse_mass,
                       const v1::Muscle& scene, const std::string& path) {
  const Mesh& mesh = body.mesh;
  for (const std::vector<int>& part : Components(mesh)) {
    const bool held = std::any_of(part.begin(), part.end(), [&](int t) {
      const auto corners = mesh.triangles.col(t);
      return std::any_of(corners.begin(), corners.end(),
                         [&](int v) { return from[v] || inverse_mass[body.first_vertex + v] == 0; });
    });
    if (held) continue;
    const Eigen::Vector3d at = kMillimetresAMetre * mesh.vertices.col(mesh.triangles(0, part.front()));
    return FieldError(
        path, absl::StrFormat("nothing holds a part of %d triangles at %.0f, %.0f, %.0f mm: it has no vertex of "
                              "the region \"%s\" and none that is fixed; join or remove it (phrenic convert "
                              "--repair cuts,crumbs)",
                              part.size(), at.x(), at.y(), at.z(), scene.from_region()));
  }
  return absl::OkStatus();
}

void SetRestingTensions(const v1::Muscle& scene, MuscleTriangle& triangle) {
  const bool tendon = triangle.tissue == Tissue::kTendon;
  triangle.resting_across = tendon ? scene.tendon_tension() : scene.resting_tension_across();
  triangle.resting_along = triangle.tissue == Tissue::kMuscle ? scene.resting_tension() : triangle.resting_across;
}

// Returns the triangles with area, and the bundles of those that are muscle.
std::vector<MuscleTriangle> MakeTriangles(const v1::Muscle& scene, const BodyModel& body, const Points& rest,
                                          const MuscleRegions& regions, const Eigen::VectorXd& height,
                                          FibreBundles& bundles) {
  const Triangles& corners = body.mesh.triangles;
  std::vector<bool> muscle;
  for (const auto& corner : corners.colwise()) muscle.push_back(regions.TissueOf(corner) == Tissue::kMuscle);
  bundles = MakeFibreBundles(body.mesh, height, muscle);
  std::vector<MuscleTriangle> triangles;
  for (Eigen::Index t = 0; t < corners.cols(); ++t) {
    const Eigen::Vector3i corner = corners.col(t);
    const Eigen::Vector3d heights(height[corner[0]], height[corner[1]], height[corner[2]]);
    MuscleTriangle triangle = MakeMuscleTriangle(rest, corner.array() + body.first_vertex, heights);
    if (triangle.area == 0) continue;
    triangle.tissue = regions.TissueOf(corner);
    triangle.bundle = std::max(0, bundles.of_triangle[t]);
    SetRestingTensions(scene, triangle);
    triangles.push_back(triangle);
  }
  return triangles;
}

std::string Describe(const v1::Muscle& scene) {
  return absl::StrFormat("%g Pa active, %g mm, %s precision%s", scene.active_stress(), 1e3 * scene.thickness(),
                         scene.precision() == v1::PRECISION_DOUBLE ? "double" : "single",
                         scene.balanced_at_rest() ? ", balanced at rest" : "");
}

// Returns the vertex nearest to the centre.
int CentralVertex(const Points& rest, const VertexRange& vertices) {
  const auto body = rest.middleCols(vertices.first, vertices.end - vertices.first);
  const Eigen::Vector3d centre = body.rowwise().mean();
  Eigen::Index nearest = 0;
  (body.colwise() - centre).colwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(vertices.first + nearest);
}

// The activation of one side that the nerve asks for. Requires: at.parameters has every field.
double DriveOf(const EvalContext& at, bool right) {
  const v1::Parameters& parameters = at.parameters;
  if (!parameters.apply_muscles()) return 0;
  const double side = right ? parameters.right_activation() : parameters.left_activation();
  return parameters.diaphragm_activation() * parameters.breath_force() * std::max(0.0, at.breath) * side;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> Muscle::Make(const v1::Muscle& scene, const std::string& given,
                                                    std::string_view where, ModelBuilder& builder) {
  const std::string path(where);
  Names names;
  *names.Add() = scene.body();
  const std::string name = ElementName(given, "muscle", names);
  const auto bodies = builder.DeformableBodies(names, path + ".body");
  if (!bodies.ok()) return bodies.status();
  if (bodies->size() != 1) return FieldError(path + ".body", "names several bodies; a muscle is one: name each alone");
  const BodyModel& body = builder.model.bodies[bodies->front()];
  const auto regions = FindRegions(scene, bodies->front(), path, builder);
  if (!regions.ok()) return regions.status();
  const Eigen::VectorXd& inverse_mass = builder.model.inverse_mass;
  if (absl::Status held = CheckHeld(body, regions->from, inverse_mass, scene, path); !held.ok()) return held;
  const auto height = HarmonicBetween(body.mesh, regions->from, regions->tendon);
  if (!height.ok()) return FieldError(path, std::string(height.status().message()));
  std::unique_ptr<Muscle> muscle(new Muscle(name, scene, body));
  muscle->triangles_ = MakeTriangles(scene, body, builder.model.rest, *regions, *height, muscle->bundles_);
  if (muscle->triangles_.empty()) {
    builder.ReportLeftOut(name, "its body has no triangle with area");
    return nullptr;
  }
  muscle->origin_ = CentralVertex(builder.model.rest, muscle->vertices_);
  muscle->LayOut();
  const auto count = static_cast<std::int64_t>(muscle->triangles_.size());
  builder.ReportElement("force", name, count, "triangles", Describe(scene));
  if (muscle->activation_time_ > 0) {
    muscle->first_activation_ = builder.AddInternalScalars(name + ":activation", "1", 2);
  }
  if (muscle->hill_.active()) {
    muscle->first_rate_ = builder.AddInternalScalars(name + ":stretch-rate", "1/s", FibreBundles::kCount);
  }
  return muscle;
}

Muscle::Muscle(std::string name, const v1::Muscle& scene, const BodyModel& body)
    : Force(std::move(name)),
      law_(MakeMuscleLaw(scene)),
      hill_(MakeHillLaw(scene)),
      rate_time_(scene.rate_time()),
      activation_time_(scene.activation_time()),
      greatest_resting_tension_(scene.greatest_resting_tension()),
      balances_(scene.balanced_at_rest()),
      single_(scene.precision() != v1::PRECISION_DOUBLE),
      vertices_{body.first_vertex, body.first_vertex + body.mesh.vertices.cols()} {}

void Muscle::LayOut() {
  if (single_) {
    layout_ = MakeMuscleLayout<float>(triangles_, FibreBundles::kCount, vertices_);
  } else {
    layout_ = MakeMuscleLayout<double>(triangles_, FibreBundles::kCount, vertices_);
  }
}

double Muscle::ActivationOf(const EvalContext& at, bool right) const {
  return first_activation_ < 0 ? DriveOf(at, right) : at.scalars.q[first_activation_ + (right ? 0 : 1)];
}

Muscle::Tensions Muscle::ActiveTensions(const EvalContext& at) const {
  Tensions active;
  active.fill(1);
  if (hill_.active()) {
    for (int b = 0; b < FibreBundles::kCount; ++b) active[b] = hill_.At(at.scalars.q[first_rate_ + b]);
    bundles_.Smooth(active);
  }
  const double greatest = law_.active * at.parameters.muscle_strength();
  const double right = greatest * ActivationOf(at, true), left = greatest * ActivationOf(at, false);
  for (int b = 0; b < FibreBundles::kCount; ++b) active[b] *= FibreBundles::OnRight(b) ? right : left;
  return active;
}

template <>
MusclePoints<double> Muscle::PointsFor(const EvalContext& at) const {
  return {at.x.data(), at.v.data()};
}

template <>
MusclePoints<float> Muscle::PointsFor(const EvalContext& at) const {
  auto& memory = at.scratch.Get<MuscleMemory<float>>();
  float* const x = memory.x.Fit(kPointStride<float> * at.x.cols());
  float* const v = memory.v.Fit(kPointStride<float> * at.x.cols());
  static constexpr double kZero[3] = {};
  ForEachBlock(vertices_, [&](const VertexRange& block) {
    PackPoints(block, at.x.data(), at.x.col(origin_).data(), x);
    PackPoints(block, at.v.data(), kZero, v);
  });
  return {x, v};
}

template <typename Number>
void Muscle::AddForceIn(const MuscleLayout<Number>& layout, const EvalContext& at, MutablePoints f) const {
  const MusclePoints<Number> points = PointsFor<Number>(at);
  const auto batches = static_cast<std::int64_t>(layout.batches.size());
  auto& memory = at.scratch.Get<MuscleMemory<Number>>();
  Number* const corners = memory.corners.Fit(batches * kCornerNumbers<Number> + 4);
  std::fill_n(corners + layout.corners.zero, 4, Number{0});
  const MuscleLaw law = law_.Scaled(at.parameters.elasticity());
  const Tensions active = ActiveTensions(at);
  ParallelFor((batches + kBatchesPerPart - 1) / kBatchesPerPart, [&](std::int64_t part) {
    const std::int64_t first = part * kBatchesPerPart;
    SetCornerForces(layout, first, std::min(first + kBatchesPerPart, batches), law, active.data(), points, corners);
  });
  const double* const load = rest_load_.cols() > 0 ? LoadIn(at.parameters.posture()).data() : nullptr;
  const auto slices = static_cast<std::int64_t>(layout.corners.first.size()) - 1;
  ParallelFor((slices + kSlicesPerPart - 1) / kSlicesPerPart, [&](std::int64_t part) {
    const std::int64_t first = part * kSlicesPerPart;
    GatherCorners(layout.corners, first, std::min(first + kSlicesPerPart, slices), corners, load,
                  f.col(vertices_.first).data());
  });
}

void Muscle::AddForce(const EvalContext& at, MutablePoints f) const {
  std::visit([&](const auto& layout) { AddForceIn(layout, at, f); }, layout_);
}

void Muscle::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const MuscleLaw law = law_.Scaled(at.parameters.elasticity());
  const Tensions active = ActiveTensions(at);
  for (const MuscleTriangle& triangle : triangles_) {
    AddStiffnessOf(triangle, law, active[triangle.bundle], at.x, sink);
  }
}

void Muscle::AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const {
  if (!at.parameters.apply_muscles()) return;
  const double full = law_.active * std::max(1.0, at.parameters.diaphragm_activation());
  const Tensions active = ActiveTensions(at);
  for (const MuscleTriangle& triangle : triangles_) {
    AddActiveStiffnessOf(triangle, std::max(0.0, full - active[triangle.bundle]), at.x, sink);
  }
}

void Muscle::AddViscosity(const EvalContext& at, StiffnessSink& blocks) const {
  for (const MuscleTriangle& triangle : triangles_) AddViscosityOf(triangle, law_, at.x, blocks);
}

double Muscle::Energy(const EvalContext& at) const {
  const MuscleLaw law = law_.Scaled(at.parameters.elasticity());
  const Tensions active = ActiveTensions(at);
  double energy = 0;
  for (const MuscleTriangle& triangle : triangles_) energy += EnergyOf(triangle, law, active[triangle.bundle], at.x);
  if (rest_load_.cols() > 0) {
    const Points& load = LoadIn(at.parameters.posture());
    energy -= load.cwiseProduct(at.x.middleCols(vertices_.first, load.cols())).sum();
  }
  return energy;
}

absl::Status Muscle::BalanceAtRest(const ConstPoints& load, const ConstPoints& normals, ModelBuilder& builder,
                                   Eigen::VectorXd& pushes) {
  const Model& model = builder.model;
  const Eigen::Index n = vertices_.end - vertices_.first;
  const BodyModel& body = model.BodyOf(static_cast<int>(vertices_.first));
  RestingLoad resting{.first = static_cast<int>(vertices_.first),
                      .load = load.middleCols(vertices_.first, n),
                      .normals = normals.middleCols(vertices_.first, n),
                      .area = VertexAreas(body.mesh.vertices, body.mesh.triangles),
                      .free = {}};
  for (Eigen::Index i = vertices_.first; i < vertices_.end; ++i) resting.free.push_back(model.inverse_mass[i] > 0);
  const PrestressReport report = ChoosePrestress(resting, greatest_resting_tension_, builder.stop, triangles_);
  LayOut();
  rest_load_ = LoadThatIsLeft(model, resting, report);
  SetPosturalLoads(model);
  pushes.segment(vertices_.first, n) += resting.area.cwiseProduct(report.contact);
  builder.ReportElement(
      "prestress", name(), static_cast<std::int64_t>(triangles_.size()), "triangles",
      absl::StrFormat("mean of muscle %.3g N/m along, %.3g N/m across; %.3g Pa left to a constant load; %d iterations",
                      report.along, report.across, rest_load_.colwise().norm().sum() / resting.area.sum(),
                      report.iterations));
  return absl::OkStatus();
}

void Muscle::SetPosturalLoads(const Model& model) {
  for (const v1::Force& force : model.scene.forces()) {
    const v1::Vector& weight = force.thorax_pressures().abdomen().weight();
    const Eigen::Vector3d supine = Eigen::Vector3d(weight.x(), weight.y(), weight.z());
    if (!(supine.norm() > 0)) continue;
    const Eigen::Vector3d down = DownIn(model.parameters.posture(), supine.normalized());
    const Eigen::RowVectorXd along = down.transpose() * rest_load_;
    for (size_t i = 0; i < kPostures.size(); ++i) {
      const double lost = 1 - down.dot(DownIn(kPostures[i], supine.normalized()));
      if (lost > 1e-9) postural_loads_[i] = rest_load_ - lost * down * along;
    }
  }
}

const Points& Muscle::LoadIn(v1::Posture posture) const {
  for (size_t i = 0; i < kPostures.size(); ++i) {
    if (kPostures[i] == posture && postural_loads_[i].cols() > 0) return postural_loads_[i];
  }
  return rest_load_;
}

// Returns what tensions and contacts leave of the load on the vertices that move, with its sign reversed.
Points Muscle::LoadThatIsLeft(const Model& model, const RestingLoad& resting, const PrestressReport& report) const {
  const State rest = model.InitialState();
  v1::Parameters passive = model.parameters;
  passive.set_apply_muscles(false);
  Points own = Points::Zero(3, model.rest.cols());
  AddForce(MakeEvalContext(model, passive, rest), own);
  Points left = -(own.middleCols(vertices_.first, resting.load.cols()) + resting.load);
  for (Eigen::Index i = 0; i < left.cols(); ++i) {
    left.col(i) += resting.area[i] * report.contact[i] * resting.normals.col(i);
    if (!resting.free[i]) left.col(i).setZero();
  }
  return left;
}

std::span<const Force::Output> Muscle::outputs() const {
  static constexpr Output kOutputs[] = {{"stretch", "1"}, {"thickening", "1"}};
  return kOutputs;
}

double Muscle::Read(size_t output, const EvalContext& at) const {
  double sum = 0, area = 0;
  for (const MuscleTriangle& triangle : triangles_) {
    if (triangle.tissue != Tissue::kMuscle) continue;
    const Stretches stretches = StretchesOf(triangle, at.x);
    sum += triangle.area * (output == 0 ? stretches.along : 1 / (stretches.along * stretches.across));
    area += triangle.area;
  }
  return area > 0 ? sum / area : 1;
}

template <typename Number>
Muscle::Tensions Muscle::MeanRatesIn(const MuscleLayout<Number>& layout, const EvalContext& at) const {
  const MusclePoints<Number> points = PointsFor<Number>(at);
  Tensions rates{};
  ParallelFor(FibreBundles::kCount, [&](std::int64_t bundle) {
    const double area = bundles_.area[bundle];
    if (area > 0) rates[bundle] = SumStretchRates(layout, static_cast<int>(bundle), points) / area;
  });
  return rates;
}

// Rates are computed in every step: force-velocity that follows them some steps late feeds the fastest modes.
void Muscle::AdvanceScalars(const EvalContext& end, std::int64_t, double dt, ScalarState& scalars) const {
  if (first_activation_ >= 0) {
    const double share = dt / (activation_time_ + dt);  // implicit: stable at any step
    for (const bool right : {true, false}) {
      double& activation = scalars.q[first_activation_ + (right ? 0 : 1)];
      activation += share * (DriveOf(end, right) - activation);
    }
  }
  if (!hill_.active()) return;
  const Tensions rates = std::visit([&](const auto& layout) { return MeanRatesIn(layout, end); }, layout_);
  const double share = rate_time_ > 0 ? dt / (rate_time_ + dt) : 1;  // implicit: stable at any step
  for (int b = 0; b < FibreBundles::kCount; ++b) {
    double& rate = scalars.q[first_rate_ + b];
    rate += share * (rates[b] - rate);
  }
}

void Muscle::SetScalarRates(const EvalContext& at, Eigen::VectorXd& rates) const {
  for (int side = 0; side < 2 && first_activation_ >= 0; ++side) {
    const int activation = first_activation_ + side;
    rates[activation] = (DriveOf(at, side == 0) - at.scalars.q[activation]) / activation_time_;
  }
  if (!hill_.active() || rate_time_ == 0) return;
  const Tensions means = std::visit([&](const auto& layout) { return MeanRatesIn(layout, at); }, layout_);
  for (int b = 0; b < FibreBundles::kCount; ++b) {
    rates[first_rate_ + b] = (means[b] - at.scalars.q[first_rate_ + b]) / rate_time_;
  }
}

}  // namespace phrenic
