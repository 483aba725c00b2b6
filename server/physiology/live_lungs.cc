#include "server/physiology/live_lungs.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/motions/lung_modes.h"
#include "server/physiology/lung_breath.h"
#include "server/physiology/parts.h"

namespace phrenic::physiology {
namespace {

constexpr size_t kMostLungs = 8;                 // lobes
constexpr Eigen::Index kMostTriangles = 100000;  // of all lungs: 300 MB while they are reduced

absl::Status CheckSize(const Model& model, const std::vector<int>& lungs) {
  Eigen::Index triangles = 0;
  for (const int body : lungs) triangles += model.bodies[static_cast<size_t>(body)].mesh.triangles.cols();
  if (lungs.size() <= kMostLungs && triangles <= kMostTriangles) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat("the scene has ", lungs.size(), " lungs with ", triangles,
                                                    " triangles, and lung tissue at most ", kMostLungs, " with ",
                                                    kMostTriangles, " in all: make their surfaces coarser"));
}

}  // namespace

absl::Status LiveLungs::Add(int body, const StopCheck& stop) {
  const BodyModel& lung = model_.bodies[static_cast<size_t>(body)];
  const absl::StatusOr<LungTissue> tissue = LungTissue::Make(lung.mesh, {}, stop);
  if (!tissue.ok()) return tissue.status();
  LungSurroundings surroundings(model_, sheet_, wall_, *tissue);
  if (stop.Stopped()) return stop.status();
  absl::StatusOr<LungResponses> responses = LungResponses::Make(*tissue, surroundings.neighbours(), stop);
  if (!responses.ok()) return responses.status();
  Add(body, tissue->box(), *std::move(responses), std::move(surroundings));
  return absl::OkStatus();
}

void LiveLungs::Add(int body, const Eigen::AlignedBox3d& box, LungResponses responses,
                    std::optional<LungSurroundings> surroundings) {
  const RegionWeights weights = WeightsOfRegions(responses.grid(), box);
  const Eigen::MatrixXd& shapes = responses.shapes();
  Eigen::MatrixXd caudal = weights.caudal * shapes, gained = weights.gained * shapes;
  const Eigen::RowVectorXd volume = weights.volume * shapes;
  lungs_.push_back({body, model_.bodies[static_cast<size_t>(body)].name, std::move(responses), std::move(surroundings),
                    std::move(caudal), std::move(gained), volume});
}

absl::StatusOr<LiveLungs> LiveLungs::Make(const Model& model, const StopCheck& stop) {
  if (const LungModes* modes = LungModes::Find(model)) {
    LiveLungs lungs(model, -1, -1);
    for (const LungModes::Inside& lung : modes->insides()) {
      lungs.Add(lung.body, lung.box, {lung.grid, lung.shapes}, std::nullopt);
    }
    return lungs;
  }
  const absl::StatusOr<Parts> parts = FindParts(model);
  if (!parts.ok() || parts->lungs.empty() || parts->muscle < 0 || parts->wall < 0) {
    return absl::FailedPreconditionError(
        "the scene lacks lungs, a simulated diaphragm or an inner wall of the cage, so that nothing moves lung tissue");
  }
  if (absl::Status status = CheckSize(model, parts->lungs); !status.ok()) return status;
  LiveLungs lungs(model, parts->muscle, parts->wall);
  for (const int body : parts->lungs) {
    if (absl::Status added = lungs.Add(body, stop); !added.ok()) return added;
  }
  return lungs;
}

std::vector<LungMoment> LiveLungs::At(const State& state, const v1::Parameters& parameters) const {
  const bool by_modes = sheet_ < 0;
  const Points sheet = by_modes ? Points(3, 0) : Placed(model_, state, sheet_);
  const Points wall = by_modes ? Points(3, 0) : Placed(model_, state, wall_);
  std::vector<LungMoment> moments;
  for (const Lung& lung : lungs_) {
    LungMoment& moment = moments.emplace_back();
    if (lung.surroundings) {
      const double follows =
          FollowsSurroundings(model_.bodies[static_cast<size_t>(lung.body)].anatomy.side(), parameters);
      moment.amplitudes = follows * lung.responses.Amplitudes(lung.surroundings->Displacement(state, sheet, wall));
    } else {
      moment.amplitudes = LungModes::AmplitudesAt(MakeEvalContext(model_, parameters, state, {}));
    }
    moment.volume = lung.volume * moment.amplitudes;
    const Eigen::VectorXd caudal = lung.caudal * moment.amplitudes, gained = lung.gained * moment.amplitudes;
    for (size_t r = 0; r < kLungRegions; ++r) {
      moment.caudal[r] = caudal[static_cast<Eigen::Index>(r)];
      moment.gained[r] = gained[static_cast<Eigen::Index>(r)];
    }
  }
  return moments;
}

std::optional<TissueReading> LiveLungs::Read(const std::vector<LungMoment>& moments,
                                             const Eigen::Vector3d& point) const {
  for (size_t i = 0; i < lungs_.size(); ++i) {
    const LungResponses& responses = lungs_[i].responses;
    if (responses.grid().Holds(point)) {
      return TissueReading{static_cast<int>(i), responses.At(moments[i].amplitudes, point)};
    }
  }
  return std::nullopt;
}

}  // namespace phrenic::physiology
