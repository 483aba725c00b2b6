#include "server/jobs/queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <thread>

#include "absl/synchronization/notification.h"
#include "phrenic/v1/study.pb.h"

namespace phrenic::jobs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

using StudyProgress = Progress<v1::Study>;
using Work = std::function<absl::Status(StudyProgress progress)>;

// A job whose work is a function.
class TestJob {
 public:
  using Message = v1::Study;

  explicit TestJob(Work work) : work_(std::move(work)) {}
  absl::Status Run(StudyProgress progress) { return work_(progress); }
  void Finish(const absl::Status& status, absl::Time /*expires*/, v1::Study& message) {
    if (status.ok()) message.mutable_result()->set_scene(message.scene());
  }
  void Save(const v1::Study& message, const Records& records) const {
    records.Put(message.id(), message.SerializeAsString());
  }

 private:
  const Work work_;
};

using TestQueue = Queue<TestJob>;

bool Tell(StudyProgress progress, double done) {
  return progress(done, [](v1::Study&) { return true; });
}

// Reports half of the work, and ends.
absl::Status Quick(StudyProgress progress) {
  Tell(progress, 0.5);
  return absl::OkStatus();
}

// Runs until it is cancelled.
absl::Status Endless(StudyProgress progress) {
  while (Tell(progress, 0.1)) absl::SleepFor(absl::Milliseconds(1));
  return absl::CancelledError("cancelled");
}

class QueueTest : public testing::Test {
 protected:
  std::unique_ptr<TestQueue> Make(int kept, store::Store* store = nullptr) const {
    return std::make_unique<TestQueue>(QueueOptions{.noun = {"study", "studies", "a"}, .kept = kept}, clock_,
                                       Records("study", store));
  }
  // An owner may have half of the jobs.
  std::unique_ptr<TestQueue> MakeShared(int kept, int threads) const {
    return std::make_unique<TestQueue>(
        QueueOptions{.noun = {"study", "studies", "a"}, .threads = threads, .kept = kept, .share = 0.5}, clock_,
        Records("study", nullptr));
  }

  static absl::StatusOr<v1::Study> Add(TestQueue& queue, const std::string& id, const Work& work) {
    return AddOf("", queue, id, work);
  }
  static absl::StatusOr<v1::Study> AddOf(const std::string& owner, TestQueue& queue, const std::string& id,
                                         const Work& work) {
    v1::Study message;
    message.set_scene("thorax");
    return queue.Add(owner, id, "error-thorax", message, std::make_shared<TestJob>(work));
  }

  static TestQueue::Seen WaitForEnd(const TestQueue& queue, const std::string& id) {
    TestQueue::Seen seen;
    while (!seen.ended) {
      auto next = queue.Wait(id, seen.version, absl::Seconds(10));
      EXPECT_TRUE(next.ok()) << next.status();
      if (!next.ok()) break;
      seen = *std::move(next);
    }
    return seen;
  }

  const SystemClock clock_{};
};

TEST_F(QueueTest, JobsRunAndKeepTheirResults) {
  const auto queue = Make(4);
  const auto added = Add(*queue, "", &Quick);
  ASSERT_TRUE(added.ok()) << added.status();
  EXPECT_EQ(added->id(), "error-thorax");
  const TestQueue::Seen seen = WaitForEnd(*queue, added->id());
  EXPECT_EQ(seen.message.state(), v1::STUDY_STATE_DONE);
  EXPECT_EQ(seen.message.progress(), 1);
  EXPECT_EQ(seen.message.result().scene(), "thorax");
  EXPECT_THAT(queue->List(), SizeIs(1));
}

// Sessions step and calls are answered before jobs get what is left of the processor.
TEST_F(QueueTest, JobsAndTheirThreadsHaveALowerPriority) {
  const auto niceness = [] { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); };
  std::atomic<int> job = 0, thread_of_job = 0;
  const auto queue = Make(4);
  const auto look = [&](StudyProgress) {
    job = niceness();
    std::thread([&] { thread_of_job = niceness(); }).join();
    return absl::OkStatus();
  };
  ASSERT_TRUE(Add(*queue, "a", look).ok());
  WaitForEnd(*queue, "a");
  EXPECT_GT(job, niceness());
  EXPECT_EQ(thread_of_job, job);
}

TEST_F(QueueTest, AFailedJobSaysWhy) {
  const auto queue = Make(4);
  ASSERT_TRUE(Add(*queue, "a", [](StudyProgress) { return absl::OutOfRangeError("the breath diverged"); }).ok());
  const TestQueue::Seen seen = WaitForEnd(*queue, "a");
  EXPECT_EQ(seen.message.state(), v1::STUDY_STATE_FAILED);
  EXPECT_EQ(seen.message.problem(), "the breath diverged");
}

