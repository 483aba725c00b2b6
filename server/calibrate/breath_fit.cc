#include "server/calibrate/breath_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <set>
#include <thread>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/calibrate/bounded_descent.h"
#include "server/physiology/plan.h"

namespace phrenic::calibrate {
namespace {

using fit::Part;
using physiology::Recording;

constexpr double kDifference = 0.15;  // of the derivatives, in prior standard deviations
constexpr double kBadlyMet = 2.5;     // residuals in standard errors
const char* const kDerived[] = {"tidal-volume", "right-dome", "left-dome", "abdominal-share"};

const Target* TargetNamed(std::string_view name) {
  for (const Target& target : Targets()) {
    if (name == target.name) return &target;
  }
  return nullptr;
}

// Simulates breaths side by side.
class Simulations {
 public:
  Simulations(const physiology::Subject& subject, const v1::Parameters& start,
              const std::vector<FittedParameter>& parameters, const BreathFitOptions& options,
              BreathFitProgress progress)
      : subject_(subject), start_(start), parameters_(parameters), options_(options), progress_(progress) {}

  v1::Parameters At(const Eigen::VectorXd& values) const {
    v1::Parameters parameters = start_;
    for (size_t k = 0; k < parameters_.size(); ++k) {
      SetValue(parameters_[k].varied, values[static_cast<Eigen::Index>(k)], parameters);
    }
    return parameters;
  }

