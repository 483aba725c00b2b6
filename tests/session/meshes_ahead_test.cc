// Any number of threads gives the meshes, the errors and the model that one thread gives.
#include "server/session/mesh_cache/meshes_ahead.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <map>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "server/anatomy/anatomy.h"
#include "server/mechanics/parallel/compile_threads.h"
#include "server/mechanics/step/step.h"
#include "server/session/models.h"

namespace phrenic::session {
namespace {

// A scene of ribs 1 to 6, rib 1 twice, and a body with a file.
v1::Scene Ribs() {
  v1::Scene scene;
  for (const int number : {1, 2, 3, 4, 5, 6, 1}) {
    v1::Body& body = *scene.add_bodies();
    body.set_name(absl::StrCat("rib-", scene.bodies_size()));
    body.mutable_anatomy()->set_structure(v1::STRUCTURE_RIB);
    body.mutable_anatomy()->set_side(v1::SIDE_LEFT);
    body.mutable_anatomy()->set_number(number);
    body.mutable_generated()->set_resolution_mm(8);
  }
  scene.add_bodies()->mutable_file()->set_path("lung.stl");
  return scene;
}

Mesh Point(double x) {
  Mesh mesh;
  mesh.vertices = Points::Constant(3, 1, x);
  return mesh;
}

// A source that counts its calls by rib, 0 for a file. Rib 4 is an error.
class Counted {
 public:
  absl::StatusOr<Mesh> operator()(const v1::Body& body) ABSL_LOCKS_EXCLUDED(mutex_) {
    absl::MutexLock lock(&mutex_);
    ++calls_[body.anatomy().number()];
    if (body.anatomy().number() == 4) return absl::InvalidArgumentError("rib 4");
    return Point(body.anatomy().number());
  }
  std::map<int, int> calls() const ABSL_LOCKS_EXCLUDED(mutex_) {
    absl::MutexLock lock(&mutex_);
    return calls_;
  }

 private:
  mutable absl::Mutex mutex_;
  std::map<int, int> calls_ ABSL_GUARDED_BY(mutex_);
};

class MeshesMadeAhead : public testing::TestWithParam<int> {};

TEST_P(MeshesMadeAhead, AreThoseOfTheSourceEachMadeOnce) {
  const v1::Scene scene = Ribs();
  Counted counted;
  {
    const MeshSource ahead = MeshesAhead(
        scene, [&](const v1::Body& body) { return counted(body); }, GetParam());
    for (const v1::Body& body : scene.bodies()) {
      const auto mesh = ahead(body);
      const int number = body.anatomy().number();
      if (number == 4) {
        EXPECT_EQ(mesh.status().message(), "rib 4");
        continue;
      }
      ASSERT_TRUE(mesh.ok());
      EXPECT_EQ(mesh->vertices, Point(number).vertices);
    }
    EXPECT_EQ(ahead(scene.bodies(0))->vertices, Point(1).vertices) << "a third time";
  }
  const std::map<int, int> calls = counted.calls();
  for (const auto& [number, count] : calls) EXPECT_EQ(count, number == 1 ? 2 : 1) << number;
  EXPECT_EQ(calls.size(), 7);
}

TEST_P(MeshesMadeAhead, EndWithTheirSource) {
  const v1::Scene scene = Ribs();
  Counted counted;
  {
    const MeshSource unused = MeshesAhead(
        scene, [&](const v1::Body& body) { return counted(body); }, GetParam());
  }
  EXPECT_TRUE(counted.calls().empty()) << "only the first call begins";
  {
    (void)MeshesAhead(
        scene, [&](const v1::Body& body) { return counted(body); }, GetParam())(scene.bodies(0));
  }
  EXPECT_GE(counted.calls().size(), 1);
}

INSTANTIATE_TEST_SUITE_P(Threads, MeshesMadeAhead, testing::Values(1, 2, 5, 40));

// Returns the state of `thorax` after ten steps, compiled by so many threads without any cache but `cache`.
State AfterTenSteps(int threads, const MeshCache& cache) {
  const int before = CompileThreads();
  SetCompileThreads(threads);
  Models models(SceneCatalogue({PHRENIC_SOURCE_DIR "/server/scenes"}), "", 1, nullptr, {}, cache);
  v1::SceneSource source;
  source.set_name("thorax");
  source.set_resolution_mm(11);
  const auto model = models.Get(source, {.trusted = true});
  SetCompileThreads(before);
  EXPECT_TRUE(model.ok()) << model.status();
  if (!model.ok()) return {};
  State state = (*model)->InitialState();
  Workspace work = (*model)->MakeWorkspace();
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(Step(**model, (*model)->parameters, (*model)->parameters.time_step(), state, work).ok());
  }
  return state;
}

TEST(Compiling, GivesTheSameBitsByAnyNumberOfThreadsAndFromKeptMeshes) {
  const std::string folder = testing::TempDir() + "phrenic_compiling";
  std::filesystem::remove_all(folder);
  const State alone = AfterTenSteps(1, MeshCache());
  for (const State& other : {AfterTenSteps(4, MeshCache(folder)), AfterTenSteps(3, MeshCache(folder))}) {
    EXPECT_EQ(other.x, alone.x);
    EXPECT_EQ(other.v, alone.v);
  }
  EXPECT_FALSE(std::filesystem::is_empty(folder)) << "the last read its meshes";
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace phrenic::session
