#include "server/stream/sampler.h"

#include <thread>

#include "tests/compile_text.h"
#include "tests/fake_clock.h"
#include "tests/small_scenes.h"

namespace phrenic::stream {
namespace {

class SamplerTest : public testing::Test {
 protected:
  // Notes the states of `steps` steps of `length` [s].
  void Step(int steps, double length) {
    parameters_.set_time_step(length);
    for (int i = 0; i < steps; ++i) {
      state_.time += length;
      ++state_.tick;
      sampler_.Note(parameters_, state_);
    }
  }

  std::shared_ptr<const SampleTrack> Track(double interval, absl::Duration keep = absl::Seconds(1)) {
    auto track = sampler_.Track(interval, keep);
    EXPECT_TRUE(track.ok()) << track.status();
    return *track;
  }

  static std::vector<double> Times(const SampleTrack& track) {
    std::vector<double> times;
    for (const SharedSample& sample : track.Read(0, kKeptSamples).samples) times.push_back(sample->time);
    return times;
  }

  std::shared_ptr<const Model> model_ = CompileText(kTriangle);
  FakeClock clock_;
  Sampler sampler_{model_, clock_};
  v1::Parameters parameters_ = model_->parameters;
  State state_ = model_->InitialState();
};

TEST_F(SamplerTest, NothingIsEvaluatedWithoutReaders) {
  Step(1000, 0.001);
  EXPECT_EQ(sampler_.evaluations(), 0);
  Track(0.02, absl::Seconds(1));
  Step(100, 0.001);
  EXPECT_EQ(sampler_.evaluations(), 5);
  clock_.Advance(absl::Seconds(2));  // the reader's time is over
  Step(1000, 0.001);
  EXPECT_EQ(sampler_.evaluations(), 5);
}

TEST_F(SamplerTest, ATrackIsKeptAsLongAsItIsHeld) {
  const auto track = Track(0.02, absl::Seconds(1));
  clock_.Advance(absl::Hours(1));
  Step(100, 0.001);
  EXPECT_EQ(track->newest(), 5);
}

TEST_F(SamplerTest, SamplesAreAtMultiplesOfTheInterval) {
  Step(7, 0.001);  // a reader that comes between two samples gets the next ones
  const auto track = Track(0.02);
  Step(100'000, 0.001);
  const std::vector<double> times = Times(*track);
  ASSERT_EQ(times.size(), kKeptSamples);
  const std::int64_t first = track->newest() - static_cast<std::int64_t>(times.size());
  EXPECT_EQ(track->newest(), 5000);
  for (std::size_t i = 0; i < times.size(); ++i) {
    ASSERT_NEAR(times[i], 0.02 * static_cast<double>(first + 1 + static_cast<std::int64_t>(i)), 1e-9);
  }
}

TEST_F(SamplerTest, SamplesAreWithinAStepOfTheMultiplesForOtherSteps) {
  const auto track = Track(0.02);
  Step(3000, 0.0007);
  const std::vector<double> times = Times(*track);
  ASSERT_EQ(times.size(), 105u);  // 2.1 s
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double due = 0.02 * static_cast<double>(i + 1);
    EXPECT_GE(times[i], due - 1e-9);
    EXPECT_LT(times[i], due + 0.0007);
  }
}

TEST_F(SamplerTest, AStepLongerThanTheIntervalGivesOneSample) {
  const auto track = Track(0.001);
  Step(10, 0.0105);
  EXPECT_EQ(Times(*track).size(), 10u);
}

TEST_F(SamplerTest, AResetTakesASampleAtZeroAndGoesOnFromThere) {
  const auto track = Track(0.02);
  Step(50, 0.001);
  state_ = model_->InitialState();
  sampler_.Restart(parameters_, state_);
  Step(45, 0.001);
  const std::vector<double> times = Times(*track);
  ASSERT_EQ(times.size(), 5u);
  EXPECT_EQ(times[2], 0);
  EXPECT_NEAR(times[3], 0.02, 1e-9);
}

TEST_F(SamplerTest, TracksShareTheirSamples) {
  const auto fine = Track(0.01), coarse = Track(0.02);
  EXPECT_EQ(Track(0.02), coarse);
  Step(100, 0.001);
  EXPECT_EQ(sampler_.evaluations(), 10);
  EXPECT_EQ(fine->Read(1, 1).samples[0], coarse->Read(0, 1).samples[0]);
}

TEST_F(SamplerTest, ASlowReaderIsToldHowManySamplesItMissed) {
  const auto track = Track(0.001);
  Step(static_cast<int>(kKeptSamples) + 100, 0.001);
  SampleTrack::Part part = track->Read(0, 10);
  EXPECT_EQ(part.left_out, 100);
  EXPECT_TRUE(part.more);
  EXPECT_NEAR(part.samples[0]->time, 0.101, 1e-9);
  EXPECT_EQ(part.last, 110);
  part = track->Read(part.last, kKeptSamples);
  EXPECT_EQ(part.left_out, 0);
  EXPECT_FALSE(part.more);
  EXPECT_EQ(part.samples.size(), kKeptSamples - 10);
}

TEST_F(SamplerTest, AFifthIntervalIsRefusedUntilOneIsFree) {
  Track(kDefaultInterval, absl::Seconds(1));  // does not count
  for (int i = 1; i <= static_cast<int>(kMostTracks); ++i) Track(0.1 * i, absl::Seconds(1));
  const auto refused = sampler_.Track(1, absl::Seconds(1));
  EXPECT_TRUE(absl::IsResourceExhausted(refused.status())) << refused.status();
  EXPECT_EQ(refused.status().message().substr(0, 9), "interval:");
  clock_.Advance(absl::Seconds(2));
  EXPECT_TRUE(sampler_.Track(1, absl::Seconds(1)).ok());
}

TEST_F(SamplerTest, TheDefaultIntervalIsAlwaysAdmitted) {
  std::vector<std::shared_ptr<const SampleTrack>> others;
  for (int i = 1; i <= static_cast<int>(kMostTracks); ++i) others.push_back(Track(0.1 * i));
  EXPECT_FALSE(sampler_.Track(1, absl::Seconds(1)).ok());
  const auto graphs = Track(kDefaultInterval);
  Step(100, 0.001);
  EXPECT_EQ(graphs->newest(), 5);
}

TEST_F(SamplerTest, ReadersReadWhileTheSessionSteps) {
  const auto track = Track(0.001);
  std::int64_t read = 0;
  std::thread reader([&] {
    for (std::int64_t last = 0; last < 20'000;) {
      const SampleTrack::Part part = track->Read(last, 100);
      read += static_cast<std::int64_t>(part.samples.size()) + part.left_out;
      last = part.last;
    }
  });
  Step(20'000, 0.001);
  reader.join();
  EXPECT_EQ(read, 20'000);
}

}  // namespace
}  // namespace phrenic::stream
