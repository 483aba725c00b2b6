#include "server/fit/joint_fit.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/fit/point_residuals.h"
#include "server/fit/trace_residuals.h"

namespace phrenic::fit {
namespace {

constexpr Eigen::Index kFewestForHeldOut = 40;  // landmarks
constexpr double kFarOutside = 0.01;            // [m] of a landmark from the lungs
constexpr double kBadly = 2.5;                  // residuals in standard errors

Halves HalvesOf(const Landmarks& landmarks, std::uint64_t split) {
  if (landmarks.size() >= kFewestForHeldOut) return SplitInHalves(static_cast<int>(landmarks.size()), split);
  Halves halves;
  for (int i = 0; i < static_cast<int>(landmarks.size()); ++i) halves.fitting.push_back(i);
  return halves;
}

// The scene's lungs, where they are in it.
RegisteredLungs LungsAsTheyAre(const LungTemplates& templates) {
  RegisteredLungs registered;
  registered.gap = (templates[kRight].box().max().x() + templates[kLeft].box().min().x()) / 2;
  return registered;
}

absl::StatusOr<RegisteredLungs> ShapeLungs(const LungTemplates& templates, const Evidence& evidence,
                                           const Halves& halves, bool& own_lungs) {
  own_lungs = true;
  if (evidence.exhale.cols() > 0) return RegisterLungs(templates, evidence.exhale);
  if (static_cast<int>(halves.fitting.size()) >= kFewestPoints) {
    return RegisterLungs(templates, evidence.landmarks.exhale(Eigen::all, halves.fitting));
  }
  own_lungs = false;
  RegisteredLungs registered = LungsAsTheyAre(templates);
  registered.doubts.push_back(
      absl::StrFormat("the lungs are the scene's own, in its frame: %d points in both lungs (--exhale) would give them "
                      "the person's size",
                      kFewestPoints));
  return registered;
}

// Landmarks in another frame than the lungs', or in another unit.
absl::Status CheckInside(const LungTemplates& templates, const RegisteredLungs& registered, const Evidence& evidence) {
  const Points& points = evidence.landmarks.exhale;
  Eigen::Index far = 0;
  for (const auto& point : points.colwise()) {
    const Side side = point.x() > registered.gap ? kLeft : kRight;
    const Registration& lung = registered.lungs[side];
    far += templates[side].DistanceAt(lung.ToTemplate(point)) * std::cbrt(lung.scale.prod()) > kFarOutside ? 1 : 0;
  }
  if (3 * far <= points.cols()) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s: %d of %d landmarks lie more than %g mm outside the lungs: they must be in mm and LPS; give --exhale with %d "
      "points or more in both lungs, in the same frame",
      evidence.landmarks_kind.source, far, points.cols(), 1000 * kFarOutside, kFewestPoints));
}

// Returns the descent of a base's highest quarter, where M-mode looks at a dome, per amplitude [1].
Eigen::VectorXd DomeResponses(const Person& person, Side side) {
  const LungTissue& tissue = person.tissue(side);
  std::vector<Eigen::Index> base;
  std::vector<double> heights;
  for (Eigen::Index i = 0; i < tissue.points().cols(); ++i) {
    const BoundaryPlace place =
        PlaceOf(tissue.points().col(i), tissue.normals().col(i), tissue.box(), side == kLeft ? 1 : -1);
    if (place.base <= 0.5) continue;
    base.push_back(i);
    heights.push_back(tissue.points()(2, i));
  }
  if (base.empty()) return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(person.amplitudes().size()));
  const double limit = Quantile(heights, 0.75);
  std::vector<Eigen::Index> highest;
  for (const Eigen::Index i : base) {
    if (tissue.points()(2, i) >= limit) highest.push_back(i);
  }
  const Eigen::MatrixXd responses = person.Responses(tissue.points()(Eigen::all, highest));
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(responses.cols());
  for (Eigen::Index i = 0; i < responses.rows(); i += 3) sum -= responses.row(i + 2).transpose();
  return sum / static_cast<double>(highest.size());
}

// What the model needs of a person.
struct JointModel {
  const Person& person;
  Eigen::VectorXd volume;                // per amplitude [m^2]
  std::array<Eigen::VectorXd, 2> domes;  // by Side [1]
};

