#include "server/imaging/derived_diaphragm.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/double_layer.h"
#include "server/anatomy/meshing/plane_region.h"
#include "server/imaging/diaphragm_rim.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"

namespace phrenic::imaging {
namespace {

using anatomy::Sheet;

constexpr double kReported = 0.1;  // minimum extrapolated share of a sector for the report

// Returns the area of the sheet inside the rim [mm^2], by quadrature in the plane.
double AreaOf(const anatomy::SheetDomain& sheet) {
  constexpr double kCell = 0.04;
  const anatomy::PlaneRegion region(sheet.loops);
  const Eigen::Vector2d ex(kCell, 0), ey(0, kCell);
  double area = 0;
  for (double y = region.low().y(); y < region.high().y(); y += kCell) {
    for (double x = region.low().x(); x < region.high().x(); x += kCell) {
      const Eigen::Vector2d p(x, y);
      if (!region.Contains(p)) continue;
      const Eigen::Vector3d at = sheet.map(p);
      area += (sheet.map(p + ex) - at).cross(sheet.map(p + ey) - at).norm();
    }
  }
  return area;
}

// Returns the unit normal towards the thorax.
Eigen::Vector3d NormalOf(const anatomy::SheetDomain& sheet, const Eigen::Vector2d& p) {
  constexpr double kStep = 5e-3;
  const Eigen::Vector2d ex(kStep, 0), ey(0, kStep);
  return (sheet.map(p + ex) - sheet.map(p - ex)).cross(sheet.map(p + ey) - sheet.map(p - ey)).normalized();
}

// Returns how far each vertex is outside of the tendon's leaves, in disc coordinates; infinity on the wall.
std::vector<double> OutsideTendon(const Sheet& sheet, const FittedCage& cage) {
  std::vector<double> outside;
  for (const Eigen::Vector3d& point : sheet.points) {
    outside.push_back(cage.OnWall(point) ? std::numeric_limits<double>::infinity()
                                         : anatomy::OutsideLeaves(cage.DiscCoordinates(point)));
  }
  return outside;
}

double TriangleArea(const Sheet& sheet, Eigen::Index t) {
  const Eigen::Vector3d &a = sheet.points[sheet.triangles(0, t)], &b = sheet.points[sheet.triangles(1, t)];
  return (b - a).cross(sheet.points[sheet.triangles(2, t)] - a).norm() / 2;
}

// Returns the bound of `outside` below which `share` of the area lies.
double TendonBound(const Sheet& sheet, const std::vector<double>& outside, double share) {
  std::vector<std::pair<double, double>> triangles;  // outside, area
  double area = 0;
  for (Eigen::Index t = 0; t < sheet.triangles.cols(); ++t) {
    const Eigen::Vector3i v = sheet.triangles.col(t);
    triangles.emplace_back(std::max({outside[v[0]], outside[v[1]], outside[v[2]]}), TriangleArea(sheet, t));
    area += triangles.back().second;
  }
  std::sort(triangles.begin(), triangles.end());
  double taken = 0, bound = 0;
  for (const auto& [at, triangle_area] : triangles) {
    if (std::isinf(at) || taken >= share * area) break;
    taken += triangle_area;
    bound = at;
  }
  return bound;
}

using Regions = std::map<std::string, std::vector<int>>;

// True where the border bridges the aorta between the crura, and is not fixed to bone.
bool BridgesAorta(const CageFrame& frame, const Eigen::Vector3d& point) {
  constexpr double kHalfWidth = 0.06;  // of the cage's width
  return point.y() > frame.centre.y() && std::abs(point.x() - frame.centre.x()) < kHalfWidth * frame.width &&
         point.z() > frame.CrusFixedBelow();
}

// Returns "tendon", "muscle", "crus-right", "crus-left", "rim" and "insertion" as vertices of the sheet.
Regions RegionsOf(const Sheet& sheet, const CageFrame& frame, const FittedCage& cage, double tendon_share) {
  const std::vector<double> outside = OutsideTendon(sheet, cage);
  const double tendon = TendonBound(sheet, outside, tendon_share);
  std::vector<bool> on_rim(sheet.points.size(), false);
  for (const int i : sheet.loops[0]) on_rim[i] = true;
  Regions regions;
  for (int i = 0; i < static_cast<int>(sheet.points.size()); ++i) {
    const Eigen::Vector3d& point = sheet.points[i];
    const bool right = InCrus(frame, point, v1::SIDE_RIGHT), left = InCrus(frame, point, v1::SIDE_LEFT);
    regions[outside[i] <= tendon ? "tendon" : "muscle"].push_back(i);
    if (right) regions["crus-right"].push_back(i);
    if (left) regions["crus-left"].push_back(i);
    if (on_rim[i]) regions["rim"].push_back(i);
    const bool fixed_crus = (right || left) && point.z() < frame.CrusFixedBelow();
    if (fixed_crus || (on_rim[i] && !BridgesAorta(frame, point))) regions["insertion"].push_back(i);
  }
  return regions;
}

// Returns the sheet as one layer [m], with its regions.
Mesh MiddleLayer(const Sheet& sheet, Regions regions) {
  Mesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(sheet.points.size()));
  for (size_t i = 0; i < sheet.points.size(); ++i) mesh.vertices.col(static_cast<Eigen::Index>(i)) = sheet.points[i];
  mesh.vertices *= kMillimetre;
  mesh.triangles = sheet.triangles;
  mesh.regions = std::move(regions);
  return mesh;
}

// Adds the regions to both layers.
void AddRegions(const Regions& regions, Mesh& mesh) {
  for (const auto& [name, vertices] : regions) {
    for (const int i : vertices) {
      mesh.regions[name].push_back(anatomy::UpperVertex(i));
      mesh.regions[name].push_back(anatomy::LowerVertex(i));
    }
  }
}

std::string SectorName(int sector) {
  return absl::StrCat((sector & 4) != 0 ? "wall" : "dome", (sector & 1) != 0 ? ", left" : ", right",
                      (sector & 2) != 0 ? ", back" : ", front");
}

v1::DerivedDiaphragm ReportOf(const Sheet& sheet, const SmoothSheet& smooth) {
  std::array<double, 5> area{};  // by Source
  std::array<double, 8> sector_area{}, sector_extrapolated{};
  for (Eigen::Index t = 0; t < sheet.triangles.cols(); ++t) {
    const Eigen::Vector3i v = sheet.triangles.col(t);
    const Eigen::Vector2d p = (sheet.plane[v[0]] + sheet.plane[v[1]] + sheet.plane[v[2]]) / 3;
    const Source source = smooth.SourceAt(p);
    const int sector = (p.norm() > 1 ? 4 : 0) + (p.y() > 0 ? 2 : 0) + (p.x() > 0 ? 1 : 0);
    const double own = TriangleArea(sheet, t);
    area[static_cast<int>(source)] += own;
    sector_area[sector] += own;
    if (source == Source::kNone) sector_extrapolated[sector] += own;
  }
  const double all = area[0] + area[1] + area[2] + area[3] + area[4];
  v1::DerivedDiaphragm report;
  report.set_area_cm2(all / 100);
  report.set_between_organs(area[static_cast<int>(Source::kBetween)] / all);
  report.set_beside_one_organ(area[static_cast<int>(Source::kBesideOne)] / all);
  report.set_on_bone(area[static_cast<int>(Source::kOnBone)] / all);
  report.set_labelled(area[static_cast<int>(Source::kLabel)] / all);
  report.set_extrapolated(area[static_cast<int>(Source::kNone)] / all);
  for (int s = 0; s < 8; ++s) {
    if (sector_extrapolated[s] < kReported * sector_area[s] || sector_area[s] == 0) continue;
    v1::ExtrapolatedSector& sector = *report.add_sectors();
    sector.set_where(SectorName(s));
    sector.set_share(sector_extrapolated[s] / sector_area[s]);
  }
  return report;
}

// FAILED_PRECONDITION if too little of the sheet was observed to fit it.
absl::Status CheckEvidence(const SheetEvidence& evidence) {
  constexpr double kFewest = 0.05;  // share of the rays
  const auto missing = std::count_if(evidence.source.begin(), evidence.source.end(), [](Source source) {
    return source == Source::kNone || source == Source::kOnWall;
  });
  const double observed = 1 - static_cast<double>(missing) / static_cast<double>(evidence.source.size());
  if (observed >= kFewest) return absl::OkStatus();
  return absl::FailedPreconditionError(
      absl::StrFormat("cannot derive a diaphragm: only %.1f %% of the rays from the middle of the lower cage meet "
                      "lungs, heart or bones, "
                      "and %.0f %% are needed; label lungs, ribs and the organs below them",
                      100 * observed, 100 * kFewest));
}

// FAILED_PRECONDITION if the rim does not enclose a sheet of the size of a diaphragm, which could not be meshed.
absl::Status CheckSize(const SmoothSheet& sheet, const anatomy::PlaneLoop& rim, double area) {
  constexpr double kSmallest = 2'000, kLargest = 500'000;  // [mm^2]
  constexpr double kFurthest = 1'000;                      // point of the rim [mm]
  bool bounded = std::isfinite(area) && area >= kSmallest && area <= kLargest;
  for (const Eigen::Vector2d& p : rim) {
    bounded = bounded && p.allFinite() && std::abs(sheet.Depth(p)) < kFurthest;
  }
  if (bounded) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrFormat(
      "cannot derive a diaphragm: the sheet inside the costal margin would have %.0f cm2, not %.0f to %.0f; check the "
      "labels of ribs and vertebrae",
      area / 100, kSmallest / 100, kLargest / 100));
}

