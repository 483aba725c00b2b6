// Quantities of a cage with parts: fits go through what they are fitted to, derivatives are those of the function.
#include "server/mechanics/breathing/cage_quadratic.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace phrenic {
namespace {

double OfPart(const PartQuadratic& part, const CagePosition& k, CagePart which) { return part.At(k, k.parts[which]); }

TEST(CageQuadratic, APartIsFoundFromItsFourChanges) {
  const PartQuadratic truth = {{0.3, -0.2, 0.7, 0.4}};
  for (const CagePart part : {kCageSides, kRightSegment, kLeftSegment}) {
    std::array<double, 4> changes = {};
    const auto positions = CageFit::PositionsOf(part);
    for (size_t i = 0; i < positions.size(); ++i) changes[i] = OfPart(truth, positions[i], part);
    const PartQuadratic found = CageFit::Through(changes);
    for (size_t j = 0; j < found.c.size(); ++j) EXPECT_NEAR(found.c[j], truth.c[j], 1e-12) << j;
  }
}

// A part that both coordinates of the whole cage move alike adds what these would.
TEST(CageQuadratic, APartOfTheWholeCageAddsWhatTheCageWould) {
  const CageQuadratic cage = {{0.3, -0.2, 0.7, 0.4, 0.1}};
  std::array<double, 4> changes = {};
  const auto positions = CageFit::PositionsOf(kRightSegment);
  for (size_t i = 0; i < positions.size(); ++i) {
    const CagePosition& k = positions[i];
    changes[i] = cage.At(k.Of({0, 1, 0})) - cage.At(k);
  }
  const CageFunction with_part = {cage, {{{}, CageFit::Through(changes), {}}}};
  const CagePosition k = {0.3, 0.6, {0, -0.7, 0}};
  EXPECT_NEAR(with_part.At(k), cage.At(k.Of({0, 1, 0})), 1e-12);
}

TEST(CageQuadratic, DerivativesAreThoseOfTheFunction) {
  const CageFunction f = {{{0.3, -0.2, 0.7, 0.4, 0.1}}, {{{{1, 2, 3, 4}}, {{-2, 1, 0.5, 3}}, {{0.1, 0.2, -3, 1}}}}};
  const CagePosition k = {0.3, -0.2, {0.1, -0.4, 0.2}}, rate = {0.7, -0.3, {0.2, 0.5, -0.6}};
  const auto at = [&](double t) {
    CagePosition moved = {k.pump + t * rate.pump, k.bucket + t * rate.bucket};
    for (size_t i = 0; i < kCageParts; ++i) moved.parts[i] = k.parts[i] + t * rate.parts[i];
    return f.At(moved);
  };
  constexpr double kStep = 1e-5;
  EXPECT_NEAR((at(kStep) - at(-kStep)) / (2 * kStep), f.RateAt(k, rate), 1e-9);
}

}  // namespace
}  // namespace phrenic
