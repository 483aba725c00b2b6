// Saved data is read back after the store is opened again, complete or reported as damaged.
#include "server/store/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include "absl/time/clock.h"
#include "server/store/check.h"
#include "server/store/saved_state.h"
#include "server/store/sqlite.h"

namespace phrenic::store {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

class StoreTest : public testing::Test {
 protected:
  StoreTest() { std::filesystem::remove_all(folder_); }
  ~StoreTest() override { std::filesystem::remove_all(folder_); }

  std::unique_ptr<Store> Open() const {
    auto store = Store::Open(folder_);
    EXPECT_TRUE(store.ok()) << store.status();
    return *std::move(store);
  }
  static v1::SavedScene Scene(const std::string& name) {
    v1::SavedScene scene;
    scene.mutable_source()->mutable_scene()->set_name(name);
    return scene;
  }
  static v1::SavedMoment At(std::int64_t tick) {
    v1::SavedMoment moment;
    moment.mutable_session()->set_tick(tick);
    return moment;
  }
  static std::shared_ptr<const State> StateAt(std::int64_t tick) {
    auto state = std::make_shared<State>();
    state->tick = tick;
    state->x = state->v = Points::Constant(3, 2, 0.1 * static_cast<double>(tick));
    return state;
  }
  static std::vector<std::int64_t> Ticks(const SavedSession& session) {
    std::vector<std::int64_t> ticks = {session.state.tick()};
    for (const v1::SavedMoment& moment : session.later) ticks.push_back(moment.session().tick());
    return ticks;
  }
  // Changes the file's bytes by `change`.
  void Damage(const std::function<void(std::string&)>& change) const {
    std::ifstream in(StoreFile(folder_), std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), {});
    change(bytes);
    std::ofstream(StoreFile(folder_), std::ios::binary) << bytes;
  }

  const std::string folder_ = testing::TempDir() + "phrenic_store_" + std::to_string(getpid());
};

TEST_F(StoreTest, ASessionIsItsLastStateAndTheJournalSince) {
  {
    const auto store = Open();
    const auto journal = store->Begin("a", Scene("cube"));
    journal->Keep(At(0), StateAt(0));
    journal->Append(At(3), false);
    journal->Append(At(5), false);
    ASSERT_TRUE(journal->Flush().ok());
    journal->Keep(At(7), StateAt(7));
    journal->Append(At(9), false);
    ASSERT_TRUE(journal->Flush().ok());
  }
  const auto sessions = Open()->Load();
  ASSERT_TRUE(sessions.ok()) << sessions.status();
  ASSERT_THAT(*sessions, SizeIs(1));
  EXPECT_EQ((*sessions)[0].id, "a");
  EXPECT_EQ((*sessions)[0].scene.source().scene().name(), "cube");
  EXPECT_THAT(Ticks((*sessions)[0]), ElementsAre(7, 9));
  EXPECT_EQ((*sessions)[0].moment.session().tick(), 7);
}

TEST_F(StoreTest, MomentsInWhichOnlyTimeChangesReplaceEachOther) {
  {
    const auto store = Open();
    const auto journal = store->Begin("a", Scene("cube"));
    journal->Keep(At(0), StateAt(0));
    for (const std::int64_t tick : {1, 2, 3}) {
      journal->Append(At(tick), true);
      ASSERT_TRUE(journal->Flush().ok());
    }
    journal->Append(At(4), false);
    journal->Append(At(5), true);
  }
  EXPECT_THAT(Ticks(Open()->Load()->at(0)), ElementsAre(0, 3, 4, 5));
}

TEST_F(StoreTest, ALoadedSessionContinuesItsJournal) {
  {
    const auto store = Open();
    const auto journal = store->Begin("a", Scene("cube"));
    journal->Keep(At(0), StateAt(0));
    journal->Append(At(1), false);
  }
  {
    const auto store = Open();
    store->Continue(store->Load()->at(0))->Append(At(2), false);
  }
  EXPECT_THAT(Ticks(Open()->Load()->at(0)), ElementsAre(0, 1, 2));
}

TEST_F(StoreTest, AForgottenSessionIsGoneAndItsIdIsFree) {
  {
    const auto store = Open();
    const auto old = store->Begin("a", Scene("cube"));
    old->Keep(At(0), StateAt(0));
    old->Append(At(1), false);
    ASSERT_TRUE(old->Flush().ok());
    old->Forget();
    old->Append(At(2), false);
    const auto other = store->Begin("a", Scene("prism"));
    other->Keep(At(5), StateAt(5));
    ASSERT_TRUE(other->Flush().ok());
  }
  const auto sessions = Open()->Load();
  ASSERT_THAT(*sessions, SizeIs(1));
  EXPECT_EQ((*sessions)[0].scene.source().scene().name(), "prism");
  EXPECT_THAT(Ticks((*sessions)[0]), ElementsAre(5));
}

