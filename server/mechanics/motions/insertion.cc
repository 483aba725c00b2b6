#include "server/mechanics/motions/insertion.h"

#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/motions/ribs.h"
#include "server/mechanics/skinning/body_points.h"

namespace phrenic {
namespace {

constexpr double kNoDeparture = 1e-9;  // what is left of a part that has come back

// The coordinates of a free cage.
struct CageCoordinates {
  Coordinate pump, bucket;
  std::array<std::optional<Coordinate>, kCageParts> parts;
};

// Returns the positions of a body's vertices with the cage at `k`, by the motions that the scene has so far.
Points PlaceAt(const Model& model, int body, const CageCoordinates& cage, const CagePosition& k) {
  State state = model.InitialState();
  const auto set = [&state](const Coordinate& c, double value) { state.x(c.axis, c.vertex) = c.scale * value; };
  set(cage.pump, k.pump);
  set(cage.bucket, k.bucket);
  for (size_t i = 0; i < kCageParts; ++i) {
    if (cage.parts[i]) set(*cage.parts[i], k.parts[i]);
  }
  const EvalContext at = MakeEvalContext(model, model.parameters, state);
  for (const auto& motion : model.motions) motion->Drive(at, state);
  Points placed(3, model.bodies[body].mesh.vertices.cols());
  PlaceBody(model, state, body, placed);
  return placed;
}

absl::StatusOr<std::shared_ptr<CageWall>> MakeWall(int body, std::string_view path, const ModelBuilder& builder) {
  const auto pump = builder.FindCoordinate(kPumpHandle, path), bucket = builder.FindCoordinate(kBucketHandle, path);
  if (!pump.ok()) return pump.status();
  if (!bucket.ok()) return bucket.status();
  const BodyModel& grid = builder.model.bodies[body];
  if (grid.skin < 0) {
    return FieldError(path, absl::StrCat("body \"", grid.name, "\" does not follow the bones: give it a skin before"));
  }
  CageCoordinates cage = {*pump, *bucket, {}};
  const auto place = [&](const CagePosition& k) { return PlaceAt(builder.model, body, cage, k); };
  std::vector<Points> moved;
  for (const CagePosition& k : CageFit::Positions()) moved.push_back(place(k));
  InnerWall::AllPartGrids grids;
  for (size_t i = 0; i < kCageParts; ++i) {
    const auto part = builder.FindCoordinate(kCagePartNames[i], path);
    if (!part.ok()) continue;
    cage.parts[i] = *part;
    for (const CagePosition& k : CageFit::PositionsOf(static_cast<CagePart>(i))) {
      grids[i].departed.push_back(place(k));
      grids[i].shared.push_back(place({k.pump, k.bucket}));
    }
  }
  auto wall = InnerWall::Make(place({}), moved, grids);
  if (!wall.ok()) {
    return FieldError(path, absl::StrCat("body \"", grid.name, "\" ", std::string(wall.status().message())));
  }
  auto made = std::make_shared<CageWall>(CageWall{body, *pump, *bucket, *std::move(wall)});
  made->parts = cage.parts;
  return made;
}

// Returns the longest border of a body, in the order of its triangles' edges; empty if it is closed.
std::vector<int> LongestBorder(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> edges;  // directed, and how often
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) ++edges[{mesh.triangles(k, t), mesh.triangles((k + 1) % 3, t)}];
  }
  std::map<int, int> next;
  for (const auto& [edge, count] : edges) {
    if (edges.count({edge.second, edge.first}) == 0) next[edge.first] = edge.second;
  }
  std::vector<int> longest;
  while (!next.empty()) {
    std::vector<int> loop;
    for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
      loop.push_back(at->second);
      next.erase(at);
    }
    if (loop.size() > longest.size()) longest = std::move(loop);
  }
  return longest;
}

