// A job knows its owner as long as it exists, whatever others add and delete.
#include <gmock/gmock.h>

#include "absl/strings/str_cat.h"
#include "phrenic/v1/study.pb.h"
#include "server/jobs/queue.h"

namespace phrenic::jobs {
namespace {

class Nothing {
 public:
  using Message = v1::Study;
  absl::Status Run(Progress<v1::Study>) { return absl::OkStatus(); }
  void Finish(const absl::Status&, absl::Time, v1::Study&) {}
  void Save(const v1::Study&, const Records&) {}
};

TEST(Owner, LivesWithTheJob) {
  const SystemClock clock{};
  Queue<Nothing> queue({.noun = {"study", "studies", "a"}, .kept = 16}, clock, Records("study", nullptr));
  ASSERT_TRUE(queue.Add("modest", "mine", "", {}, std::make_shared<Nothing>()).ok());
  for (int i = 0; i < 5000; ++i) {
    const std::string id = absl::StrCat("g", i);
    ASSERT_TRUE(queue.Add("greedy", id, "", {}, std::make_shared<Nothing>()).ok());
    ASSERT_TRUE(queue.Delete(id).ok());
  }
  ASSERT_TRUE(queue.Add("greedy", "last", "", {}, std::make_shared<Nothing>()).ok());
  EXPECT_EQ(queue.OwnerOf("mine"), "modest");
  EXPECT_EQ(queue.OwnerOf("last"), "greedy");
  EXPECT_EQ(queue.OwnerOf("g7"), std::nullopt);
  const auto listed = queue.List([](const std::string& owner) { return owner == "modest"; });
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed[0].id(), "mine");
}

TEST(Owner, AnUnknownIdIsNotAnsweredWithTheIdsOfOwners) {
  const SystemClock clock{};
  Queue<Nothing> queue({.noun = {"study", "studies", "a"}, .kept = 16}, clock, Records("study", nullptr));
  ASSERT_TRUE(queue.Add("anna", "jane-doe", "", {}, std::make_shared<Nothing>()).ok());
  ASSERT_TRUE(queue.Add("", "open", "", {}, std::make_shared<Nothing>()).ok());
  const std::string message(queue.Delete("jane-do").message());
  EXPECT_EQ(message.find("jane-doe"), std::string::npos) << message;
  EXPECT_NE(message.find("open"), std::string::npos) << message;
}

}  // namespace
}  // namespace phrenic::jobs
