#include "server/session/export/exporter.h"

#include <gmock/gmock.h>
#include <zstd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "phrenic/v1/offline.pb.h"
#include "server/crypto/sha256.h"
#include "server/mechanics/state.h"
#include "server/session/export/export_catalogue.h"
#include "server/session/export/page_writer.h"
#include "server/stream/codecs/zstd.h"
#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic::session {
namespace {

using testing::HasSubstr;

class ExporterTest : public testing::Test {
 protected:
  ExporterTest() {
    request_.set_session_id("test");
    request_.set_format("msh");
    request_.set_seconds(1);
  }

  absl::StatusOr<v1::ExportSummary> Export() {
    const Fork fork = {model_->parameters, model_->InitialState()};
    const auto plan = PlanExport(request_, *model_, fork, testing::TempDir(), page_);
    if (!plan.ok()) return plan.status();
    auto spool = record::SpoolFile::Open(testing::TempDir());
    EXPECT_TRUE(spool.ok()) << spool.status();
    ExportFile file(*std::move(spool));
    auto summary = ExportMotion(*plan, model_, fork, file, progress_);
    file_.resize(static_cast<std::size_t>(file.spool()->size()));
    EXPECT_TRUE(file.spool()->Read(0, file_.data(), file_.size()).ok());
    return summary;
  }

  std::string Refusal() {
    const auto refused = Export();
    EXPECT_TRUE(absl::IsInvalidArgument(refused.status())) << refused.status();
    return std::string(refused.status().message());
  }

  // Writes a template of pages, with `padding` more bytes.
  static std::string WriteTemplate(std::size_t padding = 0) {
    const std::string path = testing::TempDir() + "/offline.html";
    std::ofstream(path) << std::string(padding, ' ') << "<p>before</p>__PHRENIC_MOTION__<p>after</p>";
    return path;
  }

  // Reads the motion in file_ back, as a page does.
  v1::OfflineMotion Motion() const {
    const std::size_t first = file_.find("</p>") + 4, last = file_.rfind("<p>");
    std::string compressed;
    EXPECT_TRUE(absl::Base64Unescape(file_.substr(first, last - first), &compressed));
    const auto size = ZSTD_getFrameContentSize(compressed.data(), compressed.size());
    const auto bytes = stream::Decompress(compressed, static_cast<std::size_t>(size));
    EXPECT_TRUE(bytes.ok()) << bytes.status();
    v1::OfflineMotion motion;
    EXPECT_TRUE(bytes.ok() && motion.ParseFromString(*bytes));
    return motion;
  }

