#include "server/lti/outbox.h"

#include <gmock/gmock.h>

#include <atomic>

#include "absl/time/clock.h"
#include "server/lti/form.h"
#include "server/lti/learner.h"
#include "server/lti/tickets.h"

namespace phrenic::lti {
namespace {

// Waits five seconds at most.
template <class Condition>
bool Becomes(Condition condition) {
  for (int i = 0; i < 500 && !condition(); ++i) absl::SleepFor(absl::Milliseconds(10));
  return condition();
}

TEST(Outbox, RepeatsUntilAParcelArrives) {
  std::atomic<int> attempts = 0;
  Outbox outbox([&](const Parcel&) { return ++attempts < 2 ? absl::UnavailableError("away") : absl::OkStatus(); },
                {"test", nullptr});
  outbox.Add({.id = "a"}, absl::Now());
  EXPECT_TRUE(Becomes([&] { return attempts >= 1; }));
  EXPECT_EQ(outbox.size(), 1U);
  EXPECT_TRUE(Becomes([&] { return outbox.size() == 0; }));
  EXPECT_EQ(attempts, 2);
}

TEST(Outbox, DoesNotRepeatWhatIsRefusedForGood) {
  std::atomic<int> attempts = 0;
  Outbox outbox(
      [&](const Parcel&) {
        ++attempts;
        return absl::InvalidArgumentError("no such item");
      },
      {"test", nullptr});
  outbox.Add({.id = "a"}, absl::Now());
  EXPECT_TRUE(Becomes([&] { return outbox.size() == 0; }));
  EXPECT_EQ(attempts, 1);
}

TEST(Outbox, DeliversTheNewestOfAnId) {
  std::atomic<bool> away = true;
  std::atomic<int> last = 0, arrived = 0;
  Outbox outbox(
      [&](const Parcel& parcel) {
        if (away) return absl::UnavailableError("away");
        last = parcel.content.get<int>();
        ++arrived;
        return absl::OkStatus();
      },
      {"test", nullptr});
  for (int score = 1; score <= 3; ++score) {
    outbox.Add({.id = "a", .content = score}, absl::Now());
    absl::SleepFor(absl::Milliseconds(20));
  }
  away = false;
  outbox.Add({.id = "b", .content = 9}, absl::Now());
  outbox.Add({.id = "a", .content = 4}, absl::Now());
  EXPECT_TRUE(Becomes([&] { return outbox.size() == 0; }));
  EXPECT_EQ(arrived, 2);
}

TEST(Outbox, RefusesADamagedRecord) {
  Outbox outbox([](const Parcel&) { return absl::OkStatus(); }, {"test", nullptr});
  for (const char* text : {"", "{}", "[]", R"({"id":"a"})", R"({"id":1,"content":{},"first":0})",
                           R"({"id":"a","content":{},"first":"x"})"}) {
    EXPECT_TRUE(absl::IsInvalidArgument(outbox.Restore(text))) << text;
  }
}

TEST(Learner, IsReadAsItWasWritten) {
  Learner learner{"https://a.example 1", "course", "user", "session", "secret", {}, absl::FromUnixSeconds(5)};
  learner.assignments["copd"] = {"https://a.example/1", {{2, true}, {3, false}}};
  learner.assignments["cough"] = {};
  const std::string text = WriteLearner(learner);
  EXPECT_EQ(WriteLearner(*ReadLearner(text)), text);
  for (std::size_t length = 0; length < text.size(); ++length) EXPECT_FALSE(ReadLearner(text.substr(0, length)).ok());
}

TEST(Tickets, AreGoodOnceAndForATime) {
  Tickets<int> tickets(absl::Minutes(1));
  const absl::Time now = absl::UnixEpoch();
  const std::string first = tickets.Issue(1, now), second = tickets.Issue(2, now);
  EXPECT_EQ(tickets.Use(first, now), 1);
  EXPECT_EQ(tickets.Use(first, now), std::nullopt);
  EXPECT_EQ(tickets.Use(second, now + absl::Minutes(1)), std::nullopt);
  EXPECT_EQ(tickets.Use("", now), std::nullopt);
}

TEST(Tickets, OfTheNewestTenThousandAreKept) {
  Tickets<int> tickets(absl::Minutes(1));
  const std::string first = tickets.Issue(1, absl::UnixEpoch());
  for (int i = 0; i < 9'999; ++i) tickets.Issue(i, absl::UnixEpoch());
  const std::string last = tickets.Issue(3, absl::UnixEpoch());
  EXPECT_EQ(tickets.Use(first, absl::UnixEpoch()), std::nullopt);
  EXPECT_EQ(tickets.Use(last, absl::UnixEpoch()), 3);
}

TEST(Form, IsReadAsItWasWritten) {
  const std::string odd = "a b&c=d%+\xC3\xA9\n\"";
  EXPECT_EQ(FieldOf(ReadForm(WriteForm({{"x", "1"}, {odd, odd}})), odd), odd);
  EXPECT_EQ(FieldOf(ReadForm("a=1&a=2&b"), "a"), "2");
  EXPECT_EQ(FieldOf(ReadForm("a=%4"), "a"), "%4");
  EXPECT_EQ(CookieOf("x=1; y=2;z", "y"), "2");
  EXPECT_EQ(CookieOf("xy=1", "y"), "");
  EXPECT_EQ(HtmlText("<a href=\"'&"), "&lt;a href=&quot;&#39;&amp;");
}

}  // namespace
}  // namespace phrenic::lti