TEST_F(QueueTest, OneThreadRunsJobsOneAfterTheOther) {
  const auto queue = Make(4);
  std::atomic<int> running = 0, most = 0;
  const auto counts = [&](StudyProgress) {
    most = std::max(most.load(), ++running);
    absl::SleepFor(absl::Milliseconds(5));
    --running;
    return absl::OkStatus();
  };
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(Add(*queue, "", counts).ok());
  WaitForEnd(*queue, "error-thorax-4");
  EXPECT_EQ(most, 1);
}

TEST_F(QueueTest, ADeletedJobEndsAndTheNextOneRuns) {
  const auto queue = Make(4);
  ASSERT_TRUE(Add(*queue, "long", &Endless).ok());
  ASSERT_TRUE(queue->Delete("long").ok());
  EXPECT_EQ(queue->Wait("long", 0, absl::ZeroDuration()).status().code(), absl::StatusCode::kNotFound);
  ASSERT_TRUE(Add(*queue, "next", &Quick).ok());
  EXPECT_EQ(WaitForEnd(*queue, "next").message.state(), v1::STUDY_STATE_DONE);
}

TEST_F(QueueTest, AWatcherSeesEachChangeUntilTheEnd) {
  const auto queue = Make(4);
  ASSERT_TRUE(Add(*queue, "a", &Quick).ok());
  std::vector<double> progress;
  const absl::Status watched = queue->Watch(
      "a", [] { return false; },
      [&](const v1::Study& study) {
        progress.push_back(study.progress());
        return true;
      });
  EXPECT_TRUE(watched.ok()) << watched;
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
  EXPECT_EQ(progress.back(), 1);
}

TEST_F(QueueTest, AWatcherThatIsGoneDoesNotWait) {
  const auto queue = Make(4);
  ASSERT_TRUE(Add(*queue, "a", &Endless).ok());
  const auto writes = [](const v1::Study&) { return true; };
  EXPECT_TRUE(absl::IsUnavailable(queue->Watch(
      "a", [] { return true; }, writes)));
  EXPECT_TRUE(absl::IsUnavailable(queue->Watch(
      "a", [] { return false; }, [](const v1::Study&) { return false; })));
  EXPECT_TRUE(absl::IsNotFound(queue->Watch(
      "b", [] { return false; }, writes)));
}

TEST_F(QueueTest, IsBounded) {
  const auto queue = Make(2);
  ASSERT_TRUE(Add(*queue, "a", &Endless).ok());
  ASSERT_TRUE(Add(*queue, "b", &Endless).ok());
  const auto refused = Add(*queue, "c", &Endless);
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("delete one"));
}

TEST_F(QueueTest, TheOldestEndedJobMakesRoom) {
  const auto queue = Make(1);
  ASSERT_TRUE(Add(*queue, "a", &Quick).ok());
  WaitForEnd(*queue, "a");
  ASSERT_TRUE(Add(*queue, "b", &Quick).ok());
  EXPECT_EQ(queue->Wait("a", 0, absl::ZeroDuration()).status().code(), absl::StatusCode::kNotFound);
}

TEST_F(QueueTest, RefusesBadAndTakenIds) {
  const auto queue = Make(4);
  EXPECT_EQ(Add(*queue, "No Good", &Quick).status().code(), absl::StatusCode::kInvalidArgument);
  ASSERT_TRUE(Add(*queue, "a", &Quick).ok());
  EXPECT_EQ(Add(*queue, "a", &Quick).status().code(), absl::StatusCode::kAlreadyExists);
  EXPECT_THAT(std::string(queue->Delete("b").message()), HasSubstr("there are a"));
}

TEST_F(QueueTest, ItsDestructorEndsRunningAndWaitingJobs) {
  const auto queue = Make(4);
  ASSERT_TRUE(Add(*queue, "a", &Endless).ok());
  ASSERT_TRUE(Add(*queue, "b", &Endless).ok());
}

TEST_F(QueueTest, UnfinishedJobsStayInTheStoreAndDeletedOnesDoNot) {
  const std::string folder = testing::TempDir() + "phrenic_jobs_" + std::to_string(getpid());
  {
    const auto store = *store::Store::Open(folder);
    const auto queue = Make(4, store.get());
    ASSERT_TRUE(Add(*queue, "done", &Quick).ok());
    WaitForEnd(*queue, "done");
    for (const char* id : {"running", "deleted", "waiting"}) ASSERT_TRUE(Add(*queue, id, &Endless).ok());
    ASSERT_TRUE(queue->Delete("deleted").ok());
  }
  const auto store = *store::Store::Open(folder);
  std::vector<std::pair<std::string, v1::StudyState>> found;
  std::map<std::string, absl::Status> lost;
  const auto restore = [&](const store::SavedRecord& record) -> absl::Status {
    v1::Study saved;
    if (!saved.ParseFromString(record.bytes)) return absl::DataLossError("damaged");
    found.emplace_back(record.id, saved.state());
    return record.id == "waiting" ? absl::NotFoundError("its scene is gone") : absl::OkStatus();
  };
  Records("study", store.get()).Restore(*store->LoadRecords(), restore, lost);
  EXPECT_THAT(found, ElementsAre(Pair("done", v1::STUDY_STATE_DONE), Pair("running", v1::STUDY_STATE_QUEUED),
                                 Pair("waiting", v1::STUDY_STATE_QUEUED)));
  EXPECT_THAT(lost, ElementsAre(Pair("study waiting", absl::NotFoundError("its scene is gone"))));
  lost.clear();
  Records("export", store.get()).Restore(*store->LoadRecords(), restore, lost);
  EXPECT_THAT(lost, IsEmpty()) << "records of another kind";
  std::filesystem::remove_all(folder);
}

