// Shapes of what was seen, and how viewers come to have them.
#include "server/stream/basis.h"

#include <cmath>

#include "server/stream/basis_maker.h"
#include "server/stream/publisher.h"
#include "server/stream/rest_shape.h"
#include "tests/compile_text.h"
#include "tests/fake_clock.h"
#include "tests/small_scenes.h"

namespace phrenic::stream {
namespace {

Floats Waves(int vertices, float phase) {
  return Floats::NullaryExpr(
      3, vertices, [phase](Eigen::Index axis, Eigen::Index i) { return 0.01F * std::sin(phase + 0.3F * i + axis); });
}

TEST(FindShapes, AreAsManyAsTheMotionHasAndSpanIt) {
  // A running wave is made of two standing ones.
  std::vector<Floats> seen;
  for (int i = 0; i < 12; ++i) seen.push_back(Waves(200, 0.5F * i));
  const std::vector<Floats> shapes = FindShapes(seen);
  ASSERT_EQ(shapes.size(), 2U);
  EXPECT_NEAR(shapes[0].cwiseProduct(shapes[1]).sum(), 0, 1e-5 * shapes[0].squaredNorm());
  const Floats another = Waves(200, 0.2F);
  Floats left = another;
  for (const Floats& shape : shapes) left -= another.cwiseProduct(shape).sum() / shape.squaredNorm() * shape;
  EXPECT_LT(left.cwiseAbs().maxCoeff(), 1e-6F);
}

TEST(FindShapes, OfWhatStandsStillAreNone) {
  EXPECT_TRUE(FindShapes({}).empty());
  EXPECT_TRUE(FindShapes({Floats::Zero(3, 9), Floats::Zero(3, 9)}).empty());
  EXPECT_TRUE(FindShapes({Floats(3, 0)}).empty());
}

TEST(FindShapes, OfNoiseAreNoMoreThanAllowed) {
  std::vector<Floats> seen;
  for (int i = 0; i < 20; ++i) seen.emplace_back(Floats::Random(3, 50));
  EXPECT_EQ(FindShapes(seen).size(), static_cast<std::size_t>(kMostShapes));
}

class MakerTest : public testing::Test {
 protected:
  // Frames of `seconds`, 60 a second, and what was made of them.
  void Show(double seconds, const std::function<Floats(double)>& displacement) {
    for (int i = 0; i < 60 * seconds; ++i) {
      now_ += absl::Seconds(1 / 60.0);
      maker_.See(shape_.rest + displacement(absl::ToDoubleSeconds(now_ - absl::UnixEpoch())), now_);
    }
    ASSERT_TRUE(Eventually([&] {
      maker_.See(shape_.rest, now_);
      return maker_.newest() != nullptr;
    }));
  }

  const RestShape shape_{.rest = Floats::Random(3, 200), .edges = Edges(2, 0)};
  BasisMaker maker_{shape_, MakeCodec(v1::CODEC_PREDICTED, shape_)};
  absl::Time now_ = absl::UnixEpoch();
};

TEST_F(MakerTest, AMotionThatIsKnownMakesNoOther) {
  const auto wave = [](double time) { return Waves(200, static_cast<float>(3 * time)); };
  Show(4, wave);
  ASSERT_EQ(maker_.newest()->epoch, 1);
  EXPECT_EQ(maker_.newest()->encoded.size(), 2U);
  Show(60, wave);
  EXPECT_EQ(maker_.newest()->epoch, 1) << "viewers fetch shapes again for nothing";
}

TEST_F(MakerTest, ANewMotionMakesANewBasisThatKeepsTheOld) {
  Show(4, [](double time) { return Waves(200, static_cast<float>(3 * time)); });
  const auto other = [](double time) -> Floats { return Waves(200, 0.1F).colwise().reverse() * std::sin(time); };
  Show(20, other);
  ASSERT_TRUE(Eventually([&] {
    maker_.See(shape_.rest, now_);
    return maker_.newest()->epoch == 2;
  }));
  EXPECT_EQ(maker_.newest()->shapes.size(), 3U);
}

TEST(Basis, ComesOutOfItsBytesBitForBit) {
  const RestShape shape{.rest = Floats::Random(3, 200), .edges = Edges(2, 0)};
  const auto predicted = MakeCodec(v1::CODEC_PREDICTED, shape);
  const auto basis = MakeBasis(*predicted, shape.rest, {Waves(200, 0.3F)}, 7);
  ASSERT_TRUE(basis.ok()) << basis.status();
  EXPECT_EQ(basis->epoch, 7);
  EXPECT_EQ(*predicted->Decode(basis->encoded[0]) - shape.rest, basis->shapes[0]);
}

// A viewer of CODEC_BASIS gets frames it can decode before it has shapes, and is told when there are some.
TEST(BasisOverThePublisher, ComesOnceTheViewerHasTheShapes) {
  const auto model = CompileText(kTriangle);
  FakeClock clock;
  Publisher publisher(model, clock, 4);
  const auto viewer = publisher.Join({.encoding = {.codec = v1::CODEC_BASIS}, .watch_id = "page"}, [] {});
  ASSERT_TRUE(viewer.ok()) << viewer.status();
  std::int64_t sequence = 0;
  const auto next = [&](std::int64_t epoch) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->sequence = ++sequence;
    snapshot->state = model->InitialState();
    snapshot->state.x *= 1 + 0.01 * std::sin(0.3 * static_cast<double>(sequence));
    snapshot->parameters = model->parameters;
    clock.Advance(absl::Milliseconds(150));
    snapshot->made = clock.Now();
    publisher.Offer(std::move(snapshot));
    v1::WatchFramesResponse response;
    EXPECT_TRUE(Eventually([&] {
      const Bytes bytes = (*viewer)->Take(clock.Now());
      return bytes != nullptr && response.ParseFromString(*bytes) && response.has_frame();
    }));
    v1::AckFramesRequest taken;
    taken.set_watch_id("page");
    taken.set_sequence(sequence);
    taken.set_basis_epoch(epoch);
    return std::pair(response.frame(), publisher.Acknowledge(taken)->basis_epoch());
  };
  std::int64_t offered = 0;
  for (int i = 0; i < 200 && offered == 0; ++i) {
    const auto [frame, epoch] = next(0);
    EXPECT_EQ(frame.codec(), v1::CODEC_PREDICTED);
    EXPECT_EQ(frame.basis_epoch(), 0);
    offered = epoch;
  }
  ASSERT_EQ(offered, 1) << "no shapes were made of two hundred frames";
  EXPECT_EQ(publisher.basis()->epoch, 1);
  next(1);
  const auto [frame, epoch] = next(1);
  EXPECT_EQ(frame.codec(), v1::CODEC_BASIS);
  EXPECT_EQ(frame.basis_epoch(), 1);
  next(99);
  EXPECT_EQ(next(99).first.codec(), v1::CODEC_PREDICTED)
      << "a viewer with shapes that nobody has gets what it can read";
}

}  // namespace
}  // namespace phrenic::stream
