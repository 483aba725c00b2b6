// A kept mesh has the bits of a generated one; damage, other writers and a full folder cost time, never a wrong mesh.
#include "server/session/mesh_cache/mesh_cache.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "server/anatomy/anatomy.h"
#include "server/crypto/sha256.h"
#include "server/schema/file_bytes.h"

namespace phrenic::session {
namespace {

namespace fs = std::filesystem;

Mesh SmallMesh(double size) {
  Mesh mesh;
  mesh.vertices = size * Points::Identity(3, 3);
  mesh.triangles = Triangles(3, 1);
  mesh.triangles << 0, 1, 2;
  mesh.regions["rim"] = {0, 2};
  return mesh;
}

class KeptMeshes : public testing::Test {
 protected:
  KeptMeshes() { fs::remove_all(folder_); }
  ~KeptMeshes() override { fs::remove_all(folder_); }

  // Returns the mesh of rib `number`, generated as a triangle of that size; counts how often it was generated.
  Mesh Get(const MeshCache& cache, int number) {
    v1::Anatomy part;
    part.set_number(number);
    return *cache.Get(part, {}, [&]() -> absl::StatusOr<Mesh> {
      ++generated_;
      return SmallMesh(number);
    });
  }
  std::vector<fs::path> Files() const {
    std::vector<fs::path> files;
    for (const auto& each : fs::directory_iterator(folder_)) files.push_back(each.path());
    return files;
  }

