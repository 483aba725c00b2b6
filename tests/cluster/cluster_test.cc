// A session has one server at a time, and only that server writes its copy.
#include "server/cluster/cluster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <thread>

#include "server/cluster/scripts.h"
#include "tests/cluster/redis_server.h"

namespace phrenic::cluster {
namespace {

// A cluster member without a session table: records what its hooks are called with.
class Member {
 public:
  Member(const RedisServer& redis, std::string address) {
    auto joined = Cluster::Join({.redis = redis.url(), .advertise = std::move(address)});
    EXPECT_TRUE(joined.ok()) << joined.status();
    cluster_ = *std::move(joined);
    cluster_->Start({.lost =
                         [this](const std::string& id) {
                           absl::MutexLock lock(&mutex_);
                           lost_.insert(id);
                         },
                     .take_over =
                         [this](const store::SavedSession& saved, std::int64_t epoch) {
                           absl::MutexLock lock(&mutex_);
                           taken_over_.push_back({saved, epoch});
                           return absl::OkStatus();
                         },
                     .copy_whole =
                         [this](const std::vector<std::string>& ids) {
                           absl::MutexLock lock(&mutex_);
                           asked_.insert(ids.begin(), ids.end());
                         }});
  }
  Cluster* operator->() { return cluster_.get(); }
  bool Lost(const std::string& id) {
    absl::MutexLock lock(&mutex_);
    return lost_.contains(id);
  }
  bool AskedFor(const std::string& id) {
    absl::MutexLock lock(&mutex_);
    return asked_.contains(id);
  }
  struct TakenOver {
    store::SavedSession saved;
    std::int64_t epoch = 0;
  };
  std::vector<TakenOver> taken_over() {
    absl::MutexLock lock(&mutex_);
    return taken_over_;
  }

 private:
  absl::Mutex mutex_;
  std::set<std::string> lost_ ABSL_GUARDED_BY(mutex_), asked_ ABSL_GUARDED_BY(mutex_);
  std::vector<TakenOver> taken_over_ ABSL_GUARDED_BY(mutex_);
  std::unique_ptr<Cluster> cluster_;  // destroyed first, since its threads use the other members
};

v1::SavedMoment MomentAt(std::int64_t tick) {
  v1::SavedMoment moment;
  moment.mutable_session()->set_tick(tick);
  return moment;
}

store::Written StateAt(const std::string& id, std::int64_t sequence) {
  store::Written written;
  written.id = id;
  written.scene.emplace().set_scene_hash("hash");
  written.sequence = sequence;
  written.moment = MomentAt(sequence);
  auto state = std::make_shared<State>();
  state->tick = sequence;
  written.state = std::move(state);
  return written;
}

store::Written MomentOf(const std::string& id, std::int64_t sequence) {
  store::Written written;
  written.id = id;
  written.moments.emplace_back(sequence, MomentAt(sequence));
  return written;
}

store::SavedSession SavedAt(const std::string& id, std::int64_t epoch, std::int64_t sequence) {
  store::SavedSession saved;
  saved.id = id;
  saved.moment = MomentAt(sequence);
  saved.moment.mutable_session()->set_epoch(epoch);
  saved.sequence = sequence;
  return saved;
}

// Returns true once the condition is true; false after the timeout.
template <class Wanted>
bool Within(absl::Duration time, Wanted wanted) {
  for (const absl::Time end = absl::Now() + time; absl::Now() < end; absl::SleepFor(absl::Milliseconds(10))) {
    if (wanted()) return true;
  }
  return wanted();
}

class ClusterTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!RedisServer::Installed()) GTEST_SKIP() << "there is no redis-server here (deploy/packages.txt)";
    std::signal(SIGPIPE, SIG_IGN);
    redis_ = std::make_unique<RedisServer>();
  }
  std::unique_ptr<RedisServer> redis_;
};

TEST_F(ClusterTest, ASessionHasOneServer) {
  Member a(*redis_, "a:1"), b(*redis_, "b:1");
  EXPECT_EQ(*a->Claim("s"), 1);
  EXPECT_EQ(b->Claim("s").status().code(), absl::StatusCode::kAlreadyExists);
  EXPECT_EQ(a->Locate("s").kind, Location::Kind::kLocal);
  const Location seen = b->Locate("s");
  EXPECT_EQ(seen.kind, Location::Kind::kRemote);
  EXPECT_EQ(seen.address, "a:1");
  EXPECT_EQ(b->Locate("t").kind, Location::Kind::kNone);
  a->Abandon("s");
  EXPECT_EQ(*b->Claim("s"), 2) << "an epoch was reused";
}

