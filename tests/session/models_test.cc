// Scenes compile beside each other; callers of the same scene wait for one compile.
#include "server/session/models.h"

#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "google/protobuf/text_format.h"
#include "server/crypto/sha256.h"

namespace phrenic::session {
namespace {

v1::SceneSource Parsed(const std::string& scene) {
  v1::SceneSource source;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString("scene { name: 's' " + scene + " }", &source)) << scene;
  return source;
}

v1::SceneSource Small(int number) {
  return Parsed(absl::StrCat("title: '", number,
                             "' bodies { name: 'x' role: ROLE_AT_REST grid { columns: 3 rows: 3 u { x: 1 } "
                             "v { y: 1 } } }"));
}

// Takes minutes: every pair of vertices is near. `side` squared vertices.
v1::SceneSource Long(int side, int number) {
  return Parsed(absl::StrCat(
      "title: '", number, "' bodies { name: 'x' role: ROLE_DEFORMABLE mass: 1 grid { columns: ", side, " rows: ", side,
      " u { x: 1e-6 } v { y: 1e-6 } } } "
      "forces { cross_layer { bodies: 'x' distance: 100 } }"));
}

TEST(Models, ASmallSceneDoesNotWaitForLongOnes) {
  Models models(SceneCatalogue({}), "", 4);
  std::atomic<bool> stop = false;
  std::vector<std::thread> greedy;
  for (int i = 0; i < 6; ++i) {
    const int side = i % 2 == 0 ? 200 : 400;  // in both lanes
    greedy.emplace_back([&, i, side] {
      const Requester by{.share = "greedy", .cancelled = [&] { return stop.load(); }};
      EXPECT_TRUE(absl::IsCancelled(models.Get(Long(side, i), by).status()));
    });
  }
  absl::SleepFor(absl::Milliseconds(200));
  for (int i = 0; i < 20; ++i) {
    const absl::Time start = absl::Now();
    EXPECT_TRUE(models.Get(Small(i), {.share = "modest"}).ok());
    EXPECT_LT(absl::Now() - start, absl::Seconds(10));
  }
  stop = true;
  for (std::thread& thread : greedy) thread.join();
}

TEST(Models, TheSameSceneIsCompiledOnceForAllWhoWait) {
  Models models(SceneCatalogue({}), "", 4, nullptr, {.compile_seconds = 2});
  std::vector<std::thread> callers;
  std::atomic<int> exhausted = 0;
  const absl::Time start = absl::Now();
  for (int i = 0; i < 5; ++i) {
    callers.emplace_back([&, i] {
      const Requester by{.share = absl::StrCat(i)};
      exhausted += absl::IsResourceExhausted(models.Get(Long(200, 0), by).status());
    });
  }
  for (std::thread& thread : callers) thread.join();
  EXPECT_EQ(exhausted, 5);
  EXPECT_LT(absl::Now() - start, absl::Seconds(60));
}

TEST(Models, ACompileGoesOnWhileAnyoneWaitsForIt) {
  Models models(SceneCatalogue({}), "", 4, nullptr, {.compile_seconds = 3});
  std::atomic<bool> first_left = false, first_asked = false;
  absl::Status first, second;
  std::thread one([&] {
    first = models
                .Get(Long(200, 0), {.cancelled =
                                        [&] {
                                          first_asked = true;
                                          return first_left.load();
                                        }})
                .status();
  });
  while (!first_asked) absl::SleepFor(absl::Milliseconds(5));
  std::thread two([&] { second = models.Get(Long(200, 0)).status(); });
  first_left = true;
  one.join();
  two.join();
  EXPECT_TRUE(absl::IsResourceExhausted(second)) << "it is not cancelled with the first caller: " << second;
}

TEST(Models, AKeptModelDoesNotGiveAwayAnothersFile) {
  const std::string bytes = "v 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n";
  Uploads uploads(Limits(), testing::TempDir());
  ASSERT_TRUE(uploads.Adopt({.owner = "anna"}, "a.obj", bytes).ok());
  Models models(SceneCatalogue({}), "", 4, &uploads);
  const std::string path = "path: 'upload:" + Sha256Hex(bytes) + "'";
  for (const std::string& shape : {"file { " + path + " }", "filling { file { " + path + " } cell: 0.01 }"}) {
    const v1::SceneSource scene = Parsed("bodies { name: 'x' role: ROLE_AT_REST " + shape + " }");
    models.Get(scene, {.owner = "anna"}).IgnoreError();
    EXPECT_TRUE(absl::IsNotFound(models.Get(scene, {.owner = "ben"}).status())) << shape;
    EXPECT_FALSE(absl::IsNotFound(models.Get(scene, {.owner = "anna"}).status())) << shape;
    EXPECT_FALSE(absl::IsNotFound(models.Get(scene, {.owner = "root", .all_files = true}).status())) << shape;
  }
}

}  // namespace
}  // namespace phrenic::session
