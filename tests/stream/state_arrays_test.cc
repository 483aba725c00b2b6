#include "server/stream/state_arrays.h"

#include <cstring>

#include "server/stream/frame.h"
#include "tests/compile_text.h"
#include "tests/scalar_motion.h"
#include "tests/small_scenes.h"

namespace phrenic::stream {
namespace {

StateParts Parts(std::initializer_list<int> parts) { return {parts.begin(), parts.end()}; }

bool HasBitsOf(const std::string& bytes, const double* numbers, Eigen::Index count) {
  return bytes.size() == sizeof(double) * count && std::memcmp(bytes.data(), numbers, bytes.size()) == 0;
}

TEST(StateArrays, HoldEveryBitThatTheHashCovers) {
  const auto model = CompileWithScalars(kTriangle);
  const State state = RunTo(*model, 0.5, 0.01);
  const auto arrays =
      MakeStateArrays(*model, Layout(*model), state,
                      Parts({v1::STATE_PART_POSITIONS, v1::STATE_PART_VELOCITIES, v1::STATE_PART_SCALARS}));
  ASSERT_TRUE(arrays.ok()) << arrays.status();
  EXPECT_TRUE(HasBitsOf(arrays->positions(), state.x.data(), state.x.size()));
  EXPECT_TRUE(HasBitsOf(arrays->velocities(), state.v.data(), state.v.size()));
  EXPECT_TRUE(HasBitsOf(arrays->scalars(), state.scalars.q.data(), state.scalars.q.size()));
  EXPECT_TRUE(HasBitsOf(arrays->scalar_rates(), state.scalars.v.data(), state.scalars.v.size()));
  EXPECT_EQ(arrays->time(), state.time);
  EXPECT_EQ(arrays->phase(), state.phase);
  EXPECT_EQ(arrays->tick(), 50);
}

TEST(StateArrays, BodiesAreThoseOfARawFrame) {
  const auto model = CompileText(kTriangle);
  const Snapshot snapshot = {
      .sequence = 1, .state = RunTo(*model, 0.5, 0.01), .parameters = model->parameters, .made = absl::UnixEpoch()};
  const Layout layout(*model);
  const auto frame = MakeFrame(*model, layout, snapshot);
  ASSERT_TRUE(frame.ok()) << frame.status();
  const auto arrays =
      MakeStateArrays(*model, layout, snapshot.state, Parts({v1::STATE_PART_BODIES, v1::STATE_PART_BODIES}));
  ASSERT_TRUE(arrays.ok()) << arrays.status();
  EXPECT_EQ(arrays->body_positions(), frame->positions()) << "a part that is named twice is there once";
  EXPECT_EQ(arrays->poses(), frame->poses());
  EXPECT_TRUE(arrays->positions().empty());
}

TEST(StateArrays, TheLayoutNamesBodiesAndEveryScalar) {
  const auto model = CompileWithScalars(kTriangle);
  const auto arrays = MakeStateArrays(*model, Layout(*model), model->InitialState(), Parts({v1::STATE_PART_LAYOUT}));
  ASSERT_TRUE(arrays.ok()) << arrays.status();
  ASSERT_EQ(arrays->layout().bodies_size(), 1);
  EXPECT_EQ(arrays->layout().bodies(0).vertices(), 3);
  ASSERT_EQ(arrays->layout().scalars_size(), static_cast<int>(model->scalars.size()));
  EXPECT_EQ(arrays->layout().scalars(0).name(), "angle");
  EXPECT_EQ(arrays->layout().scalars(0).unit(), "rad");
}

TEST(StateArrays, APartThatIsNamedOftenIsWrittenOnce) {
  const auto model = CompileText(kTriangle);
  StateParts often;
  for (int i = 0; i < 1'000'000; ++i) often.Add(i % 2 == 0 ? v1::STATE_PART_BODIES : v1::STATE_PART_LAYOUT);
  const auto arrays = MakeStateArrays(*model, Layout(*model), model->InitialState(), often);
  const auto once = MakeStateArrays(*model, Layout(*model), model->InitialState(),
                                    Parts({v1::STATE_PART_BODIES, v1::STATE_PART_LAYOUT}));
  ASSERT_TRUE(arrays.ok() && once.ok());
  EXPECT_EQ(arrays->SerializeAsString(), once->SerializeAsString());
}

TEST(StateArrays, TheirBytesAreKnownBefore) {
  const auto model = CompileWithScalars(kTriangle);
  const Layout layout(*model);
  for (const int part : {v1::STATE_PART_POSITIONS, v1::STATE_PART_VELOCITIES, v1::STATE_PART_SCALARS,
                         v1::STATE_PART_BODIES, v1::STATE_PART_BODIES}) {
    const StateParts parts = Parts({v1::STATE_PART_POSITIONS, part});
    const auto arrays = MakeStateArrays(*model, layout, model->InitialState(), parts);
    ASSERT_TRUE(arrays.ok()) << arrays.status();
    EXPECT_EQ(StateBytes(*model, layout, parts), arrays->positions().size() + arrays->velocities().size() +
                                                     arrays->scalars().size() + arrays->scalar_rates().size() +
                                                     arrays->body_positions().size() + arrays->poses().size())
        << part;
  }
  EXPECT_EQ(StateBytes(*model, layout, Parts({})), 0u);
}

TEST(StateArrays, APartThatIsNotSetIsRefused) {
  EXPECT_TRUE(CheckParts(Parts({v1::STATE_PART_POSITIONS, v1::STATE_PART_LAYOUT})).ok());
  EXPECT_EQ(CheckParts(Parts({v1::STATE_PART_UNSPECIFIED})).code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace phrenic::stream
