// Exports and uploads: what is kept, for how long, and what is refused.
#include "server/session/export/exports.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "absl/strings/str_cat.h"
#include "server/crypto/sha256.h"
#include "server/mechanics/state.h"
#include "server/mechanics/step/step.h"
#include "server/session/meshes.h"
#include "server/session/scene_hash.h"
#include "server/session/uploads.h"
#include "tests/compile_text.h"
#include "tests/fake_clock.h"
#include "tests/small_scenes.h"

namespace phrenic::session {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

class ExportsTest : public testing::Test {
 protected:
  ExportsTest() {
    request_.set_session_id("class");
    request_.set_format("msh");
    request_.set_seconds(0.5);
  }

  absl::StatusOr<v1::Export> Add() {
    return exports_.Add(request_, {model_, {model_->parameters, model_->InitialState()}});
  }
  v1::Export Ended(const std::string& id) {
    absl::StatusOr<Exports::Seen> seen;
    EXPECT_TRUE(Eventually([&] {
      seen = exports_.Wait(id, 0, absl::ZeroDuration());
      return !seen.ok() || seen->ended;
    }));
    return seen.ok() ? seen->message : v1::Export();
  }

  FakeClock clock_;
  std::shared_ptr<const Model> model_ = CompileText(kTriangle, {.hash = &SceneHash});
  v1::CreateExportRequest request_;
  Exports exports_{{.exports = 1, .kept_exports = 3, .export_minutes = 60}, testing::TempDir(), clock_};
};

// The server ends during one export and after another: both make the same files again.
TEST_F(ExportsTest, OutliveTheirServerAndMakeTheSameFiles) {
  const std::string folder = testing::TempDir() + "phrenic_exports_" + std::to_string(getpid());
  Models models(SceneCatalogue({}), "", 1);
  const auto begin = [&](store::Store& store) {
    return std::make_unique<Exports>(Limits{.exports = 1}, testing::TempDir(), clock_, &store);
  };
  const auto hash_of = [](Exports& exports, const std::string& id) {
    absl::StatusOr<Exports::Seen> seen;
    EXPECT_TRUE(Eventually([&] {
      seen = exports.Wait(id, 0, absl::ZeroDuration());
      return !seen.ok() || seen->ended;
    }));
    return seen.ok() ? seen->message.summary().sha256() : std::string(seen.status().message());
  };
  State start = model_->InitialState();
  Workspace work = model_->MakeWorkspace();
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(Step(*model_, model_->parameters, 0.01, start, work).ok());
  std::string whole;
  {
    auto store = *store::Store::Open(folder);
    const auto exports = begin(*store);
    for (const auto& [id, seconds] : {std::pair("short", 0.5), {"deleted", 0.5}, {"long", 600.0}}) {
      request_.set_export_id(id);
      request_.set_seconds(seconds);
      ASSERT_TRUE(exports->Add(request_, {model_, {model_->parameters, start}, {}, "anna"}).ok());
    }
    whole = hash_of(*exports, "short");
    ASSERT_TRUE(exports->Delete("deleted").ok());
  }
  auto store = *store::Store::Open(folder);
  auto exports = begin(*store);
  std::map<std::string, std::string> found;
  std::map<std::string, absl::Status> lost;
  exports->Restore(
      *store->LoadRecords(), models, [](const std::string& account) { return account; }, lost);
  for (const v1::Export& job : exports->List()) found[job.id()] = exports->OwnerOf(job.id()).value_or("none");
  EXPECT_THAT(found, ::testing::UnorderedElementsAre(Pair("short", "anna"), Pair("long", "anna")));
  EXPECT_THAT(lost, IsEmpty());
  EXPECT_EQ(hash_of(*exports, "short"), whole);
  EXPECT_TRUE(exports->Wait("long", 0, absl::ZeroDuration()).ok());
  exports.reset();  // it writes to the store until its jobs have stopped
  store.reset();
  std::filesystem::remove_all(folder);
}

TEST_F(ExportsTest, RunToTheirEndAndAreReadFromAnyOffset) {
  const auto added = Add();
  ASSERT_TRUE(added.ok()) << added.status();
  EXPECT_EQ(added->id(), "class");
  EXPECT_EQ(added->file_name(), "class.msh");
  const v1::Export job = Ended("class");
  EXPECT_EQ(job.state(), v1::EXPORT_STATE_DONE);
  EXPECT_EQ(job.progress(), 1);
  EXPECT_EQ(job.summary().frames(), 6);
  const auto file = exports_.File("class");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ((*file)->size(), job.bytes());
  std::string head(11, ' '), tail(14, ' ');
  ASSERT_TRUE((*file)->Read(0, head.data(), head.size()).ok());
  ASSERT_TRUE((*file)->Read(job.bytes() - 14, tail.data(), tail.size()).ok());
  EXPECT_EQ(head + tail, "$MeshFormat\n$EndNodeData\n") << "from both ends";
  EXPECT_TRUE(absl::IsOutOfRange((*file)->Read(job.bytes() - 1, tail.data(), 2)));
}

TEST_F(ExportsTest, AreDeletedWhenTheirTimeIsOverAndAReaderKeepsItsFile) {
  ASSERT_TRUE(Add().ok());
  EXPECT_EQ(Ended("class").state(), v1::EXPORT_STATE_DONE);
  const auto file = exports_.File("class");
  ASSERT_TRUE(file.ok());
  clock_.Advance(absl::Minutes(59));
  EXPECT_THAT(exports_.List(), SizeIs(1));
  clock_.Advance(absl::Minutes(2));
  EXPECT_TRUE(Eventually([this] { return exports_.List().empty(); }));
  EXPECT_TRUE(absl::IsNotFound(exports_.File("class").status()));
  char byte = 0;
  EXPECT_TRUE((*file)->Read(0, &byte, 1).ok());
}

TEST_F(ExportsTest, DeletingOneEndsItAndTheNextOneRuns) {
  request_.set_seconds(3600);
  request_.set_format("csv");
  ASSERT_TRUE(Add().ok());
  request_.set_seconds(0.5);
  const auto second = Add();
  ASSERT_TRUE(second.ok()) << second.status();
  EXPECT_EQ(second->id(), "class-2");
  EXPECT_TRUE(absl::IsFailedPrecondition(exports_.File("class-2").status())) << "it waits";
  ASSERT_TRUE(exports_.Delete("class").ok());
  EXPECT_EQ(Ended("class-2").state(), v1::EXPORT_STATE_DONE);
  EXPECT_TRUE(absl::IsNotFound(exports_.Delete("class")));
}

TEST_F(ExportsTest, ThoseOfLargeScenesAreFewer) {
  Exports exports({.exports = 1, .vertices = 3, .kept_exports = 16}, testing::TempDir(), clock_);
  request_.set_seconds(3600);
  const auto add = [&](const std::string& owner) {
    return exports.Add(request_, {model_, {model_->parameters, model_->InitialState()}, {}, owner}).status();
  };
  EXPECT_TRUE(add("anna").ok() && add("anna").ok());
  EXPECT_TRUE(absl::IsResourceExhausted(add("anna"))) << "three states wait that are as large as a scene may be";
  EXPECT_TRUE(add("ben").ok() && add("ben").ok());
  EXPECT_TRUE(absl::IsResourceExhausted(add("cleo")));
}

TEST_F(ExportsTest, TheOldestThatHasEndedMakesRoomAndRunningOnesDoNot) {
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(Add().ok());
  EXPECT_EQ(Ended("class-3").state(), v1::EXPORT_STATE_DONE);
  request_.set_seconds(3600);
  request_.set_format("csv");
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(Add().ok());
  const auto full = Add();
  EXPECT_TRUE(absl::IsResourceExhausted(full.status())) << full.status();
  EXPECT_THAT(exports_.List(), SizeIs(3));
}

TEST_F(ExportsTest, AFailureSaysWhyAndKeepsNoFile) {
  model_ = CompileText(Retimed("time_step: 0.1 elasticity: 100"));
  request_.set_seconds(1000);
  ASSERT_TRUE(Add().ok());
  const v1::Export job = Ended("class");
  EXPECT_EQ(job.state(), v1::EXPORT_STATE_FAILED);
  EXPECT_THAT(job.problem(), HasSubstr("time_step"));
  EXPECT_THAT(std::string(exports_.File("class").status().message()), HasSubstr("has failed"));
}

constexpr char kSurface[] = "v 0 0 0\nv 30 0 0\nv 0 30 0\nf 1 2 3\n";

class UploadsTest : public testing::Test {
 protected:
  absl::StatusOr<Uploads::Finished> Upload(const std::string& name, const std::string& bytes,
                                           const std::string& sha256 = "") {
    const auto begun = uploads_.Begin(by_, name, static_cast<std::int64_t>(bytes.size()), sha256);
    if (!begun.ok()) return begun.status();
    const std::size_t half = bytes.size() / 2;
    EXPECT_EQ(*uploads_.Add(by_, begun->id, 0, bytes.substr(0, half)), static_cast<std::int64_t>(half));
    EXPECT_TRUE(absl::IsFailedPrecondition(uploads_.Finish(by_, begun->id, 1).status())) << "half of it";
    EXPECT_TRUE(absl::IsOutOfRange(uploads_.Add(by_, begun->id, static_cast<std::int64_t>(half) + 1, "x").status()));
    EXPECT_TRUE(uploads_.Add(by_, begun->id, static_cast<std::int64_t>(half), bytes.substr(half)).ok());
    return uploads_.Finish(by_, begun->id, 1);
  }

