#include "server/study/uncertainty/samples.h"

#include <boost/random/sobol.hpp>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace phrenic::study {
namespace {

constexpr int kMorrisLowLevels = 2;  // of four, 0, 1/3, 2/3 and 1: those from which a step up stays in the cube

// Returns a number strictly within 0 and 1 of the leading 53 bits.
double UnitOf(std::uint64_t bits) { return std::ldexp(static_cast<double>(bits >> 11) + 0.5, -53); }

}  // namespace

UnitPoints SobolPoints(Eigen::Index count, Eigen::Index inputs, std::uint64_t seed) {
  boost::random::sobol sequence(static_cast<size_t>(inputs));
  std::mt19937_64 random(seed);
  std::vector<std::uint64_t> shift(static_cast<size_t>(inputs));
  for (std::uint64_t& each : shift) each = random();
  UnitPoints points(count, inputs);
  for (Eigen::Index row = 0; row < count; ++row) {
    for (Eigen::Index i = 0; i < inputs; ++i) points(row, i) = UnitOf(sequence() ^ shift[static_cast<size_t>(i)]);
  }
  return points;
}

UnitPoints MorrisPoints(Eigen::Index trajectories, Eigen::Index inputs, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  UnitPoints points(trajectories * (inputs + 1), inputs);
  std::vector<Eigen::Index> order(static_cast<size_t>(inputs));
  for (Eigen::Index t = 0; t < trajectories; ++t) {
    Eigen::VectorXd at(inputs), step(inputs);
    for (Eigen::Index i = 0; i < inputs; ++i) {
      const double low = static_cast<double>(random() % kMorrisLowLevels) / 3;
      const bool up = random() % 2 == 0;
      at[i] = up ? low : low + kMorrisStep;
      step[i] = up ? kMorrisStep : -kMorrisStep;
    }
    std::iota(order.begin(), order.end(), 0);
    for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    Eigen::Index row = t * (inputs + 1);
    points.row(row) = at.transpose();
    for (const Eigen::Index i : order) {
      at[i] += step[i];
      points.row(++row) = at.transpose();
    }
  }
  return points;
}

UnitPoints SaltelliPoints(Eigen::Index samples, Eigen::Index inputs, std::uint64_t seed) {
  const UnitPoints base = SobolPoints(samples, 2 * inputs, seed);
  UnitPoints points(samples * (inputs + 2), inputs);
  for (Eigen::Index j = 0; j < samples; ++j) {
    const Eigen::Index first = j * (inputs + 2);
    points.row(first) = base.row(j).head(inputs);
    points.row(first + 1) = base.row(j).tail(inputs);
    for (Eigen::Index i = 0; i < inputs; ++i) {
      points.row(first + 2 + i) = points.row(first);
      points(first + 2 + i, i) = base(j, inputs + i);
    }
  }
  return points;
}

}  // namespace phrenic::study