absl::Status AddAll(const JointModel& model, const Evidence& evidence, const Halves& halves, std::uint64_t split,
                    FitSpace& space, AllResiduals& all) {
  if (evidence.landmarks.size() > 0) {
    absl::Status status = AddLandmarks(evidence.landmarks_kind, evidence.landmarks, halves, model.person, space, all);
    if (!status.ok()) return status;
  }
  for (const Evidence::SurfaceFile& file : evidence.surfaces) {
    absl::Status status = AddSurface(file.kind, file.surfaces, model.person, split, all, space);
    if (!status.ok()) return status;
  }
  for (const Evidence::TraceFile& file : evidence.traces) {
    AddTrace(file.kind, file.breaths, file.traced == Traced::kVolume ? model.volume : model.domes[file.side], space,
             all);
  }
  for (const Evidence::MarkerFile& file : evidence.markers) {
    absl::Status status = AddMarkers(file.kind, file.markers, model.person, split, space, all);
    if (!status.ok()) return status;
  }
  if (!all.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "there is nothing to fit: give landmarks, a surface, a volume, an M-mode or markers");
}

double RmsOf(const Residuals& residuals, const Eigen::VectorXd& numbers, Part part) {
  const Rows rows = residuals.At(numbers, part);
  if (rows.residual.size() == 0) return std::nan("");
  return std::sqrt(rows.residual.squaredNorm() / static_cast<double>(rows.residual.size()) *
                   residuals.kind().rows_per_datum);
}

KindReport ReportOf(const Residuals& residuals, const FitSpace& space, const Eigen::VectorXd& found) {
  const auto count = [&](Part part) {
    return static_cast<int>(residuals.At(found, part).residual.size()) / residuals.kind().rows_per_datum;
  };
  const Eigen::VectorXd still = residuals.Still(space.Mean(), space.amplitudes());
  return {residuals.kind(),
          count(Part::kFitting),
          count(Part::kHeldOut),
          RmsOf(residuals, still, Part::kFitting),
          RmsOf(residuals, space.Mean(), Part::kFitting),
          RmsOf(residuals, found, Part::kFitting),
          RmsOf(residuals, still, Part::kHeldOut),
          RmsOf(residuals, found, Part::kHeldOut)};
}

FittedQuantity QuantityAt(const FitSpace& space, const JointSolution& solution, const Eigen::MatrixXd& prior,
                          Eigen::Index k) {
  FittedQuantity quantity = {space.numbers()[static_cast<size_t>(k)], solution.numbers[k],
                             std::sqrt(solution.covariance(k, k)), false, false};
  quantity.number.sd = std::sqrt(prior(k, k));
  quantity.determined = quantity.standard_error < quantity.number.sd / 2;
  quantity.at_bound = quantity.value <= quantity.number.low || quantity.value >= quantity.number.high;
  return quantity;
}

// A number that follows from the fitted ones.
struct Follows {
  const char *name, *what, *unit;
  double per_unit;
  std::function<double(const Eigen::VectorXd&)> at;
};

// Returns the standard deviation of a function of the numbers, by its gradient.
double DeltaSpread(const Follows& follows, const Eigen::VectorXd& at, const Eigen::MatrixXd& covariance,
                   const Eigen::VectorXd& sizes) {
  Eigen::VectorXd gradient(at.size());
  for (Eigen::Index k = 0; k < at.size(); ++k) {
    const double step = 1e-4 * sizes[k];
    Eigen::VectorXd more = at, less = at;
    more[k] += step;
    less[k] -= step;
    gradient[k] = (follows.at(more) - follows.at(less)) / (2 * step);
  }
  return std::sqrt(std::max(0.0, gradient.dot(covariance * gradient)));
}

// Returns the part of the gain of volume that the bases' modes make.
double AbdominalShare(const JointModel& model, const Eigen::VectorXd& numbers) {
  double base = 0;
  const std::vector<Amplitude>& amplitudes = model.person.amplitudes();
  for (size_t k = 0; k < amplitudes.size(); ++k) {
    const int mode = amplitudes[k].mode;
    const auto at = static_cast<Eigen::Index>(k);
    if (mode == kPiston || mode == kTiltFrontBack || mode == kTiltLeftRight || mode == kDome) {
      base += model.volume[at] * numbers[at];
    }
  }
  return base / model.volume.dot(numbers.head(model.volume.size()));
}

