// What holds for every codec, on frames of simulations as they are: the bound, and that no bytes do harm.
#include "server/stream/codecs/codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "absl/strings/match.h"
#include "server/mechanics/skinning/body_points.h"
#include "server/mechanics/step/step.h"
#include "server/session/models.h"
#include "server/stream/basis.h"
#include "server/stream/rest_shape.h"

namespace phrenic::stream {
namespace {

constexpr double kMillimetre = 1e-3;

struct Frames {
  RestShape shape;
  std::vector<Floats> positions;
};

// Frames of a shipped scene, some steps apart.
Frames RunScene(const std::string& scene, const std::string& data, double resolution_mm, int frames, int steps) {
  session::Models models(session::SceneCatalogue({PHRENIC_SOURCE_DIR "/server/scenes"}), data, 1);
  v1::SceneSource source;
  source.set_name(scene);
  if (resolution_mm > 0) source.set_resolution_mm(resolution_mm);
  const auto model = models.Get(source);
  EXPECT_TRUE(model.ok()) << model.status();
  const Layout layout(**model);
  const std::vector<int> bodies = StreamedBodies(**model, layout);
  Frames made{.shape = MakeRestShape(**model, bodies), .positions = {}};
  State state = (*model)->InitialState();
  Workspace work = (*model)->MakeWorkspace();
  for (int frame = 0; frame < frames; ++frame) {
    for (int i = 0; i < steps; ++i) {
      EXPECT_TRUE(Step(**model, (*model)->parameters, (*model)->parameters.time_step(), state, work).ok());
    }
    Floats& positions = made.positions.emplace_back(3, layout.vertices());
    for (const int body : bodies) {
      Points placed((*model)->bodies[body].mesh.vertices);
      PlaceBody(**model, state, body, placed);
      positions.middleCols(layout.first_vertex(body), placed.cols()) = placed.cast<float>();
    }
  }
  // Of the first frame alone: what the others leave is for the codec to send.
  made.shape.shapes = FindShapes({made.positions.front() - made.shape.rest});
  return made;
}

const Frames& Thorax() {
  static const Frames frames = RunScene("thorax-thesis", "", 12, 3, 100);
  return frames;
}

// As a run looks that is about to diverge: each vertex somewhere else, by `metres` and more.
Floats Noisy(const Floats& positions, double metres) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, static_cast<float>(metres));
  return positions.unaryExpr([&](float x) { return x + noise(random); });
}

void ExpectWithin(const Floats& decoded, const Floats& positions, double bound) {
  ASSERT_EQ(decoded.cols(), positions.cols());
  const double worst = (decoded.cast<double>() - positions.cast<double>()).colwise().norm().maxCoeff();
  EXPECT_LE(worst, bound);
}

class CodecContract : public testing::TestWithParam<CodecRow> {
 protected:
  void ExpectBound(const Frames& frames, const std::vector<Floats>& positions) {
    const auto codec = GetParam().make(frames.shape);
    for (const double millimetres : {0.001, 0.1, 1.0}) {
      for (const Floats& frame : positions) {
        const auto bytes = codec->Encode(frame, millimetres * kMillimetre);
        if (!bytes.ok()) {
          EXPECT_TRUE(absl::IsOutOfRange(bytes.status())) << bytes.status();
          EXPECT_LT(millimetres, 0.1) << "the viewer's own bound cannot be kept: " << bytes.status();
          continue;
        }
        const auto decoded = codec->Decode(*bytes);
        ASSERT_TRUE(decoded.ok()) << decoded.status();
        ExpectWithin(*decoded, frame, millimetres * kMillimetre);
      }
    }
  }
};

TEST_P(CodecContract, KeepsItsBoundOnTheThorax) { ExpectBound(Thorax(), Thorax().positions); }

TEST_P(CodecContract, KeepsItsBoundOnThePatient) {
  const std::string data = PHRENIC_SHARED_DIR "/data";
  if (!std::filesystem::is_directory(data)) GTEST_SKIP() << "there are no patient's surfaces at " << data;
  static const Frames frames = RunScene("thorax-patient", data, 0, 1, 20);
  ExpectBound(frames, frames.positions);
}

TEST_P(CodecContract, KeepsItsBoundOnNoise) {
  std::vector<Floats> noisy;
  for (const double metres : {0.001, 0.01, 0.3}) noisy.push_back(Noisy(Thorax().positions[0], metres));
  ExpectBound(Thorax(), noisy);
}

TEST_P(CodecContract, RefusesWhatItCannotHold) {
  if (GetParam().codec == v1::CODEC_RAW) GTEST_SKIP() << "raw holds every number";
  const auto codec = GetParam().make(Thorax().shape);
  for (const float far : {1e4F, 1e30F}) {
    Floats positions = Thorax().shape.rest;
    positions(1, 5) = far;
    const absl::Status status = codec->Encode(positions, 0.1 * kMillimetre).status();
    EXPECT_TRUE(absl::IsOutOfRange(status)) << far;
    EXPECT_TRUE(absl::StrContains(status.message(), "take a larger")) << status;
  }
  const absl::Status fine = codec->Encode(Thorax().shape.rest, 1e-12).status();
  EXPECT_TRUE(absl::StartsWith(fine.message(), "max_error_mm: ")) << fine;
}