  const Requester by_ = {};
  Uploads uploads_{{.upload_bytes = 100, .uploads_bytes = 120}, testing::TempDir()};
};

TEST_F(UploadsTest, AFileIsKeptByItsContentAndScenesNameIt) {
  const auto finished = Upload("a.obj", kSurface, Sha256Hex(kSurface));
  ASSERT_TRUE(finished.ok()) << finished.status();
  EXPECT_EQ(finished->file.path(), "upload:" + Sha256Hex(kSurface));
  EXPECT_EQ(finished->surface->mesh.vertices(0, 1), 0.03);
  const auto again = uploads_.Begin(by_, "b.obj", sizeof kSurface - 1, Sha256Hex(kSurface));
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_TRUE(again->id.empty()) << "it is there";
  v1::Body body;
  body.mutable_file()->set_path(finished->file.path());
  body.mutable_file()->set_unit(1);
  const auto held = uploads_.Hold(by_, finished->file.path());
  ASSERT_TRUE(held.ok()) << held.status();
  const auto mesh = MakeMeshSource("", {*held})(body);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->vertices(0, 1), 30);
  ASSERT_TRUE(uploads_.Delete(by_, finished->file.path()).ok());
  EXPECT_THAT(std::string(uploads_.Hold(by_, finished->file.path()).status().message()), HasSubstr("upload it again"));
  EXPECT_THAT(std::string(MakeMeshSource("")(body).status().message()), HasSubstr("upload it again"));
}