std::vector<Follows> FollowingNumbers(const JointModel& model, const FitSpace& space) {
  const Eigen::Index n = space.amplitudes();
  std::vector<Follows> all = {
      {"tidal volume", "that the lungs gain from exhale to inhale", "l", 1e-3,
       [&model, n](const Eigen::VectorXd& x) { return model.volume.dot(x.head(n)); }},
      {"right dome", "descent of the middle of the right base", "mm", 1e-3,
       [&model, n](const Eigen::VectorXd& x) { return model.domes[kRight].dot(x.head(n)); }},
      {"left dome", "descent of the middle of the left base", "mm", 1e-3,
       [&model, n](const Eigen::VectorXd& x) { return model.domes[kLeft].dot(x.head(n)); }},
      {"abdominal share", "part of the tidal volume that the bases make, the rest is the walls'", "1", 1,
       [&model](const Eigen::VectorXd& x) { return AbdominalShare(model, x); }}};
  const int length = space.Find(kBreathLength), share = space.Find(kInspiratoryShare);
  if (length >= 0) {
    all.push_back(
        {"rate", "breaths a minute", "1/min", 1, [length](const Eigen::VectorXd& x) { return 60 / x[length]; }});
  }
  if (share >= 0) {
    all.push_back({"E:I", "time of expiration and pause over that of inspiration", "1", 1,
                   [share](const Eigen::VectorXd& x) { return 1 / x[share] - 1; }});
  }
  return all;
}

std::vector<FittedQuantity> DeriveAll(const JointModel& model, const FitSpace& space, const JointSolution& solution) {
  const Eigen::VectorXd mean = space.Mean();
  const Eigen::MatrixXd prior = space.Covariance();
  const Eigen::VectorXd sizes = prior.diagonal().cwiseSqrt();
  std::vector<FittedQuantity> derived;
  for (const Follows& follows : FollowingNumbers(model, space)) {
    FittedQuantity quantity = {};
    quantity.number = {follows.name,     follows.what,     follows.unit,
                       follows.per_unit, follows.at(mean), DeltaSpread(follows, mean, prior, sizes),
                       -HUGE_VAL,        HUGE_VAL};
    quantity.value = follows.at(solution.numbers);
    quantity.standard_error = DeltaSpread(follows, solution.numbers, solution.covariance, sizes);
    quantity.determined = quantity.standard_error < quantity.number.sd / 2;
    derived.push_back(quantity);
  }
  return derived;
}

Eigen::MatrixXd CorrelationOf(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd inverse = covariance.diagonal().cwiseSqrt().cwiseInverse();
  return inverse.asDiagonal() * covariance * inverse.asDiagonal();
}

// Warns of data that contradict each other, the prior or their errors.
void AddDoubts(const FitSpace& space, const AllResiduals& all, JointFit& fit) {
  std::vector<std::string>& doubts = fit.motion.registered.doubts;
  for (const auto& residuals : all) {
    doubts.insert(doubts.end(), residuals->doubts().begin(), residuals->doubts().end());
  }
  for (const KindReport& each : fit.kinds) {
    const double error = each.kind.sd * std::sqrt(each.kind.rows_per_datum);
    if (!(each.after > kBadly * error)) continue;
    doubts.push_back(absl::StrFormat(
        "%s (%s): the fit leaves %.3g %s, its error is %.3g %s: they contradict the other data or the model; look at "
        "them, or give a larger --error",
        each.kind.source, each.kind.kind, each.after / each.kind.per_unit, each.kind.unit,
        each.kind.sd / each.kind.per_unit, each.kind.unit));
  }
  Eigen::VectorXd off(space.amplitudes());
  for (Eigen::Index k = 0; k < off.size(); ++k) {
    const FittedQuantity& each = fit.numbers[static_cast<size_t>(k)];
    off[k] = each.value - each.number.mean;
  }
  const Eigen::MatrixXd precision = space.Precision().topLeftCorner(off.size(), off.size());
  const double distance = std::sqrt(off.dot(precision * off) / static_cast<double>(off.size()));
  if (distance > 2.5) {
    doubts.push_back(absl::StrFormat(
        "this breath lies %.1f standard deviations from what people do: where data are few, the fit leans to them",
        distance));
  }
  if (fit.motion.volume < 0) {
    doubts.push_back("the lungs lose volume from exhale to inhale: are the two exchanged?");
  }
}