TEST_F(ClusterTest, ASlowServerCannotOverwriteItsSuccessor) {
  Member b(*redis_, "b:1");
  b->StartTakeovers();
  Member a(*redis_, "a:1");
  ASSERT_TRUE(a->Claim("s").ok());
  ASSERT_EQ(a->Copy(StateAt("s", 1)), store::Copied::kYes);
  ASSERT_EQ(a->Copy(MomentOf("s", 2)), store::Copied::kYes);
  ASSERT_EQ(a->Copy(MomentOf("s", 3)), store::Copied::kYes);
  a->Leave();  // stops renewing, as a suspended process does
  ASSERT_TRUE(Within(absl::Seconds(6), [&] { return !b.taken_over().empty(); }));
  const Member::TakenOver taken = b.taken_over()[0];
  EXPECT_EQ(taken.epoch, 2);
  EXPECT_EQ(taken.saved.state.tick(), 1);
  EXPECT_EQ(taken.saved.sequence, 3);
  ASSERT_EQ(taken.saved.later.size(), 2U);
  EXPECT_EQ(taken.saved.later[1].session().tick(), 3);
  EXPECT_EQ(a->Copy(MomentOf("s", 4)), store::Copied::kLost) << "a later epoch exists";
  EXPECT_EQ(a->Locate("s").address, "b:1") << "its lease had expired by its own clock, so it asked Redis";
  EXPECT_TRUE(a.Lost("s"));
  EXPECT_EQ(b->Copy(StateAt("s", 1)), store::Copied::kYes);
}

// The median of three, because a loaded machine may delay one of them.
TEST_F(ClusterTest, AReleasedSessionIsTakenOverAtOnce) {
  Member b(*redis_, "b:1");
  b->StartTakeovers();
  Member a(*redis_, "a:1");
  const auto time_to_go_on = [&](const std::string& id) {
    const std::size_t before = b.taken_over().size();
    EXPECT_TRUE(a->Claim(id).ok());
    EXPECT_EQ(a->Copy(StateAt(id, 1)), store::Copied::kYes);
    const absl::Time released = absl::Now();
    a->Release(id);
    EXPECT_TRUE(Within(absl::Seconds(10), [&] { return b.taken_over().size() > before; })) << id;
    return absl::Now() - released;
  };
  time_to_go_on("first");  // nothing is taken over in the first 3 s
  std::array times = {time_to_go_on("s"), time_to_go_on("t"), time_to_go_on("u")};
  std::ranges::sort(times);
  EXPECT_LE(times[1], absl::Milliseconds(600));
}

TEST_F(ClusterTest, SessionsContinueWithoutRedisAndAreCopiedAgainWhenItReturnsEmpty) {
  Member a(*redis_, "a:1");
  ASSERT_TRUE(a->Claim("s").ok());
  redis_->Kill();
  EXPECT_TRUE(Within(absl::Seconds(3), [&] { return !a->counts().redis_reachable; }));
  absl::SleepFor(absl::Seconds(3.2));  // its lease has expired
  const absl::Time asked = absl::Now();
  EXPECT_EQ(a->Locate("s").kind, Location::Kind::kLocal);
  EXPECT_EQ(a->Locate("t").kind, Location::Kind::kUnknown);
  EXPECT_EQ(a->Copy(StateAt("s", 1)), store::Copied::kLater) << "an incomplete copy must not end the session";
  EXPECT_EQ(a->CheckLease("s").code(), absl::StatusCode::kUnavailable) << "another server may have it";
  EXPECT_EQ(a->Delete("s").code(), absl::StatusCode::kUnavailable);
  EXPECT_LT(absl::Now() - asked, absl::Seconds(1));
  EXPECT_EQ(a->Claim("u").status().code(), absl::StatusCode::kUnavailable);
  redis_->Start();
  EXPECT_TRUE(Within(absl::Seconds(4), [&] { return a.AskedFor("s"); }));
  EXPECT_TRUE(a->counts().redis_reachable);
  EXPECT_FALSE(a.Lost("s"));
}

// A connection that was given up may deliver its last command long after.
TEST_F(ClusterTest, ALateWriteDoesNotUndoALaterOne) {
  Member b(*redis_, "b:1");
  b->StartTakeovers();
  Member a(*redis_, "a:1");
  ASSERT_TRUE(a->Claim("s").ok());
  ASSERT_EQ(a->Copy(StateAt("s", 1)), store::Copied::kYes);
  ASSERT_EQ(a->Copy(StateAt("s", 5)), store::Copied::kYes);
  ASSERT_EQ(a->Copy(MomentOf("s", 6)), store::Copied::kYes);
  Redis redis(*ParseRedisAddress(redis_->url()));
  const std::string old = MomentAt(1).SerializeAsString();
  ASSERT_TRUE(redis.Run(kSave, {"s", "1", "1", "", "1", old, "", "2", old}).ok());
  ASSERT_TRUE(redis.Run(kSave, {"s", "1", "3", "", "", "", "", "6", old}).ok());
  a->Leave();
  ASSERT_TRUE(Within(absl::Seconds(6), [&] { return !b.taken_over().empty(); }));
  const store::SavedSession saved = b.taken_over()[0].saved;
  EXPECT_EQ(saved.state.tick(), 5);
  ASSERT_EQ(saved.later.size(), 1U);
  EXPECT_EQ(saved.later[0].session().tick(), 6);
}