TEST_P(CodecContract, HoldsNothingAndOneVertex) {
  for (const int vertices : {0, 1}) {
    const RestShape shape{.rest = Floats::Constant(3, vertices, 0.5F), .edges = Edges(2, 0)};
    const auto codec = GetParam().make(shape);
    const Floats positions = Floats::Constant(3, vertices, -0.25F);
    const auto bytes = codec->Encode(positions, kMillimetre);
    ASSERT_TRUE(bytes.ok()) << bytes.status();
    const auto decoded = codec->Decode(*bytes);
    ASSERT_TRUE(decoded.ok()) << decoded.status();
    if (vertices > 0) ExpectWithin(*decoded, positions, kMillimetre);
  }
}

// A cut is refused; a flipped byte is refused, or moves vertices to finite places.
TEST_P(CodecContract, SurvivesAnyBytes) {
  const RestShape shape{.rest = Thorax().shape.rest.leftCols(60), .edges = Edges(2, 0)};
  const auto codec = GetParam().make(shape);
  const auto bytes = codec->Encode(Noisy(shape.rest, 0.002), 0.1 * kMillimetre);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  for (std::size_t i = 0; i < bytes->size(); ++i) {
    EXPECT_FALSE(codec->Decode(std::string_view(*bytes).substr(0, i)).ok()) << i;
    for (const unsigned flip : {1U, 0x80U, 0xffU}) {
      std::string flipped = *bytes;
      flipped[i] = static_cast<char>(static_cast<unsigned char>(flipped[i]) ^ flip);
      const auto decoded = codec->Decode(flipped);
      EXPECT_TRUE(!decoded.ok() || decoded->allFinite()) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Codecs, CodecContract, testing::ValuesIn(Codecs().begin(), Codecs().end()),
                         [](const auto& row) { return std::string(row.param.name); });

std::size_t Size(v1::Codec codec, const RestShape& shape, const Floats& positions) {
  return MakeCodec(codec, shape)->Encode(positions, 0.1 * kMillimetre)->size();
}

TEST(PredictedCodec, IsTheSmallestOnAThorax) {
  const RestShape& shape = Thorax().shape;
  for (const Floats& frame : Thorax().positions) {
    const std::size_t raw = Size(v1::CODEC_RAW, shape, frame), planes = Size(v1::CODEC_PLANES, shape, frame);
    EXPECT_LT(planes, raw / 2);
    EXPECT_LT(Size(v1::CODEC_PREDICTED, shape, frame), planes / 2);
  }
}

// The weights read a linear function off the neighbours: what moves rigidly by a little leaves next to nothing.
TEST(PredictedCodec, MovingAsOneCostsNextToNothing) {
  const RestShape& shape = Thorax().shape;
  EXPECT_LT(Size(v1::CODEC_PREDICTED, shape, shape.rest.colwise() + Eigen::Vector3f(0.01F, 0.02F, -0.03F)), 400U);
}

// Displacements that are sums of two shapes: found, and sent as two numbers.
TEST(BasisCodec, WhatTheShapesSpanTakesTheirPartsAlone) {
  RestShape shape = Thorax().shape;
  const Floats one = shape.rest * 0.02F, other = shape.rest.colwise().reverse() * 0.01F;
  shape.shapes = FindShapes({one + other, one - 2 * other, 0.5F * one});
  ASSERT_EQ(shape.shapes.size(), 2U);
  const auto codec = MakeCodec(v1::CODEC_BASIS, shape);
  const Floats positions = shape.rest + 0.3F * one - 0.7F * other;
  const auto bytes = codec->Encode(positions, 0.01 * kMillimetre);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  EXPECT_EQ(bytes->size(), 16U + 2 * sizeof(float));
  ExpectWithin(*codec->Decode(*bytes), positions, 0.01 * kMillimetre);
}

TEST(BasisCodec, OneVertexThatLeavesTheShapesCostsLittleMore) {
  RestShape shape = Thorax().shape;
  shape.shapes = FindShapes({shape.rest * 0.02F});
  const auto codec = MakeCodec(v1::CODEC_BASIS, shape);
  Floats positions = shape.rest + 0.5F * shape.shapes[0];
  positions(2, 100) += 0.02F;
  const auto bytes = codec->Encode(positions, 0.1 * kMillimetre);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  EXPECT_LT(bytes->size(), 120U);
  ExpectWithin(*codec->Decode(*bytes), positions, 0.1 * kMillimetre);
}

// However bad the shapes are, a frame takes little more than without them.
TEST(BasisCodec, ShapesOfAnotherMotionCostLittle) {
  RestShape shape = Thorax().shape;
  shape.shapes = FindShapes({Noisy(shape.rest, 0.01) - shape.rest, Noisy(shape.rest, 0.02) - shape.rest});
  for (const Floats& frame : Thorax().positions) {
    EXPECT_LT(Size(v1::CODEC_BASIS, shape, frame), 1.2 * static_cast<double>(Size(v1::CODEC_PREDICTED, shape, frame)));
  }
}

}  // namespace
}  // namespace phrenic::stream
