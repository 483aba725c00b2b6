#include "server/compare/comparison.h"

#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/compare/domes.h"
#include "server/compare/doubts.h"
#include "server/compare/moments.h"
#include "server/compare/surface_distance.h"
#include "server/mesh/units.h"
#include "server/record/distance_map.h"

namespace phrenic::compare {
namespace {

Triangles TrianglesOf(const Mesh& mesh, const std::string& region) {
  const auto found = mesh.regions.find(region);
  std::vector<bool> inside(static_cast<std::size_t>(mesh.vertices.cols()), false);
  if (found != mesh.regions.end()) {
    for (const int vertex : found->second) inside[static_cast<std::size_t>(vertex)] = true;
  }
  Triangles triangles(3, mesh.triangles.cols());
  Eigen::Index count = 0;
  for (const auto triangle : mesh.triangles.colwise()) {
    if (inside[triangle[0]] && inside[triangle[1]] && inside[triangle[2]]) triangles.col(count++) = triangle;
  }
  triangles.conservativeResize(3, count);
  return triangles;
}

bool WantsVertices(const v1::CompareRequest& request) {
  return request.vertex_distances() || !request.map_format().empty();
}

// The whole surfaces or one region of them, with the measured distances, one per moment.
struct ComparedPart {
  std::string region;
  MeasuredSurface a, b, rest;  // `rest` is A at its first time
  std::vector<v1::SurfaceDistance> distances, baselines;
};

class Comparer {
 public:
  Comparer(const v1::CompareRequest& request, ComparedPair pair, MatchedMoments moments, const ComparisonSink& sink)
      : request_(request), compared_(std::move(pair)), moments_(std::move(moments)), sink_(sink) {
    options_.tolerance = kMillimetre * (request.has_tolerance_mm() ? request.tolerance_mm() : 1);
    if (request.has_spacing_mm()) options_.spacing = kMillimetre * request.spacing_mm();
    AddPart("", a_.mesh.triangles, b_.mesh.triangles);
    if (!request.by_region()) return;
    std::set<std::string> names;
    for (const auto& [name, vertices] : a_.mesh.regions) names.insert(name);
    for (const auto& [name, vertices] : b_.mesh.regions) names.insert(name);
    for (const std::string& name : names) AddPart(name, TrianglesOf(a_.mesh, name), TrianglesOf(b_.mesh, name));
  }

  absl::Status Measure() {
    const auto total = static_cast<double>(moments_.pairs.size() * parts_.size());
    double done = 0;
    if (absl::Status status = SendMesh(); !status.ok()) return status;
    for (const Moment& moment : moments_.pairs) {
      const Points a = PositionsAt(a_, moment.a), b = PositionsAt(b_, moment.b);
      for (ComparedPart& part : parts_) {
        if (!sink_.progress(done++ / total)) return absl::CancelledError("the comparison was cancelled");
        part.a.MoveTo(a);
        part.b.MoveTo(b);
        if (absl::Status status = MeasurePart(part, moment); !status.ok()) return status;
      }
      const ComparedPart& whole = parts_.front();
      if (doubts_.empty()) doubts_ = Doubts(whole.a, whole.b, kMillimetre * whole.distances.back().assd());
    }
    return absl::OkStatus();
  }

  v1::ComparisonTable Table() const {
    v1::ComparisonTable table;
    table.set_definition(kDefinition);
    table.set_a(compared_.a.name);
    table.set_b(compared_.b.name);
    if (compared_.a.state) *table.mutable_state_a() = *compared_.a.state;
    if (compared_.b.state) *table.mutable_state_b() = *compared_.b.state;
    table.set_tolerance_mm(options_.tolerance / kMillimetre);
    table.set_times_left_out(moments_.left_out);
    table.mutable_warnings()->Assign(doubts_.begin(), doubts_.end());
    for (const ComparedPart& part : parts_) AddRow(part.region, OverTimes(part.distances), part.baselines, table);
    for (std::size_t m = 0; m < moments_.pairs.size(); ++m) {
      if (!moments_.pairs[m].time) break;
      for (const ComparedPart& part : parts_) {
        AddRow(part.region, part.distances[m], {}, table);
        table.mutable_rows()->rbegin()->set_time(*moments_.pairs[m].time);
        if (a_.moves()) *table.mutable_rows()->rbegin()->mutable_baseline() = part.baselines[m];
      }
    }
    return table;
  }

  // Has only the vertices that a triangle uses: the others have no distance.
  record::DistanceMap Map() const {
    const MeasuredSurface& whole = parts_.front().rest;
    std::vector<int> index(static_cast<std::size_t>(whole.vertices().cols()), -1);
    for (std::size_t i = 0; i < whole.used().size(); ++i) index[whole.used()[i]] = static_cast<int>(i);
    record::DistanceMap map;
    map.surface.vertices = whole.vertices()(Eigen::all, whole.used());
    map.surface.triangles = whole.triangles().unaryExpr([&](int vertex) { return index[vertex]; });
    for (std::size_t m = 0; m < moments_.pairs.size(); ++m) {
      map.times.push_back(moments_.pairs[m].time.value_or(0));
      map.distances.emplace_back(at_vertices_[m](whole.used()));
    }
    return map;
  }

 private:
  void AddPart(const std::string& name, const Triangles& of_a, const Triangles& of_b) {
    const Points a = PositionsAt(a_, {}), b = PositionsAt(b_, {});
    parts_.push_back({name, MeasuredSurface(a, of_a), MeasuredSurface(b, of_b), MeasuredSurface(a, of_a), {}, {}});
  }

