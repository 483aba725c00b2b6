// A store that has lost what it held is not opened as an empty one.
#include "server/store/marker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "server/store/check.h"
#include "server/store/store.h"

namespace phrenic::store {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

class MarkerTest : public testing::Test {
 protected:
  MarkerTest() { std::filesystem::remove_all(folder_); }
  ~MarkerTest() override {
    std::filesystem::remove_all(folder_);
    std::filesystem::remove_all(left_);
  }
  static std::unique_ptr<Store> Open(const std::string& folder) {
    auto store = Store::Open(folder);
    EXPECT_TRUE(store.ok()) << store.status();
    return *std::move(store);
  }
  // Saves a session; the journal keeps it, if it is kept.
  static std::shared_ptr<Journal> Save(Store& store, const std::string& id) {
    v1::SavedScene scene;
    scene.mutable_source()->mutable_scene()->set_name("cube");
    auto journal = store.Begin(id, scene);
    auto state = std::make_shared<State>();
    state->x = state->v = Points::Zero(3, 2);
    journal->Keep({}, state);
    EXPECT_TRUE(journal->Flush().ok());
    return journal;
  }
  // Has two sessions in a store that was closed.
  void SaveTwo() const {
    const auto store = Open(folder_);
    Save(*store, "a");
    Save(*store, "b");
  }
  void ExpectRefused(const std::string& what) const {
    const auto refused = Store::Open(folder_);
    ASSERT_FALSE(refused.ok());
    EXPECT_TRUE(absl::IsDataLoss(refused.status())) << refused.status();
    const std::string message(refused.status().message());
    EXPECT_THAT(message, HasSubstr(what));
    EXPECT_THAT(message, HasSubstr("phrenic.marker says that it holds 2 sessions"));
    EXPECT_THAT(message, HasSubstr("put both files back, or remove")) << "the remedy";
    const auto checked = CheckStore(folder_);
    EXPECT_FALSE(checked.ok() && checked->whole()) << "phrenicd check says so as well";
  }

  const std::string folder_ = testing::TempDir() + "phrenic_marker_" + std::to_string(getpid());
  const std::string left_ = folder_ + "_left";
};

TEST_F(MarkerTest, AMissingDatabaseIsRefused) {
  SaveTwo();
  std::filesystem::remove(StoreFile(folder_));
  ExpectRefused("is missing");
  EXPECT_FALSE(std::filesystem::exists(StoreFile(folder_))) << "nothing was created";
}

TEST_F(MarkerTest, AnEmptiedDatabaseIsRefused) {
  SaveTwo();
  std::filesystem::resize_file(StoreFile(folder_), 0);
  ExpectRefused("is empty");
}

TEST_F(MarkerTest, ADatabaseWhoseSessionsWereRemovedIsRefused) {
  SaveTwo();
  {
    auto database = Database::Open(StoreFile(folder_), Access::kWrite);
    ASSERT_TRUE(database->Run("DELETE FROM sessions").ok());
  }
  ExpectRefused("holds 0 sessions");
}

TEST_F(MarkerTest, AnotherStoresDatabaseIsRefused) {
  SaveTwo();
  { Save(*Open(left_), "a"); }
  std::filesystem::copy_file(StoreFile(left_), StoreFile(folder_), std::filesystem::copy_options::overwrite_existing);
  ExpectRefused("of another store");
}

// What a killed server leaves, without its write-ahead log.
TEST_F(MarkerTest, ALostWriteAheadLogIsRefused) {
  {
    const auto store = Open(left_);
    Save(*store, "a");
    Save(*store, "b");
    std::filesystem::copy(left_, folder_);
  }
  ASSERT_TRUE(std::filesystem::remove(StoreFile(folder_) + "-wal"));
  const auto refused = Store::Open(folder_);
  EXPECT_TRUE(absl::IsDataLoss(refused.status())) << refused.status();
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("phrenic.db-wal"));
}

// As many sessions, but older ones.
TEST_F(MarkerTest, AnOlderDatabaseIsRefused) {
  SaveTwo();
  std::filesystem::copy(folder_, left_);
  {
    const auto store = Open(folder_);
    Save(*store, "c")->Forget();
  }
  std::filesystem::copy_file(StoreFile(left_), StoreFile(folder_), std::filesystem::copy_options::overwrite_existing);
  ExpectRefused("is older");
}

TEST_F(MarkerTest, RefusingChangesNothingAndTheFilesCanBePutBack) {
  {
    const auto store = Open(left_);
    Save(*store, "a");
    Save(*store, "b");
    std::error_code changed;  // the store renames files while it saves
    for (int i = 0; i < 100; ++i) {
      std::filesystem::remove_all(folder_);
      std::filesystem::copy(left_, folder_, changed);
      if (!changed) break;
    }
    ASSERT_FALSE(changed) << changed.message();
  }
  const std::string log = StoreFile(folder_) + "-wal";
  std::filesystem::rename(log, log + ".away");
  EXPECT_FALSE(Store::Open(folder_).ok());
  std::filesystem::rename(log + ".away", log);
  EXPECT_THAT(*Open(folder_)->Load(), SizeIs(2));
}

TEST_F(MarkerTest, RemovingTheMarkerGoesOnWithWhatThereIs) {
  SaveTwo();
  std::filesystem::resize_file(StoreFile(folder_), 0);
  std::filesystem::remove(MarkerFile(folder_));
  {
    const auto store = Open(folder_);
    EXPECT_THAT(*store->Load(), SizeIs(0));
    Save(*store, "new");
  }
  EXPECT_THAT(*Open(folder_)->Load(), SizeIs(1));
}

TEST_F(MarkerTest, DeletedSessionsAreNotMissed) {
  {
    const auto store = Open(folder_);
    for (const char* id : {"a", "b", "c"}) Save(*store, id);
  }
  for (const char* id : {"a", "b", "c"}) {
    const auto store = Open(folder_);
    const auto sessions = store->Load();
    ASSERT_TRUE(sessions.ok()) << sessions.status();
    for (const SavedSession& saved : *sessions) {
      if (saved.id == id) store->Continue(saved)->Forget();
    }
  }
  EXPECT_THAT(*Open(folder_)->Load(), SizeIs(0));
  EXPECT_EQ((*ReadMarkerFile(folder_))->sessions, 0);
  std::filesystem::remove(StoreFile(folder_));
  EXPECT_THAT(*Open(folder_)->Load(), SizeIs(0)) << "there was nothing to lose";
}

TEST_F(MarkerTest, AStoreOfAnEarlierReleaseHasNoMarkerAndGetsOne) {
  SaveTwo();
  std::filesystem::remove(MarkerFile(folder_));
  {
    auto database = Database::Open(StoreFile(folder_), Access::kWrite);
    ASSERT_TRUE(database->Run("DROP TABLE marker; PRAGMA user_version = 2").ok());
  }
  {
    const auto store = Open(folder_);
    Save(*store, "c");
  }
  const auto marker = ReadMarkerFile(folder_);
  ASSERT_TRUE(marker.ok() && marker->has_value()) << marker.status();
  EXPECT_EQ((*marker)->sessions, 3);
  std::filesystem::remove(StoreFile(folder_));
  EXPECT_FALSE(Store::Open(folder_).ok());
}

TEST_F(MarkerTest, ADamagedMarkerIsNamed) {
  SaveTwo();
  std::ofstream(MarkerFile(folder_)) << "sessions many\n";
  const auto refused = Store::Open(folder_);
  EXPECT_TRUE(absl::IsDataLoss(refused.status()));
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("phrenic.marker cannot be read or is damaged"));
}

}  // namespace
}  // namespace phrenic::store
