#include "server/compare/moments.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"

namespace phrenic::compare {
namespace {

// Tolerance of a time [s]: files write nine digits.
double Slack(double time) { return 1e-8 * std::max(1.0, std::abs(time)); }

// Maps the times linearly onto the interval of `onto`.
std::vector<double> Stretched(std::vector<double> times, const std::vector<double>& onto) {
  const double first = times.front(), length = times.back() - first;
  for (double& time : times) time = onto.front() + (time - first) / length * (onto.back() - onto.front());
  return times;
}

}  // namespace

std::optional<Between> FindTime(const std::vector<double>& times, double time) {
  if (time < times.front() - Slack(time) || time > times.back() + Slack(time)) return std::nullopt;
  const auto later = std::upper_bound(times.begin(), times.end(), time);
  const auto step = std::clamp<std::ptrdiff_t>(later - times.begin() - 1, 0, std::ssize(times) - 2);
  const double first = times[static_cast<std::size_t>(step)], second = times[static_cast<std::size_t>(step) + 1];
  return Between{static_cast<int>(step), std::clamp((time - first) / (second - first), 0.0, 1.0)};
}

absl::StatusOr<MatchedMoments> MatchTimes(const meshio::Motion& a, const meshio::Motion& b, bool match_phases) {
  MatchedMoments moments;
  if (!a.moves() && !b.moves()) {
    moments.pairs.push_back({});
    return moments;
  }
  const std::vector<double>& times = a.moves() ? a.times : b.times;
  const bool both = a.moves() && b.moves();
  const std::vector<double> others = both && match_phases ? Stretched(b.times, a.times) : b.times;
  for (int step = 0; step < static_cast<int>(times.size()); ++step) {
    const double time = times[static_cast<std::size_t>(step)];
    const auto in_b = both ? FindTime(others, time) : std::optional(Between{a.moves() ? 0 : step, 0});
    if (!in_b) {
      ++moments.left_out;
      continue;
    }
    moments.pairs.push_back({time, {a.moves() ? step : 0, 0}, *in_b});
  }
  if (!moments.pairs.empty()) return moments;
  return absl::FailedPreconditionError(absl::StrFormat(
      "the motions have no common time: A has %g to %g s, B %g to %g s; record B over A's times, or set "
      "match_phases",
      times.front(), times.back(), others.front(), others.back()));
}

Points PositionsAt(const meshio::Motion& motion, const Between& at) {
  if (motion.displacements.empty()) return motion.mesh.vertices;
  const auto step = static_cast<std::size_t>(at.step);
  if (at.weight == 0) return motion.mesh.vertices + motion.displacements[step];
  return motion.mesh.vertices + (1 - at.weight) * motion.displacements[step] +
         at.weight * motion.displacements[step + 1];
}

}  // namespace phrenic::compare