  absl::Status MeasurePart(ComparedPart& part, const Moment& moment) {
    const bool wants_vertices = part.region.empty() && WantsVertices(request_);
    Eigen::VectorXd at_vertices;
    auto distance = MeasureDistance(part.a, part.b, options_, wants_vertices ? &at_vertices : nullptr);
    if (!distance.ok()) return distance.status();
    part.distances.push_back(*std::move(distance));
    if (wants_vertices) {
      if (absl::Status status = SendVertices(at_vertices, moment); !status.ok()) return status;
      if (!request_.map_format().empty()) at_vertices_.push_back(std::move(at_vertices));
    }
    if (!a_.moves()) return absl::OkStatus();
    auto baseline = MeasureDistance(part.rest, part.b, options_);
    if (!baseline.ok()) return baseline.status();
    part.baselines.push_back(*std::move(baseline));
    return absl::OkStatus();
  }

  absl::Status SendVertices(const Eigen::VectorXd& at_vertices, const Moment& moment) const {
    if (!request_.vertex_distances()) return absl::OkStatus();
    v1::VertexDistances vertices;
    if (moment.time) vertices.set_time(*moment.time);
    vertices.mutable_distances()->Reserve(static_cast<int>(at_vertices.size()));
    for (const double distance : at_vertices) vertices.add_distances(static_cast<float>(distance / kMillimetre));
    return sink_.vertices(vertices);
  }

  absl::Status SendMesh() const {
    if (!request_.mesh_of_b() || moments_.pairs.empty()) return absl::OkStatus();
    return sink_.mesh(PositionsAt(b_, moments_.pairs.front().b), b_.mesh.triangles);
  }

  static void AddRow(const std::string& region, const v1::SurfaceDistance& distance,
                     const std::vector<v1::SurfaceDistance>& baselines, v1::ComparisonTable& table) {
    v1::ComparisonRow& row = *table.add_rows();
    row.set_region(region);
    *row.mutable_distance() = distance;
    if (!baselines.empty()) *row.mutable_baseline() = OverTimes(baselines);
  }

  const v1::CompareRequest& request_;
  const ComparedPair compared_;
  const meshio::Motion &a_ = compared_.a.motion, &b_ = compared_.b.motion;
  const MatchedMoments moments_;
  const ComparisonSink& sink_;
  DistanceOptions options_;
  std::vector<ComparedPart> parts_;           // the whole surface first
  std::vector<std::string> doubts_;           // of the first moment that has any
  std::vector<Eigen::VectorXd> at_vertices_;  // of the whole surface, one per moment, if a map is requested
};

absl::Status CheckVertices(const v1::CompareRequest& request, const ComparedPair& pair) {
  if (!WantsVertices(request)) return absl::OkStatus();
  if (const auto format = record::FindMapFormat(request.map_format()); !request.map_format().empty() && !format.ok()) {
    return format.status();
  }
  for (const Compared* compared : {&pair.a, &pair.b}) {
    if (compared->motion.mesh.triangles.cols() > 0) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(compared->name, ":1: has no triangles, so its vertices have no distances; leave map_format and ",
                     "vertex_distances out"));
  }
  return absl::OkStatus();
}

// Returns the larger value; NaN if either is NaN.
double NanMax(double a, double b) { return std::isnan(a) || a > b ? a : b; }

// Aggregates one measure by the rule of its name.
double OverTimes(const std::string& name, const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const bool square = absl::StartsWith(name, "rms");
  double sum = 0, largest = values.front();
  for (const double value : values) {
    sum += square ? value * value : value;
    largest = NanMax(largest, value);
  }
  if (square) return std::sqrt(sum / count);
  for (const char* start : {"hd", "p95", "spacing"}) {
    if (absl::StartsWith(name, start)) return largest;
  }
  return sum / count;
}

}  // namespace

v1::SurfaceDistance OverTimes(const std::vector<v1::SurfaceDistance>& distances) {
  if (distances.size() == 1) return distances.front();
  v1::SurfaceDistance over;
  for (const v1::SurfaceDistance& distance : distances) {
    over.set_samples_a(over.samples_a() + distance.samples_a());
    over.set_samples_b(over.samples_b() + distance.samples_b());
  }
  for (int i = 0; i < v1::SurfaceDistance::descriptor()->field_count(); ++i) {
    const auto* field = v1::SurfaceDistance::descriptor()->field(i);
    if (field->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) continue;
    std::vector<double> values;
    values.reserve(distances.size());
    for (const v1::SurfaceDistance& distance : distances) {
      values.push_back(distance.GetReflection()->GetDouble(distance, field));
    }
    over.GetReflection()->SetDouble(&over, field, OverTimes(field->name(), values));
  }
  return over;
}

absl::StatusOr<v1::ComparisonTable> Compare(const v1::CompareRequest& request, BodySource bodies,
                                            const ComparisonSink& sink) {
  auto pair = ReadPair(request, bodies);
  if (!pair.ok()) return pair.status();
  if (absl::Status status = CheckVertices(request, *pair); !status.ok()) return status;
  if (request.by_region()) AddDomes(pair->a.motion.mesh, pair->b.motion.mesh);
  auto moments = MatchTimes(pair->a.motion, pair->b.motion, request.match_phases());
  if (!moments.ok()) return moments.status();
  Comparer comparer(request, *std::move(pair), *std::move(moments), sink);
  if (absl::Status status = comparer.Measure(); !status.ok()) return status;
  if (!request.map_format().empty()) {
    const auto format = record::FindMapFormat(request.map_format());
    if (absl::Status status = format->write(comparer.Map(), sink.map); !status.ok()) return status;
  }
  return comparer.Table();
}

}  // namespace phrenic::compare
