#include "server/phantom/breathing_phantom.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "absl/strings/str_format.h"
#include "server/fluoroscopy/outline.h"
#include "server/mechanics/skinning/body_points.h"
#include "server/mesh/line_crossings.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"
#include "server/phantom/hounsfield.h"

namespace phrenic::phantom {
namespace {

using fluoroscopy::Tissue;
using imaging::LabelVolume;

// Least and largest volume of a place in a lung relative to the mean of the lung: beyond are bricks that a thin margin
// tears, a few voxels in ten thousand.
constexpr double kDensest = 0.4, kThinnest = 2.5;
constexpr double kAround = 10, kAroundTrunk = 30;  // free space around structures, sideways with a trunk [mm]

// Calls then(index of the voxel) for each voxel whose centre is inside the closed surface [m].
template <typename Then>
void ForEachInside(const Points& vertices, const Triangles& triangles, const LabelVolume& grid, const Then& then) {
  const Points at = grid.to_patient.inverse() * (kMillimetresAMetre * vertices);
  const Eigen::Vector3i low = at.rowwise().minCoeff().array().floor().cast<int>().max(0);
  const Eigen::Vector3i high = at.rowwise().maxCoeff().array().ceil().cast<int>().min(grid.size.array() - 1);
  if ((low.array() > high.array()).any()) return;
  const Eigen::Vector3i size = high - low + Eigen::Vector3i::Ones();
  const auto crossings = LineCrossings(at.colwise() - low.cast<double>(), triangles, size.head<2>());
  for (std::size_t line = 0; line < crossings.size(); ++line) {
    const int i = low.x() + static_cast<int>(line) % size.x(), j = low.y() + static_cast<int>(line) / size.x();
    for (std::size_t c = 0; c + 1 < crossings[line].size(); c += 2) {
      const int from = std::max(0, low.z() + static_cast<int>(std::ceil(crossings[line][c])));
      const int to = std::min(high.z(), low.z() + static_cast<int>(std::floor(crossings[line][c + 1])));
      for (int k = from; k <= to; ++k) then(grid.Index({i, j, k}));
    }
  }
}

std::size_t VoxelsOf(const LabelVolume& grid) {
  return static_cast<std::size_t>(grid.size.x()) * grid.size.y() * grid.size.z();
}

std::int16_t Rounded(double hounsfield) { return static_cast<std::int16_t>(std::lround(hounsfield)); }

Points Placed(const Model& model, const State& state, int body) {
  Points placed(3, model.bodies[body].mesh.vertices.cols());
  PlaceBody(model, state, body, placed);
  return placed;
}

}  // namespace

double SmallestSpacing(const Eigen::Vector3d& sizes) {
  double spacing = std::ceil(10 * std::cbrt(sizes.prod() / kMostPhantomVoxels)) / 10;
  while (((sizes / spacing).array().ceil() + 1).prod() > kMostPhantomVoxels) spacing += 0.1;
  return spacing;
}

absl::StatusOr<BreathingPhantom> BreathingPhantom::Make(const Model& model, std::vector<State> phases,
                                                        const PhantomRequest& request) {
  if (phases.empty()) return absl::InvalidArgumentError("a phantom has at least one phase");
  BreathingPhantom phantom(model, std::move(phases), request);
  absl::StatusOr<Structures> structures = FindStructures(model);
  if (!structures.ok()) return structures.status();
  phantom.structures_ = *std::move(structures);
  if (absl::Status status = phantom.MakeGrid(); !status.ok()) return status;
  std::vector<double> volumes;
  for (const Structure& structure : phantom.structures_.all) {
    Mesh surface = phantom.SurfaceOf(structure, 0);
    volumes.push_back(SignedVolume(surface.vertices, surface.triangles));
    if (absl::Status status = phantom.AddInterior(structure, std::move(surface)); !status.ok()) return status;
  }
  phantom.smallest_first_.resize(volumes.size());
  std::iota(phantom.smallest_first_.begin(), phantom.smallest_first_.end(), 0);
  std::stable_sort(phantom.smallest_first_.begin(), phantom.smallest_first_.end(),
                   [&](int a, int b) { return volumes[a] < volumes[b]; });
  return phantom;
}

absl::Status BreathingPhantom::AddInterior(const Structure& structure, Mesh surface) {
  const bool is_lung = structure.tissue == Tissue::kLung;
  std::optional<Interior>& interior = interiors_.emplace_back();
  if (!request_.field && !(request_.ct && is_lung)) return absl::OkStatus();
  interior.emplace(std::move(surface), is_lung);
  const absl::Status& tissue = interior->tissue();
  if (tissue.ok()) return absl::OkStatus();
  without_tissue_.push_back(structure.name);
  if (!is_lung) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat("%s: %s; labels need no tissue, a CT and a field do",
                                                    model_.bodies[static_cast<std::size_t>(structure.body)].name,
                                                    std::string(tissue.message())));
}