  // Returns the breath of each of the points.
  absl::StatusOr<std::vector<Recording>> Run(const std::vector<Eigen::VectorXd>& points, double done) {
    std::vector<absl::StatusOr<Recording>> breaths(points.size(), absl::CancelledError("interrupted"));
    std::atomic<size_t> next = 0, ended = 0;
    std::atomic<bool> stop = false;
    const auto work = [&] {
      for (size_t i = next++; i < points.size(); i = next++) {
        breaths[i] = physiology::Record(
            subject_, "fitted", At(points[i]), [&stop](double) { return !stop; }, physiology::FlawSearch::kNever);
        ++ended;
      }
    };
    std::vector<std::thread> threads;
    const size_t wanted = options_.threads > 0 ? static_cast<size_t>(options_.threads)
                                               : std::max(1u, std::thread::hardware_concurrency());
    for (size_t i = 0; i < std::min(wanted, points.size()); ++i) threads.emplace_back(work);
    while (ended < points.size()) {
      if (!stop && !progress_(done, absl::StrCat("breath ", simulated_ + static_cast<int>(ended.load()) + 1))) {
        stop = true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    for (std::thread& thread : threads) thread.join();
    simulated_ += static_cast<int>(points.size());
    std::vector<Recording> all;
    for (absl::StatusOr<Recording>& breath : breaths) {
      if (!breath.ok()) return breath.status();
      if (!breath->problem.empty()) return absl::FailedPreconditionError(breath->problem);
      all.push_back(*std::move(breath));
    }
    return all;
  }

  int simulated() const { return simulated_; }

 private:
  const physiology::Subject& subject_;
  const v1::Parameters& start_;
  const std::vector<FittedParameter>& parameters_;
  const BreathFitOptions& options_;
  BreathFitProgress progress_;
  int simulated_ = 0;
};

// The numbers, the parameters first, in units of their priors' standard deviations about their priors' means.
class BreathProblem {
 public:
  BreathProblem(const std::vector<FittedParameter>& parameters, const AllBreathData& data)
      : parameters_(parameters), data_(data) {
    for (const FittedParameter& each : parameters) {
      const v1::Quantity& quantity = QuantityOf(each.varied);
      numbers_.push_back({each.varied.field->name(), quantity.label(), quantity.unit(), 1, each.prior, each.prior_sd,
                          each.varied.low, each.varied.high});
    }
    for (const auto& kind : data) {
      for (const BreathData::OwnNumber& own : kind->OwnNumbers()) {
        numbers_.push_back({own.name, "of the data", own.unit, own.per_unit, 0, own.sd, -20 * own.sd, 20 * own.sd});
      }
    }
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(numbers_.size()); }
  Eigen::Index parameters() const { return static_cast<Eigen::Index>(parameters_.size()); }
  const fit::FitNumber& number(Eigen::Index k) const { return numbers_[static_cast<size_t>(k)]; }
  Eigen::VectorXd Means() const {
    Eigen::VectorXd means(size());
    for (Eigen::Index k = 0; k < size(); ++k) means[k] = number(k).mean;
    return means;
  }
  Eigen::VectorXd Sds() const {
    Eigen::VectorXd sds(size());
    for (Eigen::Index k = 0; k < size(); ++k) sds[k] = number(k).sd;
    return sds;
  }
  Eigen::VectorXd Lows() const {
    Eigen::VectorXd lows(size());
    for (Eigen::Index k = 0; k < size(); ++k) lows[k] = number(k).low;
    return lows;
  }
  Eigen::VectorXd Highs() const {
    Eigen::VectorXd highs(size());
    for (Eigen::Index k = 0; k < size(); ++k) highs[k] = number(k).high;
    return highs;
  }
  Eigen::VectorXd Bounded(Eigen::VectorXd x) const {
    for (Eigen::Index k = 0; k < size(); ++k) x[k] = std::clamp(x[k], number(k).low, number(k).high);
    return x;
  }

  // The points of the differences: each parameter moved by a part of its prior's standard deviation, away from its
  // nearer bound.
  double DifferenceOf(const Eigen::VectorXd& x, Eigen::Index k) const {
    const fit::FitNumber& of = number(k);
    const double room = std::max(of.high - x[k], x[k] - of.low);
    const double step = std::min(kDifference * of.sd, room / 2);
    return of.high - x[k] >= x[k] - of.low ? step : -step;
  }
  std::vector<Eigen::VectorXd> Differences(const Eigen::VectorXd& x) const {
    std::vector<Eigen::VectorXd> points;
    for (Eigen::Index k = 0; k < parameters(); ++k) {
      points.push_back(x);
      points.back()[k] += DifferenceOf(x, k);
    }
    return points;
  }

  double Value(const Recording& breath, const Eigen::VectorXd& x) const {
    double value = (x - Means()).cwiseQuotient(Sds()).squaredNorm();
    EachKind([&](const BreathData& kind, Eigen::Index first, Eigen::Index count) {
      const Eigen::VectorXd off =
          kind.Values(Part::kFitting) - kind.Predict(breath, x.segment(first, count), Part::kFitting, nullptr);
      value += off.cwiseAbs2().dot(kind.Weights(Part::kFitting));
    });
    return value;
  }

  // Half the curvature and half the descending gradient, by the numbers over their priors' standard deviations.
  void Expand(const Recording& breath, const std::vector<Recording>& moved, const Eigen::VectorXd& x,
              Eigen::MatrixXd& curvature, Eigen::VectorXd& descent) const {
    const Eigen::VectorXd sds = Sds();
    curvature = Eigen::MatrixXd::Identity(size(), size());
    descent = -(x - Means()).cwiseQuotient(sds);
    EachKind([&](const BreathData& kind, Eigen::Index first, Eigen::Index count) {
      const Eigen::VectorXd own = x.segment(first, count);
      Eigen::MatrixXd slopes;
      const Eigen::VectorXd at = kind.Predict(breath, own, Part::kFitting, &slopes);
      Eigen::MatrixXd j = Eigen::MatrixXd::Zero(at.size(), size());
      for (Eigen::Index k = 0; k < parameters(); ++k) {
        const Eigen::VectorXd there = kind.Predict(moved[static_cast<size_t>(k)], own, Part::kFitting, nullptr);
        j.col(k) = (there - at) * (sds[k] / DifferenceOf(x, k));
      }
      if (count > 0) j.middleCols(first, count) = slopes * sds.segment(first, count).asDiagonal();
      const Eigen::VectorXd weights = kind.Weights(Part::kFitting);
      curvature += j.transpose() * weights.asDiagonal() * j;
      descent += j.transpose() * weights.cwiseProduct(kind.Values(Part::kFitting) - at);
    });
  }

  template <typename Visit>
  void EachKind(Visit visit) const {
    Eigen::Index first = parameters();
    for (const auto& kind : data_) {
      const auto count = static_cast<Eigen::Index>(kind->OwnNumbers().size());
      visit(*kind, first, count);
      first += count;
    }
  }

 private:
  const std::vector<FittedParameter>& parameters_;
  const AllBreathData& data_;
  std::vector<fit::FitNumber> numbers_;
};

double RmsOfBreath(const Eigen::VectorXd& off) {
  return off.size() == 0 ? std::nan("") : std::sqrt(off.squaredNorm() / static_cast<double>(off.size()));
}

std::vector<fit::KindReport> ReportKinds(const BreathProblem& problem, const Recording& before, const Recording& after,
                                         const Eigen::VectorXd& x) {
  std::vector<fit::KindReport> reports;
  problem.EachKind([&](const BreathData& kind, Eigen::Index first, Eigen::Index count) {
    const auto off = [&](const Recording& breath, const Eigen::VectorXd& own, Part part) {
      return RmsOfBreath(kind.Values(part) - kind.Predict(breath, own, part, nullptr));
    };
    const auto still = [&](Part part) { return RmsOfBreath(kind.Values(part) - kind.Still(part)); };
    const Eigen::VectorXd own = x.segment(first, count), none = Eigen::VectorXd::Zero(count);
    reports.push_back({kind.kind(), static_cast<int>(kind.Values(Part::kFitting).size()),
                       static_cast<int>(kind.Values(Part::kHeldOut).size()), still(Part::kFitting),
                       off(before, none, Part::kFitting), off(after, own, Part::kFitting), still(Part::kHeldOut),
                       off(after, own, Part::kHeldOut)});
  });
  return reports;
}

fit::FittedQuantity QuantityOfFit(const fit::FitNumber& number, double value, double error) {
  fit::FittedQuantity quantity = {number, value, error, error < number.sd / 2, false};
  const double margin = 1e-6 * (number.high - number.low);
  quantity.at_bound = std::isfinite(margin) && (value <= number.low + margin || value >= number.high - margin);
  return quantity;
}

// What follows of the breath, with the error by the differences.
std::vector<fit::FittedQuantity> DeriveFrom(const BreathProblem& problem, const Recording& before,
                                            const Recording& after, const std::vector<Recording>& moved,
                                            const Eigen::VectorXd& x, const Eigen::MatrixXd& covariance) {
  std::vector<fit::FittedQuantity> derived;
  for (const char* name : kDerived) {
    const Target& target = *TargetNamed(name);
    const auto read = [&](const Recording& breath) { return target.scale * target.measure(breath, breath); };
    Eigen::VectorXd slope(problem.parameters());
    for (Eigen::Index k = 0; k < slope.size(); ++k) {
      slope[k] = (read(moved[static_cast<size_t>(k)]) - read(after)) / problem.DifferenceOf(x, k);
    }
    if (!std::isfinite(read(after))) continue;
    const Eigen::Index n = problem.parameters();
    const double error = std::sqrt(std::max(0.0, slope.dot(covariance.topLeftCorner(n, n) * slope)));
    const double prior = slope.cwiseProduct(problem.Sds().head(n)).norm();
    derived.push_back(QuantityOfFit({name, target.help, target.unit, 1, read(before), prior, -HUGE_VAL, HUGE_VAL},
                                    read(after), error));
  }
  return derived;
}

void DoubtBreath(const AllBreathData& data, BreathFit& fit) {
  for (const auto& kind : data) fit.doubts.insert(fit.doubts.end(), kind->doubts().begin(), kind->doubts().end());
  for (const fit::KindReport& each : fit.kinds) {
    if (!(each.after > kBadlyMet * each.kind.sd)) continue;
    fit.doubts.push_back(absl::StrFormat(
        "%s (%s): the simulation is off by %.3g %s, the data's error is %.3g %s: these parameters cannot make this "
        "breath, or the data contradict each other; fit other --parameters too, or give a larger --error",
        each.kind.source, each.kind.kind, each.after / each.kind.per_unit, each.kind.unit,
        each.kind.sd / each.kind.per_unit, each.kind.unit));
  }
}

absl::Status CheckBreathTask(const physiology::Subject& subject, const std::vector<FittedParameter>& parameters,
                             const AllBreathData& data) {
  if (data.empty()) return absl::InvalidArgumentError("there is nothing to fit: give --volume, --m-mode or --markers");
  if (parameters.empty()) return absl::InvalidArgumentError("no parameter is fitted");
  std::set<const google::protobuf::FieldDescriptor*> fields;
  for (const FittedParameter& each : parameters) {
    if (fields.insert(each.varied.field).second) continue;
    return absl::InvalidArgumentError(absl::StrCat(each.varied.field->name(), " is fitted twice"));
  }
  if (physiology::Has(subject, physiology::Needs::kPressures)) return absl::OkStatus();
  return absl::FailedPreconditionError(
      "the scene has no pressures, so that nothing breathes by its activations: fit a scene such as thorax");
}

// The sum of squares of a fit, with the breath at the search's place.
class BreathSquares : public SquaresProblem {
 public:
  BreathSquares(const BreathProblem& problem, Simulations& simulations)
      : problem_(problem), simulations_(simulations), sds_(problem.Sds()), x_(problem.Bounded(problem.Means())) {}

  absl::StatusOr<double> Begin() {
    absl::StatusOr<double> sum = Try(x_.cwiseQuotient(sds_));
    if (!sum.ok()) return sum;
    Accept();
    if (std::isfinite(*sum)) return sum;
    return absl::FailedPreconditionError(
        "the breath that the fit begins with lacks what was measured: begin with another --preset");
  }

  absl::StatusOr<double> Try(const Eigen::VectorXd& scaled) override {
    tried_ = problem_.Bounded(scaled.cwiseProduct(sds_));
    auto next = simulations_.Run({tried_}, done);
    if (!next.ok()) return next.status();
    next_ = std::move(next->front());
    return problem_.Value(next_, tried_);
  }
  void Accept() override {
    x_ = tried_;
    now_ = std::move(next_);
  }
  absl::StatusOr<Quadratic> Expand() override {
    auto there = simulations_.Run(problem_.Differences(x_), done);
    if (!there.ok()) return there.status();
    moved_ = *std::move(there);
    Quadratic at;
    problem_.Expand(now_, moved_, x_, at.curvature, at.descent);
    return at;
  }

  const Eigen::VectorXd& x() const { return x_; }
  const Recording& now() const { return now_; }
  const std::vector<Recording>& moved() const { return moved_; }  // the differences

  double done = 0;  // of the fit, for the progress

 private:
  const BreathProblem& problem_;
  Simulations& simulations_;
  const Eigen::VectorXd sds_;
  Eigen::VectorXd x_, tried_;
  Recording now_, next_;
  std::vector<Recording> moved_;
};

// Returns how the search ended, with the quadratic at its end.
absl::StatusOr<Settling> Descend(BreathSquares& squares, BoundedDescent& search, int iterations) {
  for (int i = 0; i < iterations; ++i) {
    squares.done = static_cast<double>(i) / iterations;
    absl::StatusOr<Settling> settling = search.Step();
    if (!settling.ok() || *settling != Settling::kGoesOn) return settling;
  }
  squares.done = 1;
  if (absl::Status status = search.Expand(); !status.ok()) return status;
  return Settling::kGoesOn;
}

// Says why the search has not settled, and what ended at its bound.
void DoubtSearch(Settling settling, int without_sum, BreathFit& fit) {
  if (settling == Settling::kGoesOn) fit.doubts.push_back("the search had not settled at its limit of iterations");
  if (settling == Settling::kStuck) {
    fit.doubts.push_back(
        absl::StrFormat("the search has not settled: no shorter step came nearer to the data (%d of its last trials "
                        "diverged, or lacked "
                        "what was measured); begin with another --preset, or fit narrower --parameters NAME:LOW:HIGH",
                        without_sum));
  }
  for (const fit::FittedQuantity& each : fit.numbers) {
    if (!each.at_bound) continue;
    fit.doubts.push_back(absl::StrFormat(
        "%s is at its bound, %.4g%s: the data ask for more than it allows; its standard error is without "
        "the bound",
        each.number.name, each.value / each.number.per_unit, each.number.unit == "1" ? "" : " " + each.number.unit));
  }
}

}  // namespace

FittedParameter PriorOf(const Varied& varied, const v1::Parameters& start) {
  const double at = std::clamp(ValueOf(varied, start), varied.low, varied.high);
  const std::string& name = varied.field->name();
  double sd = (varied.high - varied.low) / 4;
  if (absl::EndsWith(name, "activation")) sd = std::max(0.6 * at, 0.05);
  if (absl::EndsWith(name, "_share")) sd = 0.08;
  if (absl::EndsWith(name, "compliance") && at > 0) sd = 0.35 * at;
  return {varied, at, std::min(sd, varied.high - varied.low)};
}

absl::StatusOr<BreathFit> FitBreath(const physiology::Subject& subject, const v1::Parameters& start,
                                    const std::vector<FittedParameter>& parameters, const AllBreathData& data,
                                    const BreathFitOptions& options, BreathFitProgress progress) {
  if (absl::Status status = CheckBreathTask(subject, parameters, data); !status.ok()) return status;
  const BreathProblem problem(parameters, data);
  Simulations simulations(subject, start, parameters, options, progress);
  BreathSquares squares(problem, simulations);
  const absl::StatusOr<double> sum = squares.Begin();
  if (!sum.ok()) return sum.status();
  const Recording before = squares.now();
  const Eigen::VectorXd sds = problem.Sds();
  BoundedDescent search(squares, squares.x().cwiseQuotient(sds), *sum, problem.Lows().cwiseQuotient(sds),
                        problem.Highs().cwiseQuotient(sds));
  const absl::StatusOr<Settling> settling = Descend(squares, search, options.iterations);
  if (!settling.ok()) return settling.status();
  BreathFit fit;
  fit.converged = *settling == Settling::kSettled;
  const Eigen::VectorXd& x = squares.x();
  const Eigen::MatrixXd scaled =
      search.quadratic().curvature.ldlt().solve(Eigen::MatrixXd::Identity(x.size(), x.size()));
  const Eigen::MatrixXd covariance = sds.asDiagonal() * scaled * sds.asDiagonal();
  const Eigen::VectorXd errors = covariance.diagonal().cwiseSqrt(), inverse = errors.cwiseInverse();
  for (Eigen::Index k = 0; k < x.size(); ++k) fit.numbers.push_back(QuantityOfFit(problem.number(k), x[k], errors[k]));
  fit.correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  fit.derived = DeriveFrom(problem, before, squares.now(), squares.moved(), x, covariance);
  fit.kinds = ReportKinds(problem, before, squares.now(), x);
  fit.parameters = simulations.At(x);
  fit.breaths = simulations.simulated();
  DoubtBreath(data, fit);
  DoubtSearch(*settling, search.without_sum(), fit);
  return fit;
}

}  // namespace phrenic::calibrate
