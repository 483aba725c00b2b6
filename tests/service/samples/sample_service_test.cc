#include <cmath>
#include <limits>
#include <map>
#include <thread>

#include "phrenic/v1/samples.grpc.pb.h"
#include "tests/service/guarded_server.h"

namespace phrenic::service {
namespace {

using Sessions = v1::SessionService::Stub;
using Samples = v1::SampleService::Stub;

// A WatchSamples stream, read sample by sample. It is subscribed when it is made: what is stepped later is seen.
class SampleWatch {
 public:
  SampleWatch(const std::shared_ptr<grpc::Channel>& channel, const std::string& text)
      : stub_(v1::SampleService::NewStub(channel)) {
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60));
    reader_ = stub_->WatchSamples(&context_, RequestOf<v1::WatchSamplesRequest>(text));
    reader_->WaitForInitialMetadata();  // it comes with the first batch, or with the error
  }
  ~SampleWatch() {
    context_.TryCancel();
    v1::WatchSamplesResponse rest;
    while (reader_->Read(&rest)) continue;
    if (!finished_) reader_->Finish();
  }

  bool Read(v1::SampleBatch* batch) {
    v1::WatchSamplesResponse response;
    if (!reader_->Read(&response)) return false;
    *batch = response.batch();
    return true;
  }
  // Reads samples up to a tick.
  std::vector<v1::Sample> ReadTo(std::int64_t tick) {
    std::vector<v1::Sample> samples;
    v1::SampleBatch batch;
    while ((samples.empty() || samples.back().tick() < tick) && Read(&batch)) {
      left_out_ += batch.left_out();
      samples.insert(samples.end(), batch.samples().begin(), batch.samples().end());
      if (batch.samples_size() > largest_) largest_ = batch.samples_size();
    }
    return samples;
  }
  std::int64_t left_out() const { return left_out_; }
  int largest_batch() const { return largest_; }
  grpc::Status Finish() {
    finished_ = true;
    return reader_->Finish();
  }

 private:
  std::unique_ptr<v1::SampleService::Stub> stub_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<v1::WatchSamplesResponse>> reader_;
  std::int64_t left_out_ = 0;
  int largest_ = 0;
  bool finished_ = false;
};

class SampleServiceTest : public ServerFixture {
 protected:
  void SetUp() override {
    ServerFixture::SetUp();
    samples_ = v1::SampleService::NewStub(channel_);
    Create("sheet");
  }

  // A scene with measures of springs and elements, whose time step is `kStep`.
  void Create(const std::string& id) {
    v1::CreateSessionResponse created;
    const grpc::Status status =
        Call(*sessions_, &Sessions::CreateSession,
             absl::StrCat("session_id: '", id, "' source { name: 'hanging-sheet' } parameters { time_step: 0.0005 }"),
             &created);
    ASSERT_TRUE(status.ok()) << status.error_message();
  }