absl::Status BreathingPhantom::MakeGrid() {
  Eigen::AlignedBox3d box;  // [mm]
  for (const State& state : phases_) {
    for (const Structure& structure : structures_.all) {
      const Points placed = kMillimetresAMetre * Placed(model_, state, structure.body);
      box.extend(Eigen::Vector3d(placed.rowwise().minCoeff())).extend(Eigen::Vector3d(placed.rowwise().maxCoeff()));
    }
  }
  const double sideways = request_.ct ? kAroundTrunk : kAround;
  const Eigen::Vector3d margin(sideways, sideways, kAround);
  const Eigen::Vector3d low = box.min() - margin, sizes = box.sizes() + 2 * margin;
  const Eigen::Vector3d voxels = (sizes / request_.spacing_mm).array().ceil() + 1;
  if (!(voxels.prod() <= kMostPhantomVoxels) || voxels.maxCoeff() > imaging::kMaxAlong) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "volumes of %g x %g x %g mm with voxels of %g mm have more than %g voxels: a spacing of %.1f mm "
        "or more is possible",
        std::ceil(sizes.x()), std::ceil(sizes.y()), std::ceil(sizes.z()), request_.spacing_mm, kMostPhantomVoxels,
        SmallestSpacing(sizes)));
  }
  // The usual scanner orientation in NIfTI: i to the patient's left, j posterior, k superior, as DICOM's rows.
  grid_.size = voxels.cast<int>();
  grid_.to_patient.linear() = request_.spacing_mm * Eigen::Matrix3d::Identity();
  grid_.to_patient.translation() = low;
  for (const Structure& structure : structures_.all) grid_.names[structure.number] = structure.name;
  return absl::OkStatus();
}

Mesh BreathingPhantom::SurfaceOf(const Structure& structure, std::size_t phase) const {
  Mesh surface;
  surface.vertices = Placed(model_, phases_[phase], structure.body);
  surface.triangles = structure.triangles;
  return surface;
}

Eigen::Vector3d BreathingPhantom::Place(std::size_t voxel) const {
  const std::size_t x = grid_.size.x(), layer = x * grid_.size.y();
  const Eigen::Vector<std::size_t, 3> at(voxel % x, voxel % layer / x, voxel / layer);
  return kMillimetre * (grid_.to_patient * at.cast<double>());
}

absl::StatusOr<PhantomPhase> BreathingPhantom::Render(std::size_t phase, const GoOn& go_on) {
  PhantomPhase rendered;
  rendered.time = phases_[phase].time;
  rendered.labels = grid_;
  if (request_.field && first_.empty() && phase != 0) {
    PhantomPhase first;
    first.labels = grid_;
    if (absl::Status status = Label(0, go_on, first); !status.ok()) return status;
    first_ = std::move(first.labels.labels);
  }
  if (absl::Status status = Label(phase, go_on, rendered); !status.ok()) return status;
  if (request_.field && phase == 0) first_ = rendered.labels.labels;
  const bool field = request_.field && phase != 0;
  if (field || request_.ct) {
    if (absl::Status status = MoveInteriors(phase, go_on); !status.ok()) return status;
  }
  if (field) {
    if (absl::Status status = FillField(go_on, rendered); !status.ok()) return status;
  }
  if (request_.ct) {
    if (absl::Status status = FillCt(phase, go_on, rendered); !status.ok()) return status;
  }
  return rendered;
}

absl::Status BreathingPhantom::Label(std::size_t phase, const GoOn& go_on, PhantomPhase& rendered) const {
  std::vector<imaging::Label>& labels = rendered.labels.labels;
  labels.assign(VoxelsOf(grid_), 0);
  rendered.structures.resize(structures_.all.size());
  for (const int s : smallest_first_) {
    if (absl::Status status = go_on(); !status.ok()) return status;
    const Mesh surface = SurfaceOf(structures_.all[s], phase);
    StructureVoxels& voxels = rendered.structures[s];
    voxels.enclosed_mm3 = 1e9 * SignedVolume(surface.vertices, surface.triangles);
    ForEachInside(surface.vertices, surface.triangles, grid_, [&](std::size_t at) {
      ++voxels.inside;
      if (labels[at] != 0) return;
      labels[at] = structures_.all[s].number;
      ++voxels.labelled;
    });
  }
  return absl::OkStatus();
}