// Judges the landmarks at the end of inspiration, as a fit to them alone does.
void JudgeLandmarks(const Person& person, const Evidence& evidence, const Halves& halves, JointFit& fit) {
  std::vector<int> at_inhale, place(static_cast<size_t>(evidence.landmarks.size()), -1);
  for (int i = 0; i < static_cast<int>(evidence.landmarks.size()); ++i) {
    if (evidence.landmarks.phase[i] != 1) continue;
    place[static_cast<size_t>(i)] = static_cast<int>(at_inhale.size());
    at_inhale.push_back(i);
  }
  const auto moved = [&](const std::vector<int>& indices) {
    std::vector<int> own;
    for (const int i : indices) {
      if (place[static_cast<size_t>(i)] >= 0) own.push_back(place[static_cast<size_t>(i)]);
    }
    return own;
  };
  MotionFit& motion = fit.motion;
  motion.halves = {moved(halves.fitting), moved(halves.held_out)};
  motion.exhale = evidence.landmarks.exhale(Eigen::all, at_inhale);
  motion.motion = evidence.landmarks.motion(Eigen::all, at_inhale);
  motion.predicted = (person.Responses(motion.exhale) * motion.person.amplitudes).reshaped(3, motion.exhale.cols());
  const Points difference = motion.motion - motion.predicted;
  motion.fitting = Summarise(difference, motion.halves.fitting);
  motion.held_out = Summarise(difference, motion.halves.held_out);
  if (motion.halves.fitting.size() < 12 || motion.halves.held_out.empty()) return;
  motion.baselines = FitBaselines(motion.exhale, motion.motion, motion.halves);
  motion.regions = ErrorsByRegion(person.PlacesAt(motion.exhale), person.LeftOnes(motion.exhale), motion.motion,
                                  difference, motion.halves.held_out);
}

void SetNumbers(const JointModel& model, const FitSpace& space, const JointSolution& solution,
                const PeopleMotion& people, JointFit& fit) {
  const Eigen::MatrixXd prior = space.Covariance();
  for (Eigen::Index k = 0; k < space.size(); ++k) fit.numbers.push_back(QuantityAt(space, solution, prior, k));
  fit.correlation = CorrelationOf(solution.covariance);
  fit.derived = DeriveAll(model, space, solution);
  const Eigen::Index n = space.amplitudes();
  MotionFit& motion = fit.motion;
  motion.person.amplitudes = solution.numbers.head(n);
  motion.correlation = fit.correlation.topLeftCorner(n, n);
  motion.volume = model.volume.dot(motion.person.amplitudes);
  const Eigen::VectorXd domes = model.domes[kRight] + model.domes[kLeft];
  motion.descent = motion.person.descent = domes.dot(motion.person.amplitudes) / domes.dot(people.mean);
  for (Eigen::Index k = 0; k < n; ++k) {
    const FittedQuantity& each = fit.numbers[static_cast<size_t>(k)];
    motion.parameters.push_back(
        {each.number.name, each.number.what, each.value, each.standard_error, each.number.sd, each.determined});
  }
  const auto at = [&](const char* name) {
    const int found = space.Find(name);
    return found < 0 ? 0 : solution.numbers[found];
  };
  fit.breath_length = at(kBreathLength);
  fit.inspiratory_share = at(kInspiratoryShare);
  fit.pause_share = at(kPauseShare);
}

}  // namespace

absl::StatusOr<JointFit> FitJointly(const LungTemplates& templates, const Evidence& evidence, const FitOptions& options,
                                    const FitProgress& progress) {
  const auto cancelled = [&](double done, std::string_view stage) { return progress && !progress(done, stage); };
  if (cancelled(0, "registering")) return absl::CancelledError("interrupted");
  JointFit fit;
  const Halves halves = HalvesOf(evidence.landmarks, options.split);
  const auto registered = ShapeLungs(templates, evidence, halves, fit.own_lungs);
  if (!registered.ok()) return registered.status();
  fit.motion.registered = *registered;
  if (absl::Status status = CheckInside(templates, *registered, evidence); !status.ok()) return status;
  const std::function<bool()> stop = [&] { return cancelled(0.3, "solving"); };
  const auto person = Person::Make(templates, *registered, BreathAmplitudes(options.numbers), options.elasticity, stop);
  if (!person.ok()) return person.status();
  const JointModel model = {
      *person, person->VolumeResponses(), {DomeResponses(*person, kRight), DomeResponses(*person, kLeft)}};
  const PeopleMotion& people = ShippedPeople(options.numbers);
  FitSpace space(person->amplitudes(), people);
  AllResiduals all;
  if (absl::Status status = AddAll(model, evidence, halves, options.split, space, all); !status.ok()) return status;
  const auto solution = SolveJointly(space, all, [&] { return cancelled(0.8, "fitting"); });
  if (!solution.ok()) return solution.status();
  SetNumbers(model, space, *solution, people, fit);
  for (const auto& residuals : all) fit.kinds.push_back(ReportOf(*residuals, space, solution->numbers));
  JudgeLandmarks(*person, evidence, halves, fit);
  AddDoubts(space, all, fit);
  return fit;
}

}  // namespace phrenic::fit
