// The results of figures 5.5 and 5.6 of the thesis as inequalities: the top vertex of a dome of two layers is tracked
// for 200 frames of a breath, with and without rigid links between the layers, under weak and ten times stronger
// forces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "absl/strings/str_format.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

constexpr int kRings = 7, kAround = 16, kLayer = 1 + kRings * kAround;
constexpr double kRadius = 0.1, kThickness = 0.006;

// Index of vertex `a` on ring `r` of a layer. Ring 0 is the top vertex; layer 0 is the outer one.
int At(int layer, int r, int a) {
  return layer * kLayer + (r == 0 ? 0 : 1 + (r - 1) * kAround + (a + kAround) % kAround);
}

std::string DomeVertices() {
  std::string text;
  for (int layer = 0; layer < 2; ++layer) {
    const double radius = kRadius - layer * kThickness;
    for (int r = 0; r <= kRings; ++r) {
      const double polar = 1.3 * r / kRings;
      for (int a = 0; a < (r == 0 ? 1 : kAround); ++a) {
        const double turn = 2 * std::numbers::pi * a / kAround;
        text += absl::StrFormat(" vertices { x: %.9g y: %.9g z: %.9g }", radius * std::sin(polar) * std::cos(turn),
                                radius * std::sin(polar) * std::sin(turn), radius * std::cos(polar));
      }
    }
  }
  return text;
}

// Triangles that face outwards on the outer layer, inwards on the inner one, and a band that closes the rim.
std::string DomeTriangles() {
  std::string text;
  const auto add = [&text](int a, int b, int c, bool turned) {
    text += absl::StrFormat(" triangles { a: %d b: %d c: %d }", a, turned ? c : b, turned ? b : c);
  };
  for (int layer = 0; layer < 2; ++layer) {
    for (int r = 0; r < kRings; ++r) {
      for (int a = 0; a < kAround; ++a) {
        add(At(layer, r, a), At(layer, r + 1, a), At(layer, r + 1, a + 1), layer == 1);
        if (r > 0) add(At(layer, r, a), At(layer, r + 1, a + 1), At(layer, r, a + 1), layer == 1);
      }
    }
  }
  for (int a = 0; a < kAround; ++a) {
    add(At(0, kRings, a), At(1, kRings, a), At(1, kRings, a + 1), false);
    add(At(0, kRings, a), At(1, kRings, a + 1), At(0, kRings, a + 1), false);
  }
  return text;
}

std::string Dome(double force) {
  std::string rim;
  for (int a = 0; a < kAround; ++a)
    rim += absl::StrFormat(" fixed_vertices: [%d, %d]", At(0, kRings, a), At(1, kRings, a));
  return "name: 'dome' breath { waveform: WAVEFORM_SINE } bodies { name: 'dome' role: ROLE_DEFORMABLE mass: 0.3" + rim +
         " polyhedron {" + DomeVertices() + DomeTriangles() +
         absl::StrFormat(
             " } } forces { springs { bodies: 'dome' stiffness: 100 } } forces { friction { bodies: 'dome' rate: 5 } } "
             "forces { action_line { bodies: 'dome' origin {} direction { z: -1 } radius: 0.06 force: %g fall_off: "
             "FALL_OFF_CYLINDER } } constraints { rigid_links { body: 'dome' pairing { distance: 0.008 "
             "plane_point { z: 0.05 } plane_normal { z: 1 } } } } ",
             force);
}

struct Track {
  std::vector<double> height;  // of the top, one per frame [m]
  double gap = 0;              // largest relative change of the distance between the layers at the top
};

Track Breathe(double force, bool links) {
  const auto model = CompileText(Dome(force));
  EXPECT_GT(model->report.rigid_links(), 50);
  v1::Parameters parameters = model->parameters;
  parameters.set_apply_links(links);
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  Track track;
  for (int frame = 0; frame < 200; ++frame) {
    for (int i = 0; i < 20; ++i) EXPECT_TRUE(Step(*model, parameters, 1e-3, state, work).ok());
    track.height.push_back(state.x(2, 0));
    const double gap = (state.x.col(0) - state.x.col(kLayer)).norm();
    track.gap = std::max(track.gap, std::abs(gap - kThickness) / kThickness);
  }
  return track;
}

struct Comparison {
  Track with, without;
  double largest = 0;  // difference of the heights [m]
  int turns = 0;       // number of local extrema of the difference
};

Comparison Compare(double force) {
  Comparison compared{Breathe(force, true), Breathe(force, false)};
  double last = 0, slope = 0;
  for (size_t i = 0; i < compared.with.height.size(); ++i) {
    const double difference = compared.with.height[i] - compared.without.height[i];
    compared.largest = std::max(compared.largest, std::abs(difference));
    if ((difference - last) * slope < 0) ++compared.turns;
    slope = difference - last;
    last = difference;
  }
  return compared;
}

// If the effect of the links were linear in the force, ten times the force would give ten times the difference.
TEST(Dome, EffectOfLinksGrowsFasterThanTheForce) {
  const Comparison weak = Compare(0.01), strong = Compare(0.1);
  RecordProperty("weak_um", static_cast<int>(1e6 * weak.largest));
  RecordProperty("strong_um", static_cast<int>(1e6 * strong.largest));
  EXPECT_GT(weak.largest, 0);
  EXPECT_GT(strong.largest, 100 * weak.largest);
  EXPECT_GT(strong.turns, weak.turns) << "the links add local extrema under strong forces";
}

TEST(Dome, LinksKeepTheLayersTogetherUnderStrongForces) {
  const Comparison weak = Compare(0.01), strong = Compare(0.1);
  EXPECT_LT(weak.without.gap, 0.1) << "weak forces do not need the links";
  EXPECT_GT(strong.without.gap, 0.5) << "without links strong forces separate or crush the layers";
  EXPECT_LT(strong.with.gap, 1e-9);
}

}  // namespace
}  // namespace phrenic
