#include "server/fit/point_residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic::fit {
namespace {

constexpr double kAlike = 0.04;  // [m]
constexpr std::size_t kMostPhases = 20;
constexpr double kPriorDepthSd = 0.15;  // of the depth at a phase
constexpr double kBesideLungs = 0.08;   // [m] from the lungs' surface to the skin
constexpr double kSway = 0.005;         // [m] of the body
constexpr Eigen::Index kFewestForHalves = 20;

using Cell = std::array<int, 3>;

Cell CellOf(const Eigen::Vector3d& point) {
  const Eigen::Vector3i cell = (point / kAlike).array().floor().cast<int>();
  return {cell.x(), cell.y(), cell.z()};
}

// The residuals of some vectors per point whose model is linear in the amplitudes, but for a factor.
class LandmarkResiduals final : public Residuals {
 public:
  // `depth`: the number that multiplies each point's motion, or -1.
  LandmarkResiduals(KindOfData kind, const Landmarks& landmarks, Halves halves, Eigen::MatrixXd responses,
                    std::vector<int> depth)
      : Residuals(std::move(kind)),
        motion_(landmarks.motion),
        halves_(std::move(halves)),
        responses_(std::move(responses)),
        depth_(std::move(depth)),
        alike_(AlikeOnes(landmarks.exhale, halves_.fitting)) {}

  Rows At(const Eigen::VectorXd& numbers, Part part) const override {
    const std::vector<int>& own = part == Part::kFitting ? halves_.fitting : halves_.held_out;
    const auto count = static_cast<Eigen::Index>(own.size());
    const Eigen::Index amplitudes = responses_.cols();
    const double sd = kind().sd;
    Rows rows = {Eigen::VectorXd(3 * count), Eigen::VectorXd(3 * count),
                 Eigen::MatrixXd::Zero(3 * count, numbers.size())};
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index i = own[static_cast<size_t>(k)];
      const int depth = depth_[static_cast<size_t>(i)];
      const double share = depth < 0 ? 1 : numbers[depth];
      const auto response = responses_.middleRows<3>(3 * i);
      const Eigen::Vector3d full = response * numbers.head(amplitudes);
      rows.residual.segment<3>(3 * k) = motion_.col(i) - share * full;
      rows.weight.segment<3>(3 * k).setConstant(1 / (sd * sd * alike_[i]));
      rows.slope.block(3 * k, 0, 3, amplitudes) = share * response;
      if (depth >= 0) rows.slope.block<3, 1>(3 * k, depth) = full;
    }
    return rows;
  }

 private:
  const Points motion_;
  const Halves halves_;
  const Eigen::MatrixXd responses_;
  const std::vector<int> depth_;
  const Eigen::VectorXd alike_;
};

// The markers that lie beside the lungs.
struct UsedMarkers {
  std::vector<int> indices;       // of the markers
  Points places, normals;         // of the nearest point of the lungs' costal side
  Eigen::VectorXd normal_motion;  // [m]
};

class MarkerResiduals final : public Residuals {
 public:
  MarkerResiduals(KindOfData kind, UsedMarkers used, Halves halves, const Eigen::MatrixXd& responses, int shift)
      : Residuals(std::move(kind)), used_(std::move(used)), halves_(std::move(halves)), shift_(shift) {
    responses_.resize(used_.normals.cols(), responses.cols());
    for (Eigen::Index i = 0; i < used_.normals.cols(); ++i) {
      responses_.row(i) = used_.normals.col(i).transpose() * responses.middleRows<3>(3 * i);
    }
  }

  Rows At(const Eigen::VectorXd& numbers, Part part) const override {
    const std::vector<int>& own = part == Part::kFitting ? halves_.fitting : halves_.held_out;
    const auto count = static_cast<Eigen::Index>(own.size());
    const double sd = kind().sd;
    Rows rows = {Eigen::VectorXd(count), Eigen::VectorXd::Constant(count, 1 / (sd * sd)),
                 Eigen::MatrixXd::Zero(count, numbers.size())};
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index i = own[static_cast<size_t>(k)];
      const Eigen::Vector3d normal = used_.normals.col(i);
      rows.slope.row(k).head(responses_.cols()) = responses_.row(i);
      rows.slope.block<1, 3>(k, shift_) = normal.transpose();
      rows.residual[k] = used_.normal_motion[i] - responses_.row(i).dot(numbers.head(responses_.cols())) -
                         normal.dot(numbers.segment<3>(shift_));
    }
    return rows;
  }

  using Residuals::Doubt;

 private:
  const UsedMarkers used_;
  const Halves halves_;
  const int shift_;
  Eigen::MatrixXd responses_;  // along the normals
};