  v1::ReadSamplesResponse Read(const std::string& text) {
    v1::ReadSamplesResponse response;
    const grpc::Status status = Call(*samples_, &Samples::ReadSamples, text, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response;
  }

  grpc::Status Refused(const std::string& text) {
    v1::ReadSamplesResponse response;
    return Call(*samples_, &Samples::ReadSamples, text, &response);
  }

  // Steps the session and returns its measures by their tick.
  std::map<std::int64_t, std::vector<double>> Stepped(const std::string& id, int samples, int ticks) {
    std::map<std::int64_t, std::vector<double>> values;
    for (int i = 0; i < samples; ++i) {
      v1::StepSessionResponse stepped;
      EXPECT_TRUE(
          Call(*sessions_, &Sessions::StepSession, absl::StrCat("session_id: '", id, "' ticks: ", ticks), &stepped)
              .ok());
      hash_ = stepped.state_hash();
      for (const auto& measure : stepped.measures()) values[stepped.session().tick()].push_back(measure.value());
    }
    return values;
  }

  std::unique_ptr<Samples> samples_;
  std::string hash_;
};

TEST_F(SampleServiceTest, SamplesAreEquallySpacedAndEqualThoseOfSteps) {
  Create("twin");
  SampleWatch watch(NewChannel(), "session_id: 'sheet'");
  v1::SampleBatch first;
  ASSERT_TRUE(watch.Read(&first));
  EXPECT_EQ(first.quantities_size(), 4);
  EXPECT_EQ(first.quantities(2).unit(), "J");
  EXPECT_EQ(first.present().time(), 0);
  ASSERT_TRUE(Session(&Sessions::PlaySession, "session_id: 'sheet' as_fast_as_possible: true until_time: 0.4").ok());
  const std::vector<v1::Sample> samples = watch.ReadTo(800);
  const auto stepped = Stepped("twin", 20, 40);
  ASSERT_EQ(samples.size(), 20u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_NEAR(samples[i].time(), 0.02 * static_cast<double>(i + 1), 1e-9);
    const std::vector<double> values(samples[i].values().begin(), samples[i].values().end());
    EXPECT_EQ(values, stepped.at(samples[i].tick())) << "tick " << samples[i].tick();
  }
}

TEST_F(SampleServiceTest, SamplingDoesNotChangeTheMotion) {
  Create("twin");
  SampleWatch watch(NewChannel(), "session_id: 'sheet' interval: 0.001");
  Stepped("sheet", 1, 300);
  const std::string sampled = hash_;
  Stepped("twin", 1, 300);
  EXPECT_EQ(hash_, sampled);
}

TEST_F(SampleServiceTest, SamplesDependNeitherOnFramesNorOnOtherReaders) {
  SampleWatch all(NewChannel(), "session_id: 'sheet'"), other(NewChannel(), "session_id: 'sheet' interval: 0.007");
  SampleWatch some(NewChannel(), "session_id: 'sheet' measures: 'energy of the springs'");
  Watch frames(NewChannel(), "sheet");
  v1::SampleBatch batch;
  for (SampleWatch* each : {&all, &other, &some}) ASSERT_TRUE(each->Read(&batch));
  EXPECT_EQ(batch.quantities_size(), 1);
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 800").ok());  // shows no frame of its middle
  const std::vector<v1::Sample> whole = all.ReadTo(800), part = some.ReadTo(800);
  ASSERT_EQ(whole.size(), 20u);
  ASSERT_EQ(part.size(), 20u);
  for (std::size_t i = 0; i < part.size(); ++i) EXPECT_EQ(part[i].values(0), whole[i].values(2));
  EXPECT_EQ(other.ReadTo(798).size(), 57u);
}

TEST_F(SampleServiceTest, SeveralSamplesComeInOneMessage) {
  SampleWatch watch(NewChannel(), "session_id: 'sheet' interval: 0.001");
  v1::SampleBatch first;
  ASSERT_TRUE(watch.Read(&first));
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 2000").ok());
  EXPECT_EQ(watch.ReadTo(2000).size(), 1000u);
  EXPECT_GT(watch.largest_batch(), 10);
  EXPECT_LE(watch.largest_batch(), 256);
}

TEST_F(SampleServiceTest, APausedSessionHasItsPresentStateAlone) {
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 50").ok());
  const v1::ReadSamplesResponse first = Read("session_id: 'sheet'");
  EXPECT_EQ(first.batch().present().tick(), 50);
  EXPECT_EQ(first.batch().samples_size(), 0);
  const std::string at = absl::StrCat(" track: ", first.batch().track(), " last: ", first.batch().last());
  const v1::ReadSamplesResponse second = Read("session_id: 'sheet'" + at);
  EXPECT_FALSE(second.batch().has_present());
  EXPECT_EQ(second.batch().samples_size(), 0);
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 50").ok());
  const v1::ReadSamplesResponse third = Read("session_id: 'sheet'" + at);
  ASSERT_EQ(third.batch().samples_size(), 1);
  EXPECT_EQ(third.batch().samples(0).tick(), 80);
  EXPECT_EQ(third.batch().quantities_size(), 0);
}

TEST_F(SampleServiceTest, AReadInPartsMissesNothing) {
  v1::ReadSamplesResponse read = Read("session_id: 'sheet' interval: 0.001");
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 2000").ok());
  std::int64_t tick = 0;
  for (int parts = 0; parts < 4; ++parts) {
    read = Read(absl::StrCat("session_id: 'sheet' interval: 0.001 track: ", read.batch().track(),
                             " last: ", read.batch().last()));
    EXPECT_EQ(read.more(), parts < 3);
    for (const v1::Sample& sample : read.batch().samples()) EXPECT_EQ(sample.tick(), tick += 2);
  }
  EXPECT_EQ(tick, 2000);
}

TEST_F(SampleServiceTest, ASlowReaderIsToldWhatItMissed) {
  const v1::ReadSamplesResponse first = Read("session_id: 'sheet' interval: 0.001");
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 8400").ok());
  const v1::ReadSamplesResponse late = Read(absl::StrCat(
      "session_id: 'sheet' interval: 0.001 track: ", first.batch().track(), " last: ", first.batch().last()));
  EXPECT_EQ(late.batch().left_out(), 4200 - 4096);
  EXPECT_EQ(late.batch().samples(0).tick(), 2 * (4200 - 4096 + 1));
}

TEST_F(SampleServiceTest, ASlowStreamMissesSamplesAndSaysHowMany) {
  SampleWatch watch(NewChannel(), "session_id: 'sheet' interval: 0.001");
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 40000").ok());
  const std::vector<v1::Sample> samples = watch.ReadTo(40'000);
  EXPECT_EQ(static_cast<std::int64_t>(samples.size()) + watch.left_out(), 20'000);
  for (std::size_t i = 1; i < samples.size(); ++i) EXPECT_GT(samples[i].tick(), samples[i - 1].tick());
}

TEST_F(SampleServiceTest, AResetStartsAtZeroAgain) {
  SampleWatch watch(NewChannel(), "session_id: 'sheet'");
  v1::SampleBatch first;
  ASSERT_TRUE(watch.Read(&first));
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 100").ok());
  EXPECT_EQ(watch.ReadTo(80).size(), 2u);
  ASSERT_TRUE(Session(&Sessions::ResetSession, "session_id: 'sheet'").ok());
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 45").ok());
  const std::vector<v1::Sample> samples = watch.ReadTo(40);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].time(), 0);
  EXPECT_EQ(samples[1].tick(), 40);
}

TEST_F(SampleServiceTest, AForkIsSampledByItself) {
  SampleWatch watch(NewChannel(), "session_id: 'sheet'");
  v1::SampleBatch first;
  ASSERT_TRUE(watch.Read(&first));
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 50").ok());
  v1::ForkSessionResponse forked;
  ASSERT_TRUE(Call(*sessions_, &Sessions::ForkSession, "session_id: 'sheet' fork_id: 'fork'", &forked).ok());
  SampleWatch beside(NewChannel(), "session_id: 'fork'");
  ASSERT_TRUE(beside.Read(&first));
  EXPECT_EQ(first.present().tick(), 50);
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'fork' ticks: 50").ok());
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 50").ok());
  const std::vector<v1::Sample> own = watch.ReadTo(80), other = beside.ReadTo(80);
  ASSERT_EQ(own.size(), 2u);
  ASSERT_EQ(other.size(), 1u);
  EXPECT_EQ(other[0].SerializeAsString(), own[1].SerializeAsString());
}

TEST_F(SampleServiceTest, ADeletedSessionEndsTheStream) {
  SampleWatch watch(NewChannel(), "session_id: 'sheet'");
  v1::SampleBatch batch;
  ASSERT_TRUE(watch.Read(&batch));
  ASSERT_TRUE(Session(&Sessions::DeleteSession, "session_id: 'sheet'").ok());
  EXPECT_FALSE(watch.Read(&batch));
  EXPECT_EQ(watch.Finish().error_code(), grpc::NOT_FOUND);
}

TEST_F(SampleServiceTest, RefusalsNameTheField) {
  const auto begins = [](const std::string& words) { return testing::StartsWith(words); };
  for (const char* interval : {"0", "nan", "-1", "1e9", "inf"}) {
    const grpc::Status status = Refused(absl::StrCat("session_id: 'sheet' interval: ", interval));
    EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT) << interval;
    EXPECT_THAT(status.error_message(), begins("interval:")) << interval;
  }
  EXPECT_THAT(Refused("session_id: 'sheet' measures: 'energy of the springs' measures: 'x'").error_message(),
              begins("measures[1]: there is no measure \"x\"; the scene has descent"));
  EXPECT_THAT(Refused("session_id: 'sheet' measures: 'energy of the springs' measures: 'energy of the springs'")
                  .error_message(),
              begins("measures[1]: \"energy of the springs\" is named twice"));
  v1::ReadSamplesRequest thousands;
  thousands.set_session_id("sheet");
  for (int i = 0; i < 5000; ++i) thousands.add_measures(std::string(100, 'x'));
  const grpc::Status status = Refused(thousands.ShortDebugString());
  EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_THAT(status.error_message(), begins("measures: 5000 names, at most 256"));
  EXPECT_EQ(Refused("session_id: 'missing'").error_code(), grpc::NOT_FOUND);
  EXPECT_EQ(Refused("").error_code(), grpc::INVALID_ARGUMENT);
}