// Measures the volume above the border of the body.
absl::Status AddVolumes(const BodyModel& body, const v1::Insertion& scene, std::string_view path, CageWall& wall) {
  std::vector<Eigen::Vector3d> loop;
  for (const int i : LongestBorder(body.mesh)) {
    wall.border.push_back(body.first_vertex + i);
    loop.emplace_back(body.mesh.vertices.col(i));
  }
  if (loop.empty()) return FieldError(path, absl::StrCat("body \"", body.name, "\" has no border to insert"));
  wall.apex = ToEigen(scene.apex());
  wall.volumes = wall.wall.VolumesAbove(loop, wall.apex);
  return absl::OkStatus();
}

void DriveVertex(int vertex, Model& model) {
  if (model.inverse_mass[vertex] == 0) return;
  model.inverse_mass[vertex] = 0;
  model.driven_vertices.push_back(vertex);
}

struct LastWallTable {
  const CageWall* of = nullptr;  // null: of none
  CagePosition k;
  MovingParts moving = {};
  WallTable table;
};

// True if a live parameter lets the part move.
bool IsReleased(size_t part, const v1::Parameters& p) {
  if (part == kRightSegment) return p.flail_right() > 0;
  if (part == kLeftSegment) return p.flail_left() > 0;
  return p.cage_tilt() != 0 || p.right_intercostals() != 1 || p.left_intercostals() != 1 ||
         p.right_cage_compliance() != 1 || p.left_cage_compliance() != 1;
}

}  // namespace

bool CageWall::Moves(size_t part, const EvalContext& at) const {
  return parts[part].has_value() && (at.releases_all || IsReleased(part, at.parameters));
}

MovingParts CageWall::Moving(const EvalContext& at) const {
  MovingParts moving = {};
  for (size_t i = 0; i < kCageParts; ++i) moving[i] = Moves(i, at);
  return moving;
}

const WallTable& CageWall::TableAt(const EvalContext& at) const {
  LastWallTable& last = at.scratch.Get<LastWallTable>();
  const CagePosition k = Position(at);
  const MovingParts moving = Moving(at);
  const bool same = last.of == this && last.moving == moving && last.k.SameBits(k);
  if (!same) wall.Evaluate(k, moving, last.table);
  last.of = this;
  last.k = k;
  last.moving = moving;
  return last.table;
}

CagePosition CageWall::Position(const EvalContext& at) const {
  CagePosition k = {pump.Value(at.x), bucket.Value(at.x)};
  for (size_t i = 0; i < kCageParts; ++i) {
    if (parts[i]) k.parts[i] = parts[i]->Value(at.x);
    if (std::abs(k.parts[i]) < kNoDeparture && !Moves(i, at)) k.parts[i] = 0;
  }
  return k;
}

CagePosition CageWall::Rate(const EvalContext& at) const {
  CagePosition rate = {pump.Rate(at.v), bucket.Rate(at.v)};
  for (size_t i = 0; i < kCageParts; ++i) {
    if (parts[i]) rate.parts[i] = parts[i]->Rate(at.v);
  }
  return rate;
}

void CageWall::AddPartForces(const std::array<double, kCageParts>& force, const EvalContext& at,
                             MutablePoints f) const {
  for (size_t i = 0; i < kCageParts; ++i) {
    if (Moves(i, at)) parts[i]->AddForce(force[i], f);
  }
}

absl::StatusOr<std::unique_ptr<Motion>> Insertion::Make(const v1::Insertion& scene, const std::string& given,
                                                        std::string_view path, ModelBuilder& builder) {
  const std::string field(path);
  const auto body = builder.Body(scene.body(), field + ".body");
  if (!body.ok()) return body.status();
  Names named;
  *named.Add() = scene.body();
  if (const auto deformable = builder.DeformableBodies(named, field + ".body"); !deformable.ok()) {
    return deformable.status();
  }
  const auto grid = builder.Body(scene.wall(), field + ".wall");
  if (!grid.ok()) return grid.status();
  auto wall = MakeWall(*grid, field + ".wall", builder);
  if (!wall.ok()) return wall.status();
  const BodyModel& sheet = builder.model.bodies[*body];
  if (absl::Status status = AddVolumes(sheet, scene, field + ".body", **wall); !status.ok()) return status;
  const auto vertices = builder.FreeVertices(*body, scene.region(), {}, path);
  if (!vertices.ok()) return vertices.status();
  std::unique_ptr<Insertion> motion(new Insertion(ElementName(given, "insertion", named), *std::move(wall)));
  for (const int vertex : *vertices) {
    const Eigen::Vector3d rest = builder.model.rest.col(vertex);
    motion->inserted_.push_back({vertex, rest, motion->wall_->wall.Follow(rest)});
    DriveVertex(vertex, builder.model);
  }
  builder.ReportElement("motion", motion->name(), static_cast<std::int64_t>(motion->inserted_.size()), "vertices",
                        absl::StrCat("follow ", scene.wall()));
  return motion;
}