  const std::string folder_ = testing::TempDir() + "phrenic_kept_meshes_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name() + std::to_string(getpid());
  std::atomic<int> generated_ = 0;
};

TEST_F(KeptMeshes, AreReadByTheNextProgram) {
  const Mesh first = Get(MeshCache(folder_), 3), second = Get(MeshCache(folder_), 3),
             other = Get(MeshCache(folder_), 4);
  EXPECT_EQ(generated_, 2);
  EXPECT_EQ(first.vertices, second.vertices);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_EQ(first.regions, second.regions);
  EXPECT_NE(first.vertices, other.vertices);
  EXPECT_EQ(Files().size(), 2);
}

TEST_F(KeptMeshes, HaveTheBitsOfAGeneratedPart) {
  v1::Anatomy part;
  part.set_structure(v1::STRUCTURE_DIAPHRAGM);
  const Mesh mesh = *anatomy::Generate(part, 12);
  const auto same = UnpackMesh(PackMesh(mesh));
  ASSERT_TRUE(same.has_value());
  EXPECT_EQ(same->vertices, mesh.vertices);
  EXPECT_EQ(same->triangles, mesh.triangles);
  EXPECT_EQ(same->regions, mesh.regions);
}

// What is read is what was written: regions in another order, or one twice, are not.
TEST_F(KeptMeshes, WithRegionsInAnotherOrderAreNotRead) {
  Mesh mesh = SmallMesh(3);
  mesh.regions = {{"a", {0, 1}}};
  const std::string one = PackMesh(mesh);
  mesh.regions = {{"b", {0, 1}}};
  const std::string other = PackMesh(mesh);
  mesh.regions = {};
  const std::size_t hash = Sha256Hex("").size(), region = one.size() - PackMesh(mesh).size();
  const auto with = [&](const std::string& last) {
    const std::string content = one.substr(hash) + last.substr(last.size() - region);
    return UnpackMesh(Sha256Hex(content) + content);
  };
  EXPECT_TRUE(with(other).has_value());
  EXPECT_FALSE(with(one).has_value());
  std::string reversed = other.substr(hash) + one.substr(one.size() - region);
  EXPECT_FALSE(UnpackMesh(Sha256Hex(reversed) + reversed).has_value());
}

TEST_F(KeptMeshes, AreGeneratedAgainIfTheirFileIsDamaged) {
  const MeshCache cache(folder_);
  const Mesh mesh = Get(cache, 3);
  const fs::path file = Files().front();
  const std::string whole = *ReadBytes(file);
  std::mt19937 random(1);
  for (int i = 0; i < 60; ++i) {
    std::string damaged = whole;
    if (i % 3 == 0) damaged.resize(random() % whole.size());
    if (!damaged.empty()) damaged[random() % damaged.size()] ^= static_cast<char>(1 + random() % 255);
    std::ofstream(file, std::ios::binary) << damaged;
    EXPECT_FALSE(UnpackMesh(damaged).has_value());
    EXPECT_EQ(Get(cache, 3).vertices, mesh.vertices);
  }
  EXPECT_EQ(generated_, 61);
  EXPECT_EQ(*ReadBytes(file), whole);
}

TEST_F(KeptMeshes, OfManyWritersAreWhole) {
  std::vector<std::thread> writers;
  for (int i = 0; i < 4; ++i) {
    writers.emplace_back([&] {
      for (int k = 0; k < 50; ++k) EXPECT_EQ(Get(MeshCache(folder_), k % 7).vertices, SmallMesh(k % 7).vertices);
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(Files().size(), 7);
}

TEST_F(KeptMeshes, TakeNoMoreRoomThanTheyMay) {
  const auto size = static_cast<std::int64_t>(PackMesh(SmallMesh(1)).size());
  const MeshCache cache(folder_, 3 * size);
  for (int k = 0; k < 20; ++k) Get(cache, k);
  EXPECT_EQ(Files().size(), 3);
  Get(cache, 19);
  EXPECT_EQ(generated_, 20) << "the latest is kept";
}

TEST_F(KeptMeshes, OfManyProgramsAreWhole) {
  std::vector<pid_t> programs;
  for (int i = 0; i < 3; ++i) {
    const pid_t program = fork();
    if (program == 0) {
      bool whole = true;
      for (int k = 0; k < 40; ++k)
        whole = whole && Get(MeshCache(folder_), k % 5).vertices == SmallMesh(k % 5).vertices;
      _exit(whole ? 0 : 1);
    }
    ASSERT_GT(program, 0);
    programs.push_back(program);
  }
  for (const pid_t program : programs) {
    int status = -1;
    EXPECT_EQ(waitpid(program, &status, 0), program);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(Files().size(), 5) << "no file is left unfinished";
  for (int k = 0; k < 5; ++k) Get(MeshCache(folder_), k);
  EXPECT_EQ(generated_, 0) << "each is read here";
}

TEST_F(KeptMeshes, ThatAreUsedStay) {
  const auto size = static_cast<std::int64_t>(PackMesh(SmallMesh(1)).size());
  const MeshCache cache(folder_, 3 * size);
  const auto age = [&](std::chrono::hours by) {
    for (const fs::path& file : Files()) fs::last_write_time(file, fs::last_write_time(file) - by);
  };
  for (int k = 0; k < 3; ++k) {
    Get(cache, k);
    age(std::chrono::hours(1));
  }
  Get(cache, 0);  // used last from now on
  Get(cache, 7);
  ASSERT_EQ(generated_, 4);
  Get(cache, 0);
  EXPECT_EQ(generated_, 4) << "the first is kept";
  Get(cache, 1);
  EXPECT_EQ(generated_, 5) << "the one that was used first is not";
}

TEST_F(KeptMeshes, OfAFolderThatCannotBeWrittenAreGenerated) {
  for (const std::string& folder : {std::string(), std::string("none"), std::string("/proc/nothing")}) {
    EXPECT_EQ(Get(MeshCache(folder), 5).vertices, SmallMesh(5).vertices);
  }
  EXPECT_EQ(generated_, 3);
}

TEST_F(KeptMeshes, AreNotMadeOfErrors) {
  const MeshCache cache(folder_);
  v1::Anatomy part;
  const auto none = cache.Get(part, {}, []() -> absl::StatusOr<Mesh> { return absl::InvalidArgumentError("no"); });
  EXPECT_EQ(none.status().message(), "no");
  EXPECT_FALSE(fs::exists(folder_));
}

}  // namespace
}  // namespace phrenic::session