TEST_F(ClusterTest, ADeletedSessionIsNotWrittenOrRenewedAgain) {
  Member a(*redis_, "a:1"), b(*redis_, "b:1");
  b->StartTakeovers();
  ASSERT_TRUE(a->Claim("s").ok());
  ASSERT_EQ(a->Copy(StateAt("s", 1)), store::Copied::kYes);
  // As if its answer had been lost.
  Redis redis(*ParseRedisAddress(redis_->url()));
  ASSERT_TRUE(redis.Run(kDelete, {"s", "1", "60"}).ok());
  EXPECT_EQ(a->Copy(MomentOf("s", 2)), store::Copied::kLost);
  EXPECT_TRUE(Within(absl::Seconds(4), [&] { return a.Lost("s"); }));
  EXPECT_EQ(b->Locate("s").kind, Location::Kind::kNone);
}

// Otherwise its successor would resume an old state.
TEST_F(ClusterTest, AnIncompleteCopyIsCompletedBeforeARelease) {
  Member a(*redis_, "a:1"), b(*redis_, "b:1");
  b->StartTakeovers();
  ASSERT_TRUE(a->Claim("s").ok());
  ASSERT_EQ(a->Copy(StateAt("s", 1)), store::Copied::kYes);
  redis_->Kill();
  ASSERT_EQ(a->Copy(MomentOf("s", 2)), store::Copied::kLater);
  redis_->Start();
  ASSERT_TRUE(Within(absl::Seconds(4), [&] { return a.AskedFor("s"); }));
  std::thread store([&] {
    absl::SleepFor(absl::Milliseconds(500));
    a->CopyWhole(SavedAt("s", 1, 7));
  });
  a->Release("s");
  EXPECT_EQ(a->counts().owned, 0) << "the lease was not released";
  store.join();
  ASSERT_TRUE(Within(absl::Seconds(6), [&] { return !b.taken_over().empty(); }));
  EXPECT_EQ(b.taken_over()[0].saved.sequence, 7);
}

TEST_F(ClusterTest, AStoredSessionIsReclaimedUnlessOthersHadItSince) {
  Member a(*redis_, "a:1"), b(*redis_, "b:1");
  EXPECT_EQ(*a->Reclaim(SavedAt("alone", 0, 5)), 1) << "saved before the server joined a cluster";
  EXPECT_FALSE(b->Reclaim(SavedAt("alone", 0, 5)).ok()) << "another server has a session of that id";
  ASSERT_EQ(*b->Reclaim(SavedAt("newer", 3, 9)), 4);
  b->Abandon("newer");
  EXPECT_FALSE(a->Reclaim(SavedAt("newer", 2, 20)).ok());
  EXPECT_EQ(*a->Reclaim(SavedAt("newer", 4, 10)), 5);
  store::Written gone;
  gone.id = "newer";
  gone.forgotten = true;
  EXPECT_EQ(a->Copy(gone), store::Copied::kYes);
  EXPECT_FALSE(b->Reclaim(SavedAt("newer", 5, 10)).ok()) << "a deleted session was reclaimed";
}

TEST(RedisAddress, ReportsErrorsWithoutThePassword) {
  const auto good = ParseRedisAddress("redis://:secret@10.0.0.1:7000");
  ASSERT_TRUE(good.ok());
  EXPECT_EQ(good->host, "10.0.0.1");
  EXPECT_EQ(good->port, 7000);
  EXPECT_EQ(good->password, "secret");
  EXPECT_FALSE(good->encrypted);
  EXPECT_TRUE(ParseRedisAddress("rediss://10.0.0.1")->encrypted);
  for (const char* bad :
       {"10.0.0.1:7000", "redis://", "redis://host:0", "redis://secret@host:1", "redis://:secret@:1"}) {
    const auto address = ParseRedisAddress(bad);
    ASSERT_FALSE(address.ok()) << bad;
    EXPECT_EQ(address.status().message().find("secret@"), std::string::npos);
  }
}

}  // namespace
}  // namespace phrenic::cluster
