#include "server/session/control.h"

#include <gmock/gmock.h>

#include <random>
#include <set>

#include "server/crypto/secret.h"

namespace phrenic::session {
namespace {

using testing::HasSubstr;

const absl::Duration kStay = absl::Seconds(30);

class ControlTest : public testing::Test {
 protected:
  static ControlBook Make(v1::ControlPolicy policy) {
    auto book = ControlBook::Make(policy, "Anna");
    EXPECT_TRUE(book.ok()) << book.status();
    return *std::move(book);
  }
  std::string Enter(ControlBook& book, const std::string& name) {
    const auto token = book.Enter(name, "", kStay, now_);
    EXPECT_TRUE(token.ok()) << token.status();
    return token.ok() ? *token : "";
  }
  bool MayChange(ControlBook& book, const std::string& token) { return book.Check(token, now_).ok(); }
  std::string Controller(const ControlBook& book) { return book.Describe(now_).controller(); }

  ControlBook everybodys_ = Make(v1::CONTROL_POLICY_EVERYBODY);
  ControlBook owners_ = Make(v1::CONTROL_POLICY_OWNER);
  const std::string anna_ = owners_.state().owner.token;
  absl::Time now_ = absl::FromUnixSeconds(1'700'000'000);
};

TEST_F(ControlTest, EverybodyMayChangeASessionUnlessTheOwnerControlsIt) {
  EXPECT_TRUE(MayChange(everybodys_, ""));
  EXPECT_TRUE(MayChange(everybodys_, "made up"));
  EXPECT_EQ(Controller(everybodys_), "");
  EXPECT_FALSE(MayChange(owners_, ""));
  EXPECT_FALSE(MayChange(owners_, "made up"));
  EXPECT_TRUE(MayChange(owners_, anna_));
  EXPECT_EQ(Controller(owners_), "Anna");
}

TEST_F(ControlTest, ARefusalSaysWhoControlsUntilWhenAndWhatToDo) {
  const std::string ben = Enter(owners_, "Ben");
  ASSERT_TRUE(owners_.Hand(anna_, "Ben", now_).ok());
  const absl::Status refused = owners_.Check(anna_, now_);
  EXPECT_TRUE(absl::IsPermissionDenied(refused));
  EXPECT_THAT(std::string(refused.message()), HasSubstr("controlled by Ben, until 22:13:50 UTC"));
  EXPECT_THAT(std::string(refused.message()), HasSubstr("phrenic control take"));
  EXPECT_THAT(std::string(refused.message()), testing::Not(HasSubstr(ben)));
}

TEST_F(ControlTest, HandedControlReturnsWhenItsTimeIsOver) {
  const std::string ben = Enter(owners_, "Ben");
  ASSERT_TRUE(owners_.Hand(anna_, "Ben", now_).ok());
  EXPECT_TRUE(MayChange(owners_, ben));
  EXPECT_FALSE(MayChange(owners_, anna_));
  EXPECT_EQ(owners_.next_expiry(), now_ + kStay);
  now_ += kStay - absl::Nanoseconds(1);
  EXPECT_FALSE(owners_.Expire(now_));
  now_ += absl::Nanoseconds(1);
  EXPECT_TRUE(owners_.Expire(now_));
  EXPECT_EQ(Controller(owners_), "Anna");
  EXPECT_TRUE(MayChange(owners_, anna_));
  EXPECT_FALSE(MayChange(owners_, ben));
}

TEST_F(ControlTest, AHolderWhoStaysActiveKeepsControl) {
  const std::string ben = Enter(everybodys_, "Ben"), cleo = Enter(everybodys_, "Cleo");
  ASSERT_TRUE(*everybodys_.Take(ben, now_));
  for (int i = 0; i < 10; ++i) {
    now_ += 0.7 * kStay;
    EXPECT_TRUE(MayChange(everybodys_, ben)) << "a change counts as staying";
    EXPECT_TRUE(everybodys_.Enter("Cleo", cleo, kStay, now_).ok());
    EXPECT_FALSE(MayChange(everybodys_, cleo));
  }
  now_ += kStay;
  EXPECT_TRUE(MayChange(everybodys_, "")) << "what was everybody's is everybody's again";
}

TEST_F(ControlTest, TheFirstToTakeControlHasItAndTheSecondAsks) {
  const std::string ben = Enter(everybodys_, "Ben"), cleo = Enter(everybodys_, "Cleo");
  EXPECT_TRUE(*everybodys_.Take(ben, now_));
  EXPECT_FALSE(*everybodys_.Take(cleo, now_));
  EXPECT_TRUE(everybodys_.Describe(now_).participants(1).asks());
  EXPECT_FALSE(MayChange(everybodys_, cleo));
  ASSERT_TRUE(everybodys_.Hand(ben, "Cleo", now_).ok());
  EXPECT_TRUE(MayChange(everybodys_, cleo));
  EXPECT_FALSE(MayChange(everybodys_, ben));
  EXPECT_FALSE(everybodys_.Describe(now_).participants(1).asks());
}

TEST_F(ControlTest, TheOwnerTakesControlFromAnyoneAndGivesItToAll) {
  const std::string ben = Enter(owners_, "Ben");
  ASSERT_TRUE(owners_.HandToEverybody(anna_, now_).ok());
  EXPECT_TRUE(MayChange(owners_, ""));
  ASSERT_TRUE(*owners_.Take(ben, now_));
  EXPECT_FALSE(MayChange(owners_, ""));
  EXPECT_TRUE(*owners_.Take(anna_, now_));
  EXPECT_EQ(Controller(owners_), "Anna");
  EXPECT_FALSE(MayChange(owners_, ben));
}

TEST_F(ControlTest, OnlyTheOneWhoControlsCanHandControl) {
  const std::string ben = Enter(owners_, "Ben");
  EXPECT_TRUE(absl::IsPermissionDenied(owners_.Hand(ben, "Ben", now_)));
  EXPECT_TRUE(absl::IsPermissionDenied(owners_.HandToEverybody(ben, now_)));
  EXPECT_TRUE(absl::IsPermissionDenied(owners_.Hand("", "Ben", now_)));
  EXPECT_TRUE(absl::IsFailedPrecondition(owners_.Hand(anna_, "Cleo", now_))) << "who is not there gets nothing";
  ASSERT_TRUE(owners_.Hand(anna_, "Ben", now_).ok());
  EXPECT_TRUE(absl::IsPermissionDenied(owners_.HandToEverybody(ben, now_))) << "that is the owner's to do";
  EXPECT_TRUE(owners_.Release(ben, now_).ok());
  EXPECT_EQ(Controller(owners_), "Anna");
  EXPECT_TRUE(absl::IsFailedPrecondition(owners_.Release(anna_, now_)));
}

TEST_F(ControlTest, OnlyTheOneWhoControlsAloneShowsACamera) {
  EXPECT_TRUE(owners_.CheckAlone(anna_, now_).ok());
  EXPECT_TRUE(absl::IsPermissionDenied(owners_.CheckAlone("", now_)));
  EXPECT_TRUE(absl::IsPermissionDenied(everybodys_.CheckAlone("", now_)));
}

TEST_F(ControlTest, EachNameBelongsToOnePerson) {
  const std::string ben = Enter(owners_, "Ben");
  EXPECT_TRUE(absl::IsAlreadyExists(owners_.Enter("Ben", "", kStay, now_).status()));
  EXPECT_TRUE(absl::IsAlreadyExists(owners_.Enter("Anna", "", kStay, now_).status())) << "the owner's, away or not";
  EXPECT_EQ(*owners_.Enter("Benedikt", ben, kStay, now_), ben);
  EXPECT_TRUE(owners_.Enter("Ben", "", kStay, now_).ok());
  for (const std::string& name : {std::string(), std::string(" Ben"), std::string("a\nb"), std::string(41, 'x')}) {
    EXPECT_TRUE(absl::IsInvalidArgument(owners_.Enter(name, "", kStay, now_).status())) << name;
  }
  EXPECT_TRUE(owners_.Enter("Zoë Ångström-Σωκράτης", "", kStay, now_).ok());
}

TEST_F(ControlTest, TheNumberOfPeopleIsBounded) {
  for (std::size_t i = 0; i < kMostPeople; ++i) Enter(owners_, std::to_string(i));
  EXPECT_TRUE(absl::IsResourceExhausted(owners_.Enter("one more", "", kStay, now_).status()));
  now_ += kStay;
  EXPECT_TRUE(owners_.Enter("one more", "", kStay, now_).ok());
}

// After any sequence of calls by any persons, either one person may change the session or everybody may, and Describe
// says which.
TEST_F(ControlTest, AtAnyTimeOnePersonControlsOrEverybodyDoes) {
  std::mt19937 random(1);
  const auto pick = [&random](int n) { return std::uniform_int_distribution(0, n - 1)(random); };
  for (int run = 0; run < 50; ++run) {
    ControlBook book = Make(run % 2 == 0 ? v1::CONTROL_POLICY_OWNER : v1::CONTROL_POLICY_EVERYBODY);
    std::vector<std::string> tokens = {book.state().owner.token};
    const std::vector<std::string> names = {"Anna", "Ben", "Cleo", "Dora"};
    std::int64_t revision = 0;
    for (int i = 1; i < 4; ++i) tokens.push_back(Enter(book, names[i]));
    for (int act = 0; act < 200; ++act) {
      const int who = pick(4);
      switch (pick(6)) {
        case 0:
          (void)book.Take(tokens[who], now_);
          break;
        case 1:
          (void)book.Hand(tokens[who], names[pick(4)], now_);
          break;
        case 2:
          (void)book.HandToEverybody(tokens[who], now_);
          break;
        case 3:
          (void)book.Release(tokens[who], now_);
          break;
        case 4:
          tokens[who] = book.Enter(names[who], tokens[who], kStay, now_).value_or(tokens[who]);
          break;
        default:
          now_ += absl::Seconds(pick(12));
          break;
      }
      book.Expire(now_);
      ControlBook copy = book;  // Check may change the copy
      const std::string controller = Controller(copy);
      for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(copy.Check(tokens[i], now_).ok(), controller.empty() || controller == names[i]) << names[i];
      }
      EXPECT_EQ(copy.Check("", now_).ok(), controller.empty());
      EXPECT_GE(book.state().revision, revision);
      revision = book.state().revision;
    }
  }
}

}  // namespace
}  // namespace phrenic::session