  std::shared_ptr<const Model> model_ = CompileText(kTriangle);
  std::string page_ = WriteTemplate();
  v1::CreateExportRequest request_;
  std::string file_;
  ExportProgress progress_ = [](double, double) { return absl::OkStatus(); };
};

TEST_F(ExporterTest, TheSummaryDescribesTheFile) {
  for (const record::Format& format : ExportFormats()) {
    request_.set_format(format.name);
    request_.clear_start();
    if (format.instant) request_.set_start(1);
    if (format.page) request_.set_start(0);
    request_.set_seconds(format.instant ? 0 : 1);
    request_.clear_frames_per_second();
    if (format.frames_a_breath > 0) request_.set_frames_per_second(10);
    const auto summary = Export();
    ASSERT_TRUE(summary.ok()) << format.name << summary.status();
    EXPECT_EQ(summary->frames(), format.instant ? 1 : 11) << "the first state and ten a second";
    EXPECT_EQ(summary->vertices(), format.numbers_only ? 0 : 3);
    EXPECT_EQ(summary->bytes(), static_cast<std::int64_t>(file_.size()));
    EXPECT_EQ(summary->sha256(), Sha256Hex(file_));
    EXPECT_EQ(summary->steps(), 100);
    EXPECT_NEAR(summary->simulated_seconds(), 1, 1e-9);
    EXPECT_GT(summary->step_wall_seconds(), 0);
    EXPECT_GT(summary->step_cpu_seconds(), 0);
  }
}

TEST_F(ExporterTest, TheMotionEqualsTheMechanicsBitForBit) {
  const auto summary = Export();
  ASSERT_TRUE(summary.ok()) << summary.status();
  EXPECT_EQ(summary->state_hash(), HashText(RunTo(*model_, 1, 0.01)));
}

TEST_F(ExporterTest, AnImpossibleRequestIsRefusedWithItsFieldAndARemedy) {
  request_.set_format("avi");
  EXPECT_THAT(Refusal(), HasSubstr("msh"));
  request_.set_format("stl");
  EXPECT_THAT(Refusal(), HasSubstr("seconds: stl holds one instant"));
  request_.set_format("depl");
  request_.set_values(v1::EXPORT_VALUES_DISPLACEMENTS);
  EXPECT_THAT(Refusal(), HasSubstr("values: depl has one kind"));
  request_.clear_values();
  request_.set_file_stem("../up");
  EXPECT_THAT(Refusal(), HasSubstr("file_stem"));
  request_.set_file_stem("fine");
  request_.set_frames_per_second(10);
  request_.set_steps_per_frame(3);
  EXPECT_THAT(Refusal(), HasSubstr("steps_per_frame: give either"));
  request_.clear_steps_per_frame();
  request_.add_bodies("lnug");
  EXPECT_THAT(Refusal(), HasSubstr("bodies[0]: there is no body or layer \"lnug\""));
  EXPECT_TRUE(file_.empty());
}

TEST_F(ExporterTest, AnExportLargerThanTheDiskIsRefusedBeforeItBegins) {
  request_.set_seconds(3600);
  request_.set_frames_per_second(1000);
  const Fork fork = {model_->parameters, model_->InitialState()};
  const auto plan = PlanExport(request_, *model_, fork, testing::TempDir());
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_NEAR(static_cast<double>(plan->bytes), 3'600'000.0 * 3 * 40, 1e6) << "rows of about 40 bytes";
}

TEST_F(ExporterTest, EveryNthStepFromTheStartIsAFrame) {
  request_.set_start(0.5);
  request_.set_seconds(0.3);
  request_.set_steps_per_frame(3);
  const auto summary = Export();
  ASSERT_TRUE(summary.ok()) << summary.status();
  EXPECT_EQ(summary->frames(), 11) << "steps 50, 53 ... 80 of 0.01 s";
  EXPECT_EQ(summary->steps(), 80);
  EXPECT_THAT(file_, HasSubstr("\"displacement\"\n1\n0.5\n3\n0\n"));
  EXPECT_THAT(file_, HasSubstr("\"displacement\"\n1\n0.8\n3\n10\n"));
}

TEST_F(ExporterTest, ProgressGrowsToItsEndAndAnErrorOfItsReceiverEndsTheExport) {
  request_.set_seconds(36'000);
  progress_ = [](double share, double seconds) {
    EXPECT_NEAR(share, seconds / 36'000, 1e-9);
    return absl::CancelledError("enough");
  };
  EXPECT_TRUE(absl::IsCancelled(Export().status()));
}

TEST_F(ExporterTest, BodiesAreChosenByNameOrLayer) {
  request_.add_bodies("post");
  request_.add_bodies("tissue");
  const auto summary = Export();
  ASSERT_TRUE(summary.ok()) << summary.status();
  EXPECT_EQ(summary->vertices(), 5);
}

TEST_F(ExporterTest, APageHasTheWholeSceneOverOneBreathAfterTheFirst) {
  request_.set_format("html");
  request_.set_seconds(0);
  const auto summary = Export();
  ASSERT_TRUE(summary.ok()) << summary.status();
  EXPECT_THAT(file_, testing::StartsWith("<p>before</p>"));
  EXPECT_THAT(file_, testing::EndsWith("<p>after</p>"));
  EXPECT_EQ(file_.find("PHRENIC"), std::string::npos);
  const v1::OfflineMotion motion = Motion();
  const double breath = model_->parameters.breath_length();
  EXPECT_EQ(motion.scene(), model_->scene.name());
  EXPECT_EQ(motion.parameters().breath_length(), breath);
  EXPECT_EQ(motion.bodies_size(), static_cast<int>(model_->bodies.size()));
  ASSERT_EQ(motion.frames_size(), 81);
  const double step = model_->parameters.time_step();
  EXPECT_NEAR(motion.frames(0).time(), breath, step);
  EXPECT_NEAR(motion.frames(80).time(), 2 * breath, step);
  for (const v1::Frame& frame : motion.frames()) {
    EXPECT_EQ(frame.codec(), v1::CODEC_PREDICTED);
    EXPECT_EQ(frame.max_error_mm(), 0.1) << "a small scene has the finest bound";
    EXPECT_EQ(frame.measures_size(), static_cast<int>(model_->measures.size()));
  }
}

TEST_F(ExporterTest, APageLeavesOutMechanicsThatTheSceneHidesAndNumbersTheOthersAnew) {
  model_ = CompileText(Triangle(R"(
    layers { name: "hidden" title: "Hidden" color: "#7d9ec0" opacity: 0 }
    bodies {
      name: "coarse" layer: "hidden" role: ROLE_DEFORMABLE mass: 1
      polyhedron { vertices { z: 1 } vertices { x: 1 z: 1 } vertices { y: 1 z: 1 } triangles { a: 0 b: 1 c: 2 } }
    }
    bodies {
      name: "seen" layer: "tissue" role: ROLE_DEFORMABLE mass: 1
      polyhedron { vertices { z: 2 } vertices { x: 1 z: 2 } vertices { y: 1 z: 2 } triangles { a: 0 b: 1 c: 2 } }
    })"));
  request_.set_format("html");
  request_.set_seconds(0.5);
  ASSERT_TRUE(Export().ok());
  const v1::OfflineMotion motion = Motion();
  ASSERT_EQ(motion.bodies_size(), 3);
  EXPECT_EQ(motion.bodies(2).name(), "seen");
  EXPECT_EQ(motion.bodies(2).body_index(), 2);
  EXPECT_EQ(motion.bodies(2).body_count(), 3);
  EXPECT_EQ(motion.bodies(2).first_vertex(), 3) << "after those of the sheet";
  EXPECT_THAT(motion.frames(0).bodies(), testing::ElementsAre(1, 2));

  for (const BodyModel& body : model_->bodies) request_.add_bodies(body.name);
  ASSERT_TRUE(Export().ok());
  const v1::OfflineMotion whole = Motion();
  ASSERT_EQ(whole.bodies_size(), static_cast<int>(model_->bodies.size())) << "what is named is there, hidden or not";
  for (int i = 0; i < whole.bodies_size(); ++i) EXPECT_EQ(whole.bodies(i).name(), model_->bodies[i].name);
}

TEST_F(ExporterTest, EqualRunsHaveEqualPages) {
  request_.set_format("html");
  request_.set_seconds(0.5);
  ASSERT_TRUE(Export().ok());
  const std::string first = file_;
  ASSERT_TRUE(Export().ok());
  EXPECT_EQ(file_, first);
}

TEST_F(ExporterTest, APageThatIsTooLargeHasTheCoarsestBound) {
  request_.set_format("html");
  page_ = WriteTemplate(kPageBytes);
  ASSERT_TRUE(Export().ok());
  EXPECT_EQ(Motion().frames(0).max_error_mm(), 1);
  EXPECT_EQ(Motion().frames_size(), 21) << "80 in a breath of 4 s";
}

TEST_F(ExporterTest, APageIsRefusedWithoutTheViewer) {
  request_.set_format("html");
  page_ = testing::TempDir() + "/nowhere.html";
  const auto refused = Export();
  EXPECT_TRUE(absl::IsNotFound(refused.status())) << refused.status();
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("npm run build"));
}

TEST_F(ExporterTest, ADivergenceEndsTheExportWithItsReason) {
  model_ = CompileText(Retimed("time_step: 0.1 elasticity: 100"));
  request_.set_seconds(1000);
  const auto diverged = Export();
  EXPECT_EQ(diverged.status().code(), absl::StatusCode::kOutOfRange);
  EXPECT_THAT(std::string(diverged.status().message()), HasSubstr("time_step"));
}

}  // namespace
}  // namespace phrenic::session