// True if the mesh has triangles, and each vertex of its rim is a corner of one.
bool IsWhole(const Sheet& sheet) {
  const bool used = std::ranges::all_of(sheet.loops, [](const std::vector<int>& loop) {
    return !loop.empty() && std::ranges::all_of(loop, [](int vertex) { return vertex >= 0; });
  });
  return used && !sheet.loops.empty() && sheet.triangles.cols() > 0;
}

using EdgeLength = std::function<double(const Eigen::Vector3d&)>;

// Returns edge lengths of the middle layer: 0.6 of `usual` where it folds over the spine and in the crura.
EdgeLength MiddleEdges(const CageFrame& frame, double usual) {
  return [&frame, usual](const Eigen::Vector3d& point) {
    constexpr double kFine = 0.6, kFineWithin = 0.1, kUsualBeyond = 0.22;  // of the width, from the spine's front
    const double away = (point.head<2>() - Eigen::Vector2d(frame.centre.x(), frame.spine_front)).norm() / frame.width;
    const double t = std::clamp((away - kFineWithin) / (kUsualBeyond - kFineWithin), 0.0, 1.0);
    return usual * (kFine + (1 - kFine) * t * t * (3 - 2 * t));
  };
}

// FAILED_PRECONDITION if the mesh has no triangles, or a vertex of its rim is not a corner of one.
absl::StatusOr<Sheet> MeshWhole(anatomy::SheetDomain& domain, const EdgeLength& edge_length) {
  domain.edge_length = edge_length;
  Sheet sheet = anatomy::MeshSheet(domain);
  if (IsWhole(sheet)) return sheet;
  return absl::FailedPreconditionError(
      "cannot derive a diaphragm: its rim crosses itself; check the labels of ribs and vertebrae");
}