TEST_F(StoreTest, TwoServersCannotUseOneStore) {
  const auto first = Open();
  const auto second = Store::Open(folder_);
  EXPECT_TRUE(absl::IsFailedPrecondition(second.status())) << second.status();
  EXPECT_THAT(std::string(second.status().message()), HasSubstr("in use by another server"));
}

TEST_F(StoreTest, ANewerFormatIsRefusedAndLeftUnchanged) {
  { Open(); }
  {
    auto database = Database::Open(StoreFile(folder_), Access::kWrite);
    ASSERT_TRUE(database->Run("PRAGMA user_version = 99").ok());
  }
  const auto store = Store::Open(folder_);
  EXPECT_TRUE(absl::IsFailedPrecondition(store.status())) << store.status();
  EXPECT_THAT(std::string(store.status().message()), HasSubstr("format 99, written by a newer Phrenic"));
  EXPECT_EQ(*Database::Open(StoreFile(folder_), Access::kRead)->Number("PRAGMA user_version"), 99);
}

TEST_F(StoreTest, AFileThatIsNoStoreIsRefused) {
  std::filesystem::create_directories(folder_);
  Damage([](std::string& bytes) { bytes = std::string(5000, 'x'); });
  EXPECT_TRUE(absl::IsDataLoss(Store::Open(folder_).status())) << Store::Open(folder_).status();
  std::filesystem::remove(StoreFile(folder_));
  ASSERT_TRUE(Database::Open(StoreFile(folder_), Access::kWrite)->Run("CREATE TABLE t (a)").ok());
  EXPECT_THAT(std::string(Store::Open(folder_).status().message()), HasSubstr("belongs to another program"));
}

TEST_F(StoreTest, EveryFlippedByteOfASessionIsDetected) {
  {
    const auto store = Open();
    for (const char* id : {"a", "b"}) {
      const auto journal = store->Begin(id, Scene("cube"));
      journal->Keep(At(0), StateAt(3));
    }
  }
  const std::string saved = Save(*StateAt(3)).SerializeAsString();
  int found = 0;
  for (size_t at = 0; at < saved.size(); at += 7) {
    Damage([&](std::string& bytes) {
      const size_t first = bytes.find(saved);
      ASSERT_NE(first, std::string::npos);
      bytes[first + at] = static_cast<char>(bytes[first + at] ^ 1);
    });
    const auto store = Store::Open(folder_);
    ASSERT_TRUE(store.ok()) << store.status();
    const auto sessions = (*store)->Load();
    ASSERT_THAT(*sessions, SizeIs(2));
    found += (*sessions)[0].problem.ok() && (*sessions)[1].problem.ok() ? 0 : 1;
    Damage([&](std::string& bytes) {
      std::string flipped = saved;
      flipped[at] = static_cast<char>(flipped[at] ^ 1);
      const size_t first = bytes.find(flipped);
      if (first != std::string::npos) bytes[first + at] = saved[at];
    });
  }
  EXPECT_EQ(found, static_cast<int>((saved.size() + 6) / 7));
}

TEST_F(StoreTest, CheckReportsContentAndDamage) {
  EXPECT_TRUE(absl::IsNotFound(CheckStore(folder_).status()));
  {
    const auto store = Open();
    for (const char* id : {"a", "b"}) {
      const auto journal = store->Begin(id, Scene("cube"));
      journal->Keep(At(0), StateAt(3));
      journal->Append(At(5), false);
      ASSERT_TRUE(journal->Flush().ok());
    }
    EXPECT_TRUE(absl::IsFailedPrecondition(CheckStore(folder_).status())) << "it is in use";
  }
  const auto good = CheckStore(folder_);
  ASSERT_TRUE(good.ok()) << good.status();
  EXPECT_TRUE(good->whole());
  EXPECT_THAT(Describe(folder_, *good), HasSubstr("2 sessions, whole"));
  Damage([](std::string& bytes) { bytes[bytes.find(Save(*StateAt(3)).SerializeAsString()) + 9] ^= 1; });
  const auto damaged = CheckStore(folder_);
  ASSERT_TRUE(damaged.ok()) << damaged.status();
  EXPECT_FALSE(damaged->whole());
  EXPECT_THAT(Describe(folder_, *damaged), HasSubstr("its state is damaged in the store"));
  Damage([](std::string& bytes) { bytes.resize(bytes.size() / 2); });
  EXPECT_FALSE(CheckStore(folder_).ok() && CheckStore(folder_)->whole());
}

