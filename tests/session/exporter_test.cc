#include "server/session/exporter.h"

#include <gmock/gmock.h>
#include <openssl/sha.h>

#include "absl/strings/escaping.h"
#include "server/mechanics/state.h"
#include "server/session/chunks.h"
#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic::session {
namespace {

using testing::HasSubstr;

std::string Sha256(const std::string& bytes) {
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest);
  return absl::BytesToHexString(absl::string_view(reinterpret_cast<const char*>(digest), sizeof digest));
}

class ExporterTest : public testing::Test {
 protected:
  ExporterTest() {
    request_.set_session_id("test");
    request_.set_format("msh");
    request_.set_seconds(1);
  }

  absl::StatusOr<v1::ExportSummary> Export() {
    return ExportMotion(request_, model_, {model_->parameters, model_->InitialState()}, sink_);
  }

  std::shared_ptr<const Model> model_ = CompileText(kTriangle);
  v1::ExportMotionRequest request_;
  std::string file_;
  ExportSink sink_ = {.chunk =
                          [this](std::string_view bytes) {
                            file_ += bytes;
                            return absl::OkStatus();
                          },
                      .progress = [](double) { return absl::OkStatus(); }};
};

TEST_F(ExporterTest, TheSummaryTellsWhatTheFileHolds) {
  for (const char* format : {"msh", "depl"}) {
    file_.clear();
    request_.set_format(format);
    const auto summary = Export();
    ASSERT_TRUE(summary.ok()) << summary.status();
    EXPECT_EQ(summary->frames(), 11) << "the first state and ten a second";
    EXPECT_EQ(summary->vertices(), 3);
    EXPECT_EQ(summary->bytes(), static_cast<std::int64_t>(file_.size()));
    EXPECT_EQ(summary->sha256(), Sha256(file_));
    EXPECT_EQ(summary->steps(), 100);
    EXPECT_NEAR(summary->simulated_seconds(), 1, 1e-9);
    EXPECT_GT(summary->step_wall_seconds(), 0);
    EXPECT_GT(summary->step_cpu_seconds(), 0);
  }
}

TEST_F(ExporterTest, TheMotionIsThatOfTheMechanicsBitForBit) {
  const auto summary = Export();
  ASSERT_TRUE(summary.ok()) << summary.status();
  EXPECT_EQ(summary->state_hash(), HashText(RunTo(*model_, 1, 0.01)));
}

TEST_F(ExporterTest, AnUnknownFormatOrBodyIsRefusedAndTheOthersAreNamed) {
  request_.set_format("avi");
  EXPECT_THAT(std::string(Export().status().message()), HasSubstr("msh"));
  EXPECT_TRUE(absl::IsInvalidArgument(Export().status()));
  request_.set_format("msh");
  request_.add_bodies("lnug");
  const auto missing = Export();
  EXPECT_TRUE(absl::IsInvalidArgument(missing.status()));
  EXPECT_THAT(std::string(missing.status().message()), HasSubstr("bodies[0]: there is no body or layer \"lnug\""));
  EXPECT_TRUE(file_.empty());
}

TEST_F(ExporterTest, BodiesAreChosenByNameOrLayer) {
  request_.add_bodies("post");
  request_.add_bodies("tissue");
  const auto summary = Export();
  ASSERT_TRUE(summary.ok()) << summary.status();
  EXPECT_EQ(summary->vertices(), 5);
}

TEST_F(ExporterTest, AReceiverThatGoesAwayEndsIt) {
  sink_.chunk = [](std::string_view) { return absl::CancelledError("gone"); };
  EXPECT_TRUE(absl::IsCancelled(Export().status()));
}

TEST_F(ExporterTest, ADivergenceEndsItWithItsReason) {
  model_ = CompileText(Retimed("time_step: 0.1 elasticity: 100"));
  request_.set_seconds(1000);
  const auto diverged = Export();
  EXPECT_EQ(diverged.status().code(), absl::StatusCode::kOutOfRange);
  EXPECT_THAT(std::string(diverged.status().message()), HasSubstr("time_step"));
}

TEST(Chunks, AreTheBytesInOrderAndNoneIsTooLarge) {
  std::string sent, added;
  std::size_t largest = 0;
  Chunks chunks([&](std::string_view bytes) {
    sent += bytes;
    largest = std::max(largest, bytes.size());
    return absl::OkStatus();
  });
  for (int i = 0; i < 20; ++i) {
    const std::string bytes(static_cast<std::size_t>(37'777) * (i % 7), static_cast<char>('a' + i));
    added += bytes;
    ASSERT_TRUE(chunks.Add(bytes).ok());
  }
  ASSERT_TRUE(chunks.Flush().ok());
  EXPECT_EQ(sent, added);
  EXPECT_EQ(largest, 128u << 10);
  EXPECT_EQ(chunks.bytes(), static_cast<std::int64_t>(added.size()));
  EXPECT_EQ(chunks.Sha256(), Sha256(added));
}

}  // namespace
}  // namespace phrenic::session