struct Insertion::Paths {
  const Insertion* of = nullptr;  // null: of none
  CagePosition shared;
  Points x, by_pump, by_bucket;  // 3 x the inserted vertices [m]
};

// A step asks for those at its start, for each vector of forces that it transfers, and for those at its end.
const Insertion::Paths& Insertion::PathsAt(const CagePosition& shared, const Scratch& scratch) const {
  Paths& paths = scratch.Get<Paths>();
  if (paths.of == this && paths.shared.SameBits(shared)) return paths;
  for (Points* points : {&paths.x, &paths.by_pump, &paths.by_bucket}) points->resize(3, std::ssize(inserted_));
  Eigen::Index i = 0;
  for (const Inserted& each : inserted_) {
    const CagePosition k = shared.Of(each.path.weight);
    for (int axis = 0; axis < 3; ++axis) {
      const CageQuadratic& shift = each.path.shift[axis];
      paths.x(axis, i) = each.rest[axis] + shift.At(k);
      paths.by_pump(axis, i) = shift.ByPump(k);
      paths.by_bucket(axis, i) = shift.ByBucket(k);
    }
    ++i;
  }
  paths.shared = shared;
  paths.of = this;
  return paths;
}

void Insertion::Drive(const EvalContext& at, State& state) const {
  const CagePosition shared_rate = wall_->Rate(at);
  const Paths& paths = PathsAt(wall_->Position(at), at.scratch);
  Eigen::Index i = 0;
  for (const Inserted& each : inserted_) {
    const CagePosition rate = shared_rate.Of(each.path.weight);
    state.x.col(each.vertex) = paths.x.col(i);
    state.v.col(each.vertex) = paths.by_pump.col(i) * rate.pump + paths.by_bucket.col(i) * rate.bucket;
    ++i;
  }
}

void Insertion::TransferForces(const EvalContext& at, MutablePoints f) const {
  const Paths& paths = PathsAt(wall_->Position(at), at.scratch);
  const bool moves = wall_->Moving(at) != MovingParts{};
  double pump = 0, bucket = 0;
  std::array<double, kCageParts> parts = {};
  Eigen::Index i = 0;
  for (const Inserted& each : inserted_) {
    for (int axis = 0; axis < 3; ++axis) {
      const double by_pump = f(axis, each.vertex) * paths.by_pump(axis, i);
      const double by_bucket = f(axis, each.vertex) * paths.by_bucket(axis, i);
      pump += by_pump, bucket += by_bucket;
      if (!moves) continue;
      for (size_t part = 0; part < kCageParts; ++part) parts[part] += each.path.weight[part] * (by_pump + by_bucket);
    }
    ++i;
  }
  wall_->pump.AddForce(pump, f);
  wall_->bucket.AddForce(bucket, f);
  wall_->AddPartForces(parts, at, f);
}

absl::StatusOr<std::shared_ptr<const CageWall>> FindCageWall(const std::string& body, std::string_view path,
                                                             const ModelBuilder& builder) {
  for (const auto& motion : builder.model.motions) {
    const auto* const insertion = dynamic_cast<const Insertion*>(motion.get());
    if (insertion != nullptr && builder.model.bodies[insertion->wall()->body].name == body) return insertion->wall();
  }
  return FieldError(path, absl::StrCat("no insertion of the scene names the wall \"", body,
                                       "\": add motions { insertion { ... wall: \"", body, "\" } }"));
}

}  // namespace phrenic