// Returns the edge length with which both layers together have this many vertices [mm].
double EdgeLengthFor(int vertices, double area) {
  // A hexagonal lattice has one vertex per sqrt(3)/2 squared edge lengths; MeshSheet gives 0.855 times as many.
  constexpr double kOfLattice = 0.855;
  return std::sqrt(kOfLattice * area / (vertices / 2.0) * 2 / std::sqrt(3.0));
}

// Returns the double layer of this many vertices [m], with its regions.
absl::StatusOr<Mesh> MeshLayers(anatomy::SheetDomain& domain, double area, const CageFrame& frame,
                                const FittedCage& cage, const DiaphragmOptions& options) {
  const double edges = EdgeLengthFor(options.vertices, area);
  const auto seen = MeshWhole(domain, [edges](const Eigen::Vector3d&) { return edges; });
  if (!seen.ok()) return seen.status();
  Mesh mesh = anatomy::DoubleLayer(*seen, [&domain](const Eigen::Vector2d& p) { return NormalOf(domain, p); });
  mesh.vertices *= kMillimetre;
  AddRegions(RegionsOf(*seen, frame, cage, options.tendon_share), mesh);
  return mesh;
}

}  // namespace

absl::StatusOr<DerivedDiaphragm> DeriveDiaphragm(const LabelVolume& volume, const std::vector<Part>& parts,
                                                 const CageFrame& frame, const FittedCage& cage,
                                                 const DiaphragmOptions& options, Fallbacks& fallbacks) {
  const SheetEvidence evidence = CollectEvidence(volume, parts, frame, cage);
  if (absl::Status status = CheckEvidence(evidence); !status.ok()) return status;
  const SmoothSheet smooth(frame, evidence);
  anatomy::SheetDomain domain;
  domain.loops = {FindRim(volume, parts, frame, smooth, fallbacks)};
  domain.map = [&](const Eigen::Vector2d& p) { return cage.Inside(smooth.Point(p)); };
  const double area = AreaOf(domain);
  if (absl::Status status = CheckSize(smooth, domain.loops[0], area); !status.ok()) return status;
  DerivedDiaphragm derived;
  if (options.vertices > 0) {
    absl::StatusOr<Mesh> layers = MeshLayers(domain, area, frame, cage, options);
    if (!layers.ok()) return layers.status();
    derived.mesh = *std::move(layers);
  }
  const auto middle = MeshWhole(domain, MiddleEdges(frame, options.middle_edge_length));
  if (!middle.ok()) return middle.status();
  derived.middle = MiddleLayer(*middle, RegionsOf(*middle, frame, cage, options.tendon_share));
  derived.report = ReportOf(*middle, smooth);
  derived.report.set_vertices(static_cast<int>(derived.mesh.vertices.cols()));
  return derived;
}

}  // namespace phrenic::imaging