absl::Status BreathingPhantom::MoveInteriors(std::size_t phase, const GoOn& go_on) {
  misfit_ = 0;
  for (std::size_t s = 0; s < interiors_.size(); ++s) {
    if (!interiors_[s]) continue;
    if (absl::Status status = go_on(); !status.ok()) return status;
    interiors_[s]->MoveTo(Placed(model_, phases_[phase], structures_.all[s].body));
    misfit_ = std::max(misfit_, interiors_[s]->misfit());
  }
  return absl::OkStatus();
}

absl::Status BreathingPhantom::FillField(const GoOn& go_on, PhantomPhase& rendered) const {
  rendered.field = Points::Zero(3, static_cast<Eigen::Index>(first_.size()));
  const std::size_t layer = static_cast<std::size_t>(grid_.size.x()) * grid_.size.y();
  for (std::size_t voxel = 0; voxel < first_.size(); ++voxel) {
    if (voxel % layer == 0) {
      if (absl::Status status = go_on(); !status.ok()) return status;
    }
    if (first_[voxel] == 0) continue;
    const Eigen::Vector3d moved = interiors_[first_[voxel] - 1]->DisplacementAt(Place(voxel));
    rendered.field.col(static_cast<Eigen::Index>(voxel)) = kMillimetresAMetre * moved;
  }
  return absl::OkStatus();
}

absl::Status BreathingPhantom::FillCt(std::size_t phase, const GoOn& go_on, PhantomPhase& rendered) const {
  rendered.ct.assign(VoxelsOf(grid_), Rounded(kAirHounsfield));
  AddTrunk(phase, rendered);
  std::vector<std::int16_t> constant;
  std::vector<double> at_first, mean;  // volume in the first phase relative to that at rest, and now to the first phase
  for (const Structure& structure : structures_.all) {
    const Points& rest = model_.bodies[structure.body].mesh.vertices;
    const double first = SignedVolume(Placed(model_, phases_[0], structure.body), structure.triangles);
    at_first.push_back(first / SignedVolume(rest, structure.triangles));
    mean.push_back(SignedVolume(Placed(model_, phases_[phase], structure.body), structure.triangles) / first);
    constant.push_back(
        Rounded(structure.tissue == Tissue::kLung ? LungHounsfield(at_first.back()) : HounsfieldOf(structure.tissue)));
  }
  const std::size_t layer = static_cast<std::size_t>(grid_.size.x()) * grid_.size.y();
  for (std::size_t voxel = 0; voxel < rendered.ct.size(); ++voxel) {
    if (voxel % layer == 0) {
      if (absl::Status status = go_on(); !status.ok()) return status;
    }
    const int s = rendered.labels.labels[voxel] - 1;
    if (s < 0) continue;
    rendered.ct[voxel] = constant[s];
    if (structures_.all[s].tissue != Tissue::kLung) continue;
    const Eigen::Vector3d origin = interiors_[s]->OriginOf(Place(voxel));
    const double ratio = interiors_[s]->VolumeRatioAt(origin);
    const double bounded = std::clamp(ratio, kDensest * mean[s], kThinnest * mean[s]);
    rendered.ct[voxel] = Rounded(LungHounsfield(at_first[s] * bounded / (1 + request_.texture * GrainAt(origin))));
  }
  return absl::OkStatus();
}

void BreathingPhantom::AddTrunk(std::size_t phase, PhantomPhase& rendered) const {
  std::vector<Points> bones;
  double low = std::numeric_limits<double>::infinity(), high = -low;  // at rest [m]
  for (const Structure& structure : structures_.all) {
    if (!fluoroscopy::IsBone(structure.tissue)) continue;
    bones.push_back(Placed(model_, phases_[phase], structure.body));
    const Points& rest = model_.bodies[structure.body].mesh.vertices;
    low = std::min(low, rest.row(2).minCoeff());
    high = std::max(high, rest.row(2).maxCoeff());
  }
  if (bones.empty()) return;
  const Mesh trunk = fluoroscopy::TrunkOutline(bones, low, high);
  ForEachInside(trunk.vertices, trunk.triangles, grid_,
                [&](std::size_t at) { rendered.ct[at] = Rounded(HounsfieldOf(Tissue::kWall)); });
}

}  // namespace phrenic::phantom