TEST_F(StoreTest, AFullDiskIsReportedAndEverythingIsSavedOnceThereIsRoom) {
  {
    const auto store = Open();
    const auto journal = store->Begin("a", Scene("cube"));
    journal->Keep(At(0), StateAt(0));
    ASSERT_TRUE(journal->Flush().ok());
    ASSERT_TRUE(store->LimitSize(8 * 4096).ok());
    auto large = std::make_shared<State>(*StateAt(4));
    large->x = large->v = Points::Random(3, 4000);
    journal->Keep(At(4), large);
    journal->Append(At(5), false);
    const absl::Status full = journal->Flush();
    EXPECT_TRUE(absl::IsResourceExhausted(full)) << full;
    EXPECT_THAT(std::string(full.message()), HasSubstr("is full"));
    ASSERT_TRUE(store->LimitSize(1 << 28).ok());
    absl::Status status = full;
    for (int i = 0; i < 50 && !status.ok(); ++i) {
      absl::SleepFor(absl::Milliseconds(100));
      status = journal->Flush();
    }
    EXPECT_TRUE(status.ok()) << status;
  }
  EXPECT_THAT(Ticks(Open()->Load()->at(0)), ElementsAre(4, 5));
}

TEST_F(StoreTest, RecordsAreTheNewestOfEachKindAndName) {
  {
    const auto store = Open();
    store->Put("study", "b", "1");
    store->Put("study", "a", "2");
    store->Put("other", "a", "3");
    store->Put("study", "gone", "4");
    store->Remove("study", "gone");
  }
  {
    const auto store = Open();
    store->Put("study", "b", std::string("\0new", 4));
  }
  const auto records = Open()->LoadRecords();
  ASSERT_TRUE(records.ok()) << records.status();
  std::vector<std::vector<std::string>> found;
  for (const SavedRecord& record : *records) found.push_back({record.kind, record.id, record.bytes});
  EXPECT_THAT(found, ElementsAre(ElementsAre("study", "b", std::string("\0new", 4)), ElementsAre("study", "a", "2"),
                                 ElementsAre("other", "a", "3")));
}

// Copies the files while the store has them open, which is what remains after a power failure.
TEST_F(StoreTest, ARecordIsOnTheDiskAfterFlush) {
  const auto store = Open();
  store->Put("study", "a", "1");
  ASSERT_TRUE(store->FlushRecords().ok());
  const std::string left = folder_ + "_left";
  std::filesystem::copy(folder_, left);
  EXPECT_THAT(*(*Store::Open(left))->LoadRecords(), SizeIs(1));
  std::filesystem::remove_all(left);
  ASSERT_TRUE(store->LimitSize(8 * 4096).ok());
  store->Put("study", "large", std::string(100'000, 'x'));
  const absl::Status full = store->FlushRecords();
  EXPECT_TRUE(absl::IsResourceExhausted(full)) << full;
}

TEST_F(StoreTest, ADamagedRecordIsReportedAndTheOthersAreRead) {
  {
    const auto store = Open();
    store->Put("study", "bad", "what was written");
    store->Put("study", "good", "2");
  }
  {
    auto database = Database::Open(StoreFile(folder_), Access::kWrite);
    ASSERT_TRUE(database.ok());
    ASSERT_TRUE(database->Run("UPDATE records SET bytes = 'what is read' WHERE id = 'bad'").ok());
  }
  const auto checked = CheckStore(folder_);
  ASSERT_TRUE(checked.ok()) << checked.status();
  EXPECT_FALSE(checked->whole());
  EXPECT_THAT(Describe(folder_, *checked), HasSubstr("study bad is damaged in the store\n"));
  const auto records = Open()->LoadRecords();
  ASSERT_THAT(*records, SizeIs(2));
  EXPECT_TRUE(absl::IsDataLoss(records->at(0).problem));
  EXPECT_TRUE(records->at(1).problem.ok());
}

TEST_F(StoreTest, AStoreOfTheFirstFormatOpensAndKeepsItsSessions) {
  {
    const auto store = Open();
    const auto journal = store->Begin("old", Scene("cube"));
    journal->Keep(At(4), StateAt(4));
    ASSERT_TRUE(journal->Flush().ok());
  }
  {
    auto database = Database::Open(StoreFile(folder_), Access::kWrite);
    ASSERT_TRUE(database.ok());
    ASSERT_TRUE(database->Run("DROP TABLE records; PRAGMA user_version = 1").ok());
  }
  const auto store = Open();
  ASSERT_THAT(*store->Load(), SizeIs(1));
  store->Put("study", "a", "1");
}

}  // namespace
}  // namespace phrenic::store
