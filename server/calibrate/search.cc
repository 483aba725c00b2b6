#include "server/calibrate/search.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic::calibrate {
namespace {

constexpr double kUnmeasurable = 10;  // the deviation where there is nothing to measure: far from any goal

using Optimiser = std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)>;

double Largest(const Numbers& deviations) {
  double largest = 0;
  for (const double each : deviations) largest = std::max(largest, std::abs(each));
  return largest;
}

double SumOfSquares(const Numbers& deviations) {
  double sum = 0;
  for (const double each : deviations) sum += each * each;
  return sum;
}

// The objective of NLopt: rounds points, remembers what was tried, and stops the optimiser.
class Objective {
 public:
  Objective(const SearchSpace& space, const SearchLimits& limits, Deviations deviations, nlopt_opt optimiser)
      : space_(space), limits_(limits), deviations_(deviations), optimiser_(optimiser) {}

  static double Value(unsigned n, const double* x, double* /*gradient*/, void* self) {
    return static_cast<Objective*>(self)->At({x, n});
  }

  absl::StatusOr<Nearest> Take(nlopt_result result) {
    if (!error_.ok()) return error_;
    if (result < 0 && result != NLOPT_FORCED_STOP && result != NLOPT_ROUNDOFF_LIMITED) {
      return absl::InternalError(absl::StrCat("the search failed: ", nlopt_result_to_string(result)));
    }
    return nearest_;
  }

 private:
  double At(std::span<const double> x) {
    const Numbers point = Rounded(x);
    if (const auto known = tried_.find(point); known != tried_.end()) return known->second;
    if (nearest_.tries == limits_.tries) return Stop(Nearest::End::kTries);
    const auto deviations = deviations_(point);
    if (!deviations.ok()) {
      error_ = deviations.status();
      return Stop(Nearest::End::kConverged);
    }
    return tried_[point] = Note(point, *deviations);
  }

  Numbers Rounded(std::span<const double> x) const {
    Numbers point(x.begin(), x.end());
    for (size_t i = 0; i < point.size(); ++i) {
      double rounded = 0;
      if (absl::SimpleAtod(absl::StrFormat("%.4g", point[i]), &rounded)) point[i] = rounded;
      point[i] = std::clamp(point[i], space_.low[i], space_.high[i]);
    }
    return point;
  }

  double Note(const Numbers& point, Numbers deviations) {
    for (double& each : deviations) each = std::isfinite(each) ? each : kUnmeasurable;
    const double sum = SumOfSquares(deviations), largest = Largest(deviations);
    if (++nearest_.tries == 1 || sum < SumOfSquares(nearest_.deviations) || largest <= limits_.tolerance) {
      nearest_.at = point, nearest_.deviations = std::move(deviations), nearest_.largest = largest;
    }
    if (largest <= limits_.tolerance) Stop(Nearest::End::kReached);
    return sum;
  }

  double Stop(Nearest::End end) {
    nearest_.end = end;
    nlopt_force_stop(optimiser_);
    return HUGE_VAL;
  }

  const SearchSpace& space_;
  const SearchLimits& limits_;
  Deviations deviations_;
  nlopt_opt optimiser_;
  std::map<Numbers, double> tried_;
  Nearest nearest_;
  absl::Status error_;
};

}  // namespace

absl::StatusOr<Nearest> Search(const SearchSpace& space, const SearchLimits& limits, Deviations deviations) {
  const auto n = static_cast<unsigned>(space.start.size());
  const Optimiser optimiser(nlopt_create(NLOPT_LN_BOBYQA, n), &nlopt_destroy);
  Objective objective(space, limits, deviations, optimiser.get());
  Numbers x = space.start, step = space.step, resolved(n);
  for (unsigned i = 0; i < n; ++i) {
    step[i] = std::min(step[i], (space.high[i] - space.low[i]) / 4);  // BOBYQA needs two steps between the bounds
    resolved[i] = limits.tolerance / 2 * step[i];
  }
  nlopt_set_min_objective(optimiser.get(), &Objective::Value, &objective);
  nlopt_set_lower_bounds(optimiser.get(), space.low.data());
  nlopt_set_upper_bounds(optimiser.get(), space.high.data());
  nlopt_set_initial_step(optimiser.get(), step.data());
  nlopt_set_xtol_abs(optimiser.get(), resolved.data());
  double least = 0;
  return objective.Take(nlopt_optimize(optimiser.get(), x.data(), &least));
}

}  // namespace phrenic::calibrate