TEST_F(SampleServiceTest, AnUnknownPositionBeginsNow) {
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 100").ok());
  for (const char* position : {"track: 7 last: 9000000000", "track: 9200000000000000000 last: 1"}) {
    const v1::ReadSamplesResponse read = Read(absl::StrCat("session_id: 'sheet' ", position));
    EXPECT_EQ(read.batch().quantities_size(), 4);
    EXPECT_EQ(read.batch().present().tick(), 100);
  }
}

// A paused session sends no sample that would show that the connection is back.
TEST_F(SampleServiceTest, ALostStreamIsResumedWithoutAGap) {
  v1::SampleBatch batch;
  {
    SampleWatch lost(NewChannel(), "session_id: 'sheet' interval: 0.007");
    ASSERT_TRUE(lost.Read(&batch));
  }
  const std::string at =
      absl::StrCat("session_id: 'sheet' interval: 0.007 track: ", batch.track(), " last: ", batch.last());
  ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'sheet' ticks: 140").ok());
  SampleWatch resumed(NewChannel(), at);
  EXPECT_EQ(resumed.ReadTo(140).size(), 10u);
  EXPECT_EQ(resumed.left_out(), 0);
  SampleWatch nothing_new(NewChannel(), absl::StrCat(at.substr(0, at.find(" last:")), " last: 10"));
  ASSERT_TRUE(nothing_new.Read(&batch));
  EXPECT_EQ(batch.samples_size() + batch.quantities_size(), 0);
  EXPECT_FALSE(batch.has_present());
}

