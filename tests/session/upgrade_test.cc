// Sessions of another build of Phrenic go on.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "server/crypto/sha256.h"
#include "server/session/table.h"
#include "server/store/sqlite.h"
#include "tests/fake_clock.h"

namespace phrenic::session {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// The state hash of each session, as that release printed it (tests/store/releases/make).
const std::map<std::string, std::string> kRelease = {{"sheet-2d", "1797f5e34ed1f217"},
                                                     {"tensegrity-prism", "b3ab34ec99e4b532"},
                                                     {"mixed-methods", "36a92414735bf9e4"},
                                                     {"fem-liver-diaphragm", "2cdf90a61e07b9c3"}};

// A copy of the last release's store, and a server on it.
class UpgradeTest : public testing::Test {
 protected:
  UpgradeTest() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    std::filesystem::copy(PHRENIC_SOURCE_DIR "/tests/store/releases/0.1.0-2026-11-26.db", store::StoreFile(folder_));
  }
  ~UpgradeTest() override {
    End();
    std::filesystem::remove_all(folder_);
  }
  void Begin() {
    auto store = store::Store::Open(folder_);
    ASSERT_TRUE(store.ok()) << store.status();
    store_ = *std::move(store);
    table_ = std::make_unique<Table>(models_, clock_, Limits(), store_.get());
    auto lost = table_->Restore([](const std::string&) {});
    ASSERT_TRUE(lost.ok()) << lost.status();
    lost_ = *std::move(lost);
  }
  void End() {
    table_.reset();
    store_.reset();
  }
  std::shared_ptr<Session> Find(const std::string& id) const {
    auto session = table_->Find(id);
    EXPECT_TRUE(session.ok()) << session.status();
    return session.ok() ? *session : nullptr;
  }
  static std::string HashOf(Session& session) { return HashText(session.MakeFork()->state); }

  // Changes what the store has of every session, as another build would have written it.
  void Rewrite(const std::function<void(v1::SavedScene& scene, v1::SavedState& state)>& change) const {
    auto database = store::Database::Open(store::StoreFile(folder_), store::Access::kWrite);
    ASSERT_TRUE(database.ok()) << database.status();
    const auto sessions = store::ReadSessions(*database);
    ASSERT_TRUE(sessions.ok()) << sessions.status();
    for (store::SavedSession saved : *sessions) {
      change(saved.scene, saved.state);
      const std::string scene = saved.scene.SerializeAsString(), moment = saved.moment.SerializeAsString(),
                        state = saved.state.SerializeAsString();
      auto update = store::Statement::Prepare(*database,
                                              "UPDATE sessions SET scene = ?2, scene_sha256 = ?3, moment = ?4, state = "
                                              "?5, sha256 = ?6 WHERE id = ?1");
      ASSERT_TRUE(update.ok()) << update.status();
      update->Bind(1, saved.id).BindBytes(2, scene).Bind(3, Sha256Hex(scene)).BindBytes(4, moment);
      ASSERT_TRUE(update->BindBytes(5, state).Bind(6, Sha256Hex(moment + state)).Run().ok());
    }
  }

  const std::string folder_ = testing::TempDir() + "phrenic_upgrade_" + std::to_string(getpid());
  FakeClock clock_;
  Models models_{SceneCatalogue({PHRENIC_SCENES_DIR}), "", 8};
  std::unique_ptr<store::Store> store_;
  std::unique_ptr<Table> table_;
  std::map<std::string, absl::Status> lost_;
};

// Where the scenes still compile to the same bits, their sessions are those of the release, bit for bit; elsewhere they
// are carried over.
TEST_F(UpgradeTest, EverySessionOfTheLastReleaseGoesOn) {
  Begin();
  EXPECT_THAT(lost_, IsEmpty());
  for (const auto& [id, hash] : kRelease) {
    const auto session = Find(id);
    ASSERT_NE(session, nullptr);
    EXPECT_EQ(session->status().tick(), 41) << id;
    EXPECT_EQ(session->status().parameters().breath_force(), 1.25) << id;
    EXPECT_EQ(session->status().parameters().breath_length(), 3) << id;
    if (session->status().carried_over().empty()) {
      EXPECT_EQ(HashOf(*session), hash) << id;
    }
    EXPECT_TRUE(session->Step(20, std::nullopt, [] { return false; }).ok()) << id;
  }
}

// Its bending is another element than in that release, so the steps that are taken again end elsewhere.
constexpr char kOtherForces[] = "fem-liver-diaphragm";

TEST_F(UpgradeTest, ASessionWhoseSceneCompilesToOtherBitsGoesOnFromItsSavedState) {
  Rewrite([](v1::SavedScene& scene, v1::SavedState&) { scene.set_scene_hash("of another build"); });
  Begin();
  EXPECT_THAT(lost_, IsEmpty());
  for (const auto& [id, hash] : kRelease) {
    const auto session = Find(id);
    ASSERT_NE(session, nullptr);
    if (id != kOtherForces) {
      EXPECT_EQ(HashOf(*session), hash) << id << ": its numbers were matched by index";
    }
    EXPECT_THAT(session->status().carried_over(), HasSubstr("matched by index")) << id;
    EXPECT_THAT(session->status().carried_over(), HasSubstr("steps were taken again by this build")) << id;
  }
  EXPECT_EQ(table_->carried_over().size(), kRelease.size());
}