// Finds the nearest costal point of the lungs' surfaces for each marker.
UsedMarkers FindBeside(const Points& rest, const Points& motion, const Person& person) {
  UsedMarkers used;
  std::vector<Eigen::Vector3d> places, normals;
  std::vector<double> along;
  for (Eigen::Index m = 0; m < rest.cols(); ++m) {
    double least = kBesideLungs * kBesideLungs;
    Eigen::Vector3d place, normal;
    bool costal = false, found = false;
    for (const Side side : {kRight, kLeft}) {
      const LungTissue& tissue = person.tissue(side);
      for (Eigen::Index i = 0; i < tissue.points().cols(); ++i) {
        const double squared = (tissue.points().col(i) - rest.col(m)).squaredNorm();
        if (squared >= least) continue;
        least = squared;
        place = tissue.points().col(i);
        normal = tissue.normals().col(i);
        costal = PlaceOf(place, normal, tissue.box(), side == kLeft ? 1 : -1).costal > 0.5;
        found = true;
      }
    }
    if (!found || !costal) continue;
    used.indices.push_back(static_cast<int>(m));
    places.push_back(place);
    normals.push_back(normal);
    along.push_back(normal.dot(motion.col(m)));
  }
  const auto count = static_cast<Eigen::Index>(places.size());
  used.places.resize(3, count);
  used.normals.resize(3, count);
  used.normal_motion.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    used.places.col(i) = places[static_cast<size_t>(i)];
    used.normals.col(i) = normals[static_cast<size_t>(i)];
    used.normal_motion[i] = along[static_cast<size_t>(i)];
  }
  return used;
}

Halves AllFitting(Eigen::Index count) {
  Halves halves;
  for (int i = 0; i < static_cast<int>(count); ++i) halves.fitting.push_back(i);
  return halves;
}

Eigen::Vector3d MiddleOf(const Points& points) {
  return (points.rowwise().minCoeff() + points.rowwise().maxCoeff()) / 2;
}

// Returns the middle of both lungs' box.
Eigen::Vector3d MiddleOf(const Person& person) {
  Eigen::AlignedBox3d box = person.tissue(kRight).box();
  box.extend(person.tissue(kLeft).box());
  return box.center();
}

}  // namespace

Eigen::VectorXd AlikeOnes(const Points& points, const std::vector<int>& among) {
  std::map<Cell, double> counts;
  for (const int i : among) counts[CellOf(points.col(i))] += 1;
  Eigen::VectorXd alike(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const auto found = counts.find(CellOf(points.col(i)));
    alike[i] = found == counts.end() ? 1 : found->second;
  }
  return alike;
}

absl::Status AddLandmarks(const KindOfData& kind, const Landmarks& landmarks, const Halves& halves,
                          const Person& person, FitSpace& space, AllResiduals& all) {
  std::map<double, int> depths;  // by phase
  std::vector<int> depth(static_cast<size_t>(landmarks.size()), -1);
  for (Eigen::Index i = 0; i < landmarks.phase.size(); ++i) {
    const double phase = landmarks.phase[i];
    if (phase == 1) continue;
    if (!depths.contains(phase)) {
      if (depths.size() == kMostPhases) {
        return absl::InvalidArgumentError(absl::StrCat(kind.source, ": has more than ", kMostPhases, " phases"));
      }
      const double expected = (1 - std::cos(std::numbers::pi * phase)) / 2;
      depths[phase] = space.Add({absl::StrFormat("depth at phase %g", phase), "part of the way from exhale to inhale",
                                 "1", 1, expected, kPriorDepthSd, -0.5, 1.5});
    }
    depth[static_cast<size_t>(i)] = depths[phase];
  }
  all.push_back(
      std::make_unique<LandmarkResiduals>(kind, landmarks, halves, person.Responses(landmarks.exhale), depth));
  return absl::OkStatus();
}

absl::Status AddMarkers(const KindOfData& kind, const Markers& markers, const Person& person, std::uint64_t split,
                        FitSpace& space, AllResiduals& all) {
  Points rest = markers.rest;
  if (markers.centred) rest.colwise() += MiddleOf(person) - MiddleOf(markers.rest);
  UsedMarkers used = FindBeside(rest, markers.motion, person);
  const auto count = static_cast<Eigen::Index>(used.indices.size());
  if (count < 3) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%s: %d of %d markers lie beside the lungs, within %g mm of them: bring them into the frame of the other data "
        "(LPS, mm), or write a line \"# place=centred\" before the header, which moves their middle onto the lungs'",
        kind.source, count, markers.rest.cols(), 1000 * kBesideLungs));
  }
  const int shift =
      space.Add({"sway x", "shift of the whole body between the markers' frames", "mm", 1e-3, 0, kSway, -0.1, 0.1});
  space.Add({"sway y", "the same along y", "mm", 1e-3, 0, kSway, -0.1, 0.1});
  space.Add({"sway z", "the same along z", "mm", 1e-3, 0, kSway, -0.1, 0.1});
  const Eigen::MatrixXd responses = person.Responses(used.places);
  Halves halves = count >= kFewestForHalves ? SplitInHalves(static_cast<int>(count), split) : AllFitting(count);
  auto residuals = std::make_unique<MarkerResiduals>(kind, std::move(used), std::move(halves), responses, shift);
  if (count < markers.rest.cols()) {
    residuals->Doubt(absl::StrFormat("%s: %d of %d markers are not beside the lungs' costal side and are left out",
                                     kind.source, markers.rest.cols() - count, markers.rest.cols()));
  }
  all.push_back(std::move(residuals));
  return absl::OkStatus();
}

}  // namespace phrenic::fit
