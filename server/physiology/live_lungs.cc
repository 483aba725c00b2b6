#include "server/physiology/live_lungs.h"

#include <algorithm>
#include <array>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/breathing/posture.h"
#include "server/mechanics/motions/lung_modes.h"
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

// Returns the place of a posture in kPostures; that of the supine one if it is not said.
size_t IndexOf(v1::Posture posture) {
  const auto* const found = std::find(kPostures.begin(), kPostures.end(), posture);
  return found == kPostures.end() ? 0 : static_cast<size_t>(found - kPostures.begin());
}

}  // namespace

absl::Status LiveLungs::AddDriven(const Parts& parts, const StopCheck& stop) {
  const absl::StatusOr<std::vector<LungTissue>> made = MakeLungs(model_, parts, DrivenLungs(), {}, stop);
  if (!made.ok()) return made.status();
  const std::vector<LungTissue>& tissues = *made;
  drive_.emplace(model_, parts, tissues);
  std::vector<LungWeight> weights;
  weights.reserve(kPostures.size());
  for (const v1::Posture posture : kPostures) weights.push_back(drive_->WeightIn(posture));
  for (size_t i = 0; i < tissues.size(); ++i) {
    if (stop.Stopped()) return stop.status();
    auto responses = LungResponses::Make(tissues[i], drive_->surroundings(i).neighbours(), weights, stop);
    if (!responses.ok()) return responses.status();
    Add(parts.lungs[i], tissues[i].box(), *std::move(responses));
  }
  return absl::OkStatus();
}

void LiveLungs::Add(int body, const Eigen::AlignedBox3d& box, LungResponses responses) {
  const RegionWeights weights = WeightsOfRegions(responses.grid(), box);
  const Eigen::MatrixXd& shapes = responses.shapes();
  Eigen::MatrixXd caudal = weights.caudal * shapes, gained = weights.gained * shapes;
  const Eigen::RowVectorXd volume = weights.volume * shapes;
  lungs_.push_back({body, model_.bodies[static_cast<size_t>(body)].name, std::move(responses), std::move(caudal),
                    std::move(gained), volume});
}

absl::StatusOr<LiveLungs> LiveLungs::Make(const Model& model, const StopCheck& stop) {
  LiveLungs lungs(model);
  if (const LungModes* modes = LungModes::Find(model)) {
    for (const LungModes::Inside& lung : modes->insides()) lungs.Add(lung.body, lung.box, {lung.grid, lung.shapes});
    return lungs;
  }
  const absl::StatusOr<Parts> parts = FindParts(model);
  if (!parts.ok() || parts->lungs.empty() || parts->muscle < 0 || parts->wall < 0) {
    return absl::FailedPreconditionError(
        "the scene lacks lungs, a simulated diaphragm or an inner wall of the cage, so that nothing moves lung tissue");
  }
  if (absl::Status status = CheckSize(model, parts->lungs); !status.ok()) return status;
  if (absl::Status added = lungs.AddDriven(*parts, stop); !added.ok()) return added;
  return lungs;
}

std::vector<Eigen::VectorXd> LiveLungs::AmplitudesAt(const State& state, const v1::Parameters& parameters) const {
  std::vector<Eigen::VectorXd> amplitudes;
  amplitudes.reserve(lungs_.size());
  if (!drive_) {
    const EvalContext at = MakeEvalContext(model_, parameters, state, {});
    for (size_t i = 0; i < lungs_.size(); ++i) amplitudes.emplace_back(LungModes::AmplitudesAt(at));
    return amplitudes;
  }
  const LungDrive::Moment moment = drive_->At(state, parameters);
  const size_t weight = IndexOf(parameters.posture());
  std::array<double, 2> followed = {}, pressed = {};
  for (size_t i = 0; i < lungs_.size(); ++i) {
    const Lung& lung = lungs_[i];
    amplitudes.push_back(lung.responses.Amplitudes(moment.displacement[i], weight));
    followed[drive_->side(i)] += lung.volume * amplitudes.back();
    pressed[drive_->side(i)] += lung.volume * lung.responses.PerPressure(weight);
  }
  const std::array<double, 2> pressures = FillingPressures(moment.space, followed, pressed);
  for (size_t i = 0; i < lungs_.size(); ++i) {
    amplitudes[i] += pressures[drive_->side(i)] * lungs_[i].responses.PerPressure(weight);
  }
  return amplitudes;
}

std::vector<LungMoment> LiveLungs::At(const State& state, const v1::Parameters& parameters) const {
  const std::vector<Eigen::VectorXd> amplitudes = AmplitudesAt(state, parameters);
  std::vector<LungMoment> moments;
  for (size_t i = 0; i < lungs_.size(); ++i) {
    const Lung& lung = lungs_[i];
    LungMoment& moment = moments.emplace_back();
    moment.amplitudes = amplitudes[i];
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