TEST_F(QueueTest, OneOwnerLeavesRoomForOthers) {
  const auto queue = MakeShared(4, 1);
  ASSERT_TRUE(AddOf("greedy", *queue, "a", &Endless).ok());
  ASSERT_TRUE(AddOf("greedy", *queue, "b", &Endless).ok());
  const auto third = AddOf("greedy", *queue, "c", &Endless);
  EXPECT_TRUE(absl::IsResourceExhausted(third.status())) << third.status();
  EXPECT_THAT(std::string(third.status().message()), HasSubstr("--max-share"));
  EXPECT_TRUE(AddOf("modest", *queue, "d", &Endless).ok());
}

TEST_F(QueueTest, AnOwnersEndedJobMakesRoomForHisOwn) {
  const auto queue = MakeShared(4, 1);
  for (const char* id : {"a", "b"}) {
    ASSERT_TRUE(AddOf("greedy", *queue, id, &Quick).ok());
    WaitForEnd(*queue, id);
  }
  ASSERT_TRUE(AddOf("modest", *queue, "mine", &Quick).ok());
  WaitForEnd(*queue, "mine");
  ASSERT_TRUE(AddOf("greedy", *queue, "c", &Quick).ok());
  WaitForEnd(*queue, "c");
  EXPECT_TRUE(queue->Wait("mine", 0, absl::ZeroDuration()).ok());
  EXPECT_TRUE(absl::IsNotFound(queue->Wait("a", 0, absl::ZeroDuration()).status()));
}

TEST_F(QueueTest, AFullQueueTakesTheEndedJobOfWhoHasMost) {
  const auto queue = MakeShared(4, 1);
  for (const auto& [owner, id] : {std::pair("one", "a"), {"two", "b"}, {"two", "c"}, {"one", "d"}}) {
    ASSERT_TRUE(AddOf(owner, *queue, id, &Quick).ok());
    WaitForEnd(*queue, id);
  }
  ASSERT_TRUE(AddOf("modest", *queue, "mine", &Quick).ok());
  WaitForEnd(*queue, "mine");
  ASSERT_TRUE(AddOf("two", *queue, "e", &Quick).ok()) << "his own job makes room";
  WaitForEnd(*queue, "e");
  EXPECT_TRUE(queue->Wait("mine", 0, absl::ZeroDuration()).ok());
  EXPECT_TRUE(queue->Wait("d", 0, absl::ZeroDuration()).ok());
}

// The greedy owner's jobs were all added before the modest one's.
TEST_F(QueueTest, SeveralOwnersRunInTurn) {
  const auto queue = MakeShared(8, 1);
  absl::Notification begin;
  absl::Mutex mutex;
  std::vector<std::string> ran;
  const auto named = [&](const char* name) {
    return [&, name](StudyProgress) {
      begin.WaitForNotification();
      absl::MutexLock lock(&mutex);
      ran.emplace_back(name);
      return absl::OkStatus();
    };
  };
  for (const char* id : {"a", "b", "c"}) ASSERT_TRUE(AddOf("greedy", *queue, id, named("greedy")).ok());
  ASSERT_TRUE(AddOf("modest", *queue, "d", named("modest")).ok());
  begin.Notify();
  for (const char* id : {"a", "b", "c", "d"}) WaitForEnd(*queue, id);
  absl::MutexLock lock(&mutex);
  EXPECT_THAT(ran, ElementsAre("greedy", "modest", "greedy", "greedy"));
}

TEST_F(QueueTest, OneOwnerLeavesAThreadForOthers) {
  const auto queue = MakeShared(8, 2);
  for (const char* id : {"a", "b"}) ASSERT_TRUE(AddOf("greedy", *queue, id, &Endless).ok());
  ASSERT_TRUE(AddOf("modest", *queue, "c", &Quick).ok());
  EXPECT_EQ(WaitForEnd(*queue, "c").message.state(), v1::STUDY_STATE_DONE);
}

}  // namespace
}  // namespace phrenic::jobs