// The stream's seats are limited as those of frames are, and do not take theirs.
TEST_F(SampleServiceTest, StreamsHaveSeatsOfTheirOwn) {
  Watch a(NewChannel(), "sheet"), b(NewChannel(), "sheet"), c(NewChannel(), "sheet");
  std::vector<std::unique_ptr<SampleWatch>> watches;
  v1::SampleBatch batch;
  for (int i = 0; i < 3; ++i) {
    watches.push_back(std::make_unique<SampleWatch>(NewChannel(), "session_id: 'sheet'"));
    EXPECT_TRUE(watches.back()->Read(&batch));
  }
  SampleWatch fourth(NewChannel(), "session_id: 'sheet'");
  EXPECT_FALSE(fourth.Read(&batch));
  EXPECT_EQ(fourth.Finish().error_code(), grpc::RESOURCE_EXHAUSTED);
}

class SampleRateTest : public GuardedServer {
 protected:
  SampleRateTest() { options_.max_requests = 5; }

  grpc::Status Read(const std::string& position, v1::ReadSamplesResponse* read) {
    return CallAs({"owner"}, *samples_, &Samples::ReadSamples, "session_id: 'mine' " + position, read);
  }
  void SetUp() override {
    GuardedServer::SetUp();
    samples_ = v1::SampleService::NewStub(channel_);
    ASSERT_EQ(Create("owner", "mine"), grpc::OK);
  }

  std::unique_ptr<Samples> samples_;
};

// They alone wait for the stepping thread.
TEST_F(SampleRateTest, ReadsWithoutAPositionCountTowardsTheRate) {
  v1::ReadSamplesResponse read;
  ASSERT_TRUE(Read("", &read).ok());
  const std::string at = absl::StrCat("track: ", read.batch().track(), " last: ", read.batch().last());
  grpc::Status refused;
  for (int i = 0; i < 1000 && refused.ok(); ++i) refused = Read(i % 2 == 0 ? "" : "track: 7", &read);
  EXPECT_EQ(refused.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(refused.error_message(), testing::HasSubstr("--max-requests"));
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(Read(at, &read).ok());
}

}  // namespace
}  // namespace phrenic::service