TEST_F(UploadsTest, AnInterruptedUploadContinuesWhereItWas) {
  const std::string hash = Sha256Hex(kSurface);
  const auto first = uploads_.Begin(by_, "a.obj", sizeof kSurface - 1, hash);
  ASSERT_TRUE(uploads_.Add(by_, first->id, 0, "v 0 0").ok());
  const auto second = uploads_.Begin(by_, "a.obj", sizeof kSurface - 1, hash);
  EXPECT_EQ(second->id, first->id);
  EXPECT_EQ(second->received, 5);
}

TEST_F(UploadsTest, TwoClientsThatUploadTheSameFileShareOneUpload) {
  const std::string bytes = kSurface, hash = Sha256Hex(bytes);
  const auto size = static_cast<std::int64_t>(bytes.size());
  const std::string mine = uploads_.Begin(by_, "a.obj", size, hash)->id,
                    other = uploads_.Begin(by_, "b.obj", size, hash)->id;
  EXPECT_EQ(*uploads_.Add(by_, mine, 0, bytes.substr(0, 9)), 9);
  EXPECT_EQ(*uploads_.Add(by_, other, 0, bytes.substr(0, 5)), 9) << "they are there";
  EXPECT_EQ(*uploads_.Add(by_, other, 5, bytes.substr(5)), size) << "its first four are there";
  EXPECT_EQ(*uploads_.Add(by_, mine, 9, bytes.substr(9)), size);
  const auto first = uploads_.Finish(by_, mine, 1), second = uploads_.Finish(by_, other, 1);
  ASSERT_TRUE(first.ok()) << first.status();
  ASSERT_TRUE(second.ok()) << second.status();
  EXPECT_EQ(first->file.sha256, hash);
  EXPECT_EQ(first->surface->mesh.vertices, second->surface->mesh.vertices);
  EXPECT_THAT(uploads_.List(by_), SizeIs(1));
}

TEST_F(UploadsTest, EachKindOfBadFileIsRefusedWithItsReason) {
  const auto words = [](const auto& status) { return std::string(status.status().message()); };
  EXPECT_THAT(words(uploads_.Begin(by_, "a.doc", 10, "")), HasSubstr("there are .obj"));
  EXPECT_THAT(words(uploads_.Begin(by_, "a.obj", 0, "")), HasSubstr("is empty"));
  EXPECT_THAT(words(uploads_.Begin(by_, "a.obj", 101, "")), HasSubstr("a file may have 100"));
  EXPECT_THAT(words(Upload("a.obj", "v 0 0 0\nv 1 0\nf 1 2 2\n")), HasSubstr("a.obj:2: "));
  EXPECT_THAT(words(Upload("a.obj", kSurface, Sha256Hex("another"))), HasSubstr("arrived damaged"));
  EXPECT_THAT(words(uploads_.Add(by_, "u99", 0, "x")), HasSubstr("begin it again"));
  EXPECT_THAT(uploads_.List(by_), SizeIs(0));
}

TEST_F(UploadsTest, TheLeastRecentlyUsedFileMakesRoom) {
  std::vector<std::string> paths;
  for (const std::string more : {"", "\n", "\n\n"}) {
    const auto finished = Upload("a.obj", kSurface + more);
    ASSERT_TRUE(finished.ok()) << finished.status();
    paths.push_back(finished->file.path());
    EXPECT_TRUE(uploads_.Hold(by_, paths[0]).ok()) << "it stays in use";
  }
  const auto last = Upload("a.obj", std::string(kSurface) + "\n\n\n");
  ASSERT_TRUE(last.ok());
  EXPECT_TRUE(uploads_.Hold(by_, paths[0]).ok());
  EXPECT_TRUE(absl::IsNotFound(uploads_.Hold(by_, paths[1]).status()));
}

}  // namespace
}  // namespace phrenic::session