TEST_F(UpgradeTest, ASessionThatWasCarriedOverBeginsANewRecord) {
  Rewrite([](v1::SavedScene& scene, v1::SavedState&) { scene.set_scene_hash("of another build"); });
  Begin();
  for (const auto& [id, hash] : kRelease) ASSERT_TRUE(Find(id)->Step(7, std::nullopt, [] { return false; }).ok());
  std::map<std::string, std::string> hashes;
  for (const auto& [id, hash] : kRelease) hashes[id] = HashOf(*Find(id));
  End();
  Begin();
  EXPECT_THAT(lost_, IsEmpty());
  EXPECT_THAT(table_->carried_over(), IsEmpty()) << "it was said before";
  for (const auto& [id, hash] : hashes) {
    EXPECT_EQ(HashOf(*Find(id)), hash) << id;
    EXPECT_EQ(Find(id)->status().tick(), 48) << id;
  }
}

// Writes names and rest positions first, as this build does.
TEST_F(UpgradeTest, VerticesInAnotherOrderAreMatchedByTheirRestPositions) {
  Rewrite([](v1::SavedScene& scene, v1::SavedState&) { scene.set_scene_hash("of another build"); });
  Begin();
  End();
  Rewrite([](v1::SavedScene& scene, v1::SavedState& state) {
    scene.set_scene_hash("of another build");
    state.clear_history();
    for (v1::SavedBody& body : *scene.mutable_bodies()) {
      constexpr std::size_t kRest = 3 * sizeof(float), kVertex = 3 * sizeof(double);
      const std::string rest = body.rest(), x = state.positions(), v = state.velocities();
      const std::size_t count = rest.size() / kRest, first = static_cast<std::size_t>(body.first_vertex());
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t other = count - 1 - i;
        body.mutable_rest()->replace(i * kRest, kRest, rest, other * kRest, kRest);
        for (auto [to, from] : {std::pair(state.mutable_positions(), &x), {state.mutable_velocities(), &v}}) {
          to->replace((first + i) * kVertex, kVertex, *from, (first + other) * kVertex, kVertex);
        }
      }
    }
  });
  Begin();
  EXPECT_THAT(lost_, IsEmpty());
  for (const auto& [id, hash] : kRelease) {
    const auto session = Find(id);
    ASSERT_NE(session, nullptr);
    EXPECT_THAT(session->status().carried_over(), HasSubstr("by the nearest rest positions")) << id;
    EXPECT_EQ(session->status().tick(), 41) << id;
    EXPECT_TRUE(session->Step(100, std::nullopt, [] { return false; }).ok()) << id;
  }
}

TEST_F(UpgradeTest, WhatCannotBeMatchedStaysAndTheNextBuildTriesAgain) {
  const auto set_hash = [](v1::SavedScene& scene, v1::SavedState&) { scene.set_scene_hash("of another build"); };
  std::map<std::string, std::string> whole;
  Rewrite([&](v1::SavedScene& scene, v1::SavedState& state) {
    set_hash(scene, state);
    whole[scene.source().scene().name()] = state.positions();
    state.mutable_positions()->resize(state.positions().size() - 3 * sizeof(double));
  });
  for (int build = 0; build < 2; ++build) {
    Begin();
    for (const auto& [id, hash] : kRelease) {
      ASSERT_TRUE(lost_.contains(id)) << id;
      EXPECT_THAT(std::string(lost_[id].message()), HasSubstr("cannot be matched")) << id;
      EXPECT_THAT(std::string(lost_[id].message()), HasSubstr("run the version that saved it")) << id;
    }
    End();
  }
  Rewrite(
      [&](v1::SavedScene& scene, v1::SavedState& state) { state.set_positions(whole[scene.source().scene().name()]); });
  Begin();
  EXPECT_THAT(lost_, IsEmpty()) << "a later build understands them";
}

// A store without rest positions cannot say that the order changed; the edges do.
TEST_F(UpgradeTest, VerticesInAWrongOrderAreNotTakenForRight) {
  Rewrite([](v1::SavedScene& scene, v1::SavedState& state) {
    scene.set_scene_hash("of another build");
    constexpr std::size_t kVertex = 3 * sizeof(double);
    const std::string x = state.positions();
    const std::size_t count = x.size() / kVertex;
    for (std::size_t i = 0; i < count; ++i) {
      state.mutable_positions()->replace(i * kVertex, kVertex, x, (i * 7919 % count) * kVertex, kVertex);
    }
  });
  Begin();
  for (const char* id : {"sheet-2d", "mixed-methods", "fem-liver-diaphragm"}) EXPECT_TRUE(lost_.contains(id)) << id;
}

TEST_F(UpgradeTest, AStateThatIsNotFiniteIsKeptAside) {
  Rewrite([](v1::SavedScene& scene, v1::SavedState& state) {
    scene.set_scene_hash("of another build");
    const double bad = std::numeric_limits<double>::quiet_NaN();
    state.mutable_velocities()->replace(0, sizeof bad, reinterpret_cast<const char*>(&bad), sizeof bad);
  });
  Begin();
  EXPECT_EQ(lost_.size(), kRelease.size());
}

}  // namespace
}  // namespace phrenic::session
