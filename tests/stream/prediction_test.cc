// The fast prediction is the exact one, or says that it may not be.
#include "server/stream/decoder/prediction.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace phrenic::stream {
namespace {

// An irregular grid of 12 x 12 vertices.
NeighbourWeights GridWeights() {
  constexpr int kSide = 12;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uneven(0, 0.4F);
  std::vector<float> rest;
  std::vector<int> edges;
  for (int i = 0; i < kSide * kSide; ++i) {
    for (const int at : {i % kSide, i / kSide, 0}) rest.push_back(static_cast<float>(at) + uneven(random));
    if (i % kSide > 0) edges.insert(edges.end(), {i - 1, i});
    if (i >= kSide) edges.insert(edges.end(), {i - kSide, i});
  }
  return MakeNeighbourWeights({.rest = rest, .edges = edges});
}

// The definition in proto/README.md, modulo 2^32.
PaddedSteps AsDefined(const NeighbourWeights& weights, PaddedSteps steps) {
  for (std::size_t place = 0; place < weights.order.size(); ++place) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::int64_t sum = kUnit / 2;
      for (int i = weights.first[place]; i < weights.first[place + 1]; ++i) {
        sum += std::int64_t{weights.weights[i]} * steps[4 * static_cast<std::size_t>(weights.places[i]) + axis];
      }
      steps[4 * place + axis] = static_cast<std::int32_t>(steps[4 * place + axis] + (sum >> 12));
    }
  }
  return steps;
}

TEST(Prediction, IsAsDefinedForSmallAndLargeResiduals) {
  const NeighbourWeights weights = GridWeights();
  const Prediction prediction(weights);
  std::mt19937 random(2);
  for (const double largest : {3.0, 3e3, 1e6, 2147483647.0}) {
    PaddedSteps residuals(4 * weights.order.size());
    std::uniform_real_distribution<double> some(-largest, largest);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (i % 4 < 3) residuals[i] = static_cast<std::int32_t>(some(random));
    }
    const PaddedSteps expected = AsDefined(weights, residuals);
    PaddedSteps fast = residuals, exact = residuals;
    const bool is_exact = prediction.AddFast(fast);
    prediction.AddExactly(exact);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (i % 4 == 3) continue;
      ASSERT_EQ(exact[i], expected[i]) << largest;
      if (is_exact) {
        ASSERT_EQ(fast[i], expected[i]) << largest;
      }
    }
    EXPECT_EQ(is_exact, largest < 1e4) << largest;
  }
}

TEST(Prediction, OneLargeValueIsNoticed) {
  const NeighbourWeights weights = GridWeights();
  const Prediction prediction(weights);
  for (const std::int32_t large : {1 << 30, -(1 << 30), INT32_MIN}) {
    for (const std::size_t place : {std::size_t{0}, weights.order.size() - 1}) {
      PaddedSteps steps(4 * weights.order.size());
      steps[4 * place + 1] = large;
      EXPECT_FALSE(prediction.AddFast(steps)) << large;
    }
  }
}

}  // namespace
}  // namespace phrenic::stream
