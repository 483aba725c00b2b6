#include "server/lti/tool.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/time/clock.h"
#include "server/lti/form.h"
#include "tests/access/provider.h"
#include "tests/lti/example.h"

namespace phrenic::lti {
namespace {

using access::HttpAnswer;
using access::HttpRequest;
using access::Provider;
using nlohmann::json;
using testing::HasSubstr;

// Admits everybody, and remembers the last one.
class OpenClassroom final : public Classroom {
 public:
  absl::StatusOr<std::string> Admit(const Visit& visit) override {
    last = visit;
    return std::string(visit.teaches ? "account=11112222333344445555666677778888" : "join=x");
  }
  Visit last;
};

// A platform and a store of records that answer without a network. Thread-safe.
class School {
 public:
  absl::StatusOr<HttpAnswer> Answer(const HttpRequest& request) {
    absl::MutexLock lock(&mutex_);
    received_.push_back(request);
    if (failing_ > 0 && request.post) {
      --failing_;
      return HttpAnswer{503, "", ""};
    }
    if (request.address == "https://school.example/keys") {
      return HttpAnswer{200, json{{"keys", {key_->PublicKey()}}}.dump(), ""};
    }
    if (request.address == "https://school.example/token") {
      return HttpAnswer{200, R"({"access_token":"t1","expires_in":3600})", ""};
    }
    if (request.address == "https://school.example/members") {
      return HttpAnswer{200, R"({"members":[{"user_id":"user-7","name":"Anna Example"}]})",
                        R"(<https://school.example/members2>; rel="next")"};
    }
    if (request.address == "https://school.example/members2") {
      return HttpAnswer{200, R"({"members":[{"user_id":"user-8","given_name":"Bo","family_name":"Roe"}]})", ""};
    }
    return HttpAnswer{200, "", ""};
  }
  void NewKey() {
    absl::MutexLock lock(&mutex_);
    key_ = std::make_unique<Provider>();
  }
  void FailNextPosts(int count) {
    absl::MutexLock lock(&mutex_);
    failing_ = count;
  }
  std::string Sign(const json& claims) {
    absl::MutexLock lock(&mutex_);
    return key_->Sign(claims);
  }
  std::string PublicKeyText() {
    absl::MutexLock lock(&mutex_);
    return key_->PublicKey().dump();
  }
  // Returns the requests to an address, once there are `count` or five seconds have passed.
  std::vector<HttpRequest> To(const std::string& address, std::size_t count) {
    std::vector<HttpRequest> found;
    const auto enough = [&] {
      mutex_.AssertReaderHeld();
      found.clear();
      for (const HttpRequest& each : received_) {
        if (each.address == address) found.push_back(each);
      }
      return found.size() >= count;
    };
    absl::MutexLock lock(&mutex_);
    mutex_.AwaitWithTimeout(absl::Condition(&enough), absl::Seconds(5));
    return found;
  }

 private:
  absl::Mutex mutex_;
  std::unique_ptr<Provider> key_ = std::make_unique<Provider>();
  std::vector<HttpRequest> received_;
  int failing_ = 0;
};

class ToolTest : public testing::Test {
 protected:
  ToolTest() {
    std::filesystem::create_directories(folder_);
    const std::string key = folder_ + "/key.json";
    std::filesystem::remove(key);
    Options options{.url = kExampleUrl, .platforms = {kExamplePlatform}, .key_file = key};
    Settings settings = *ReadSettings(options);
    settings.lrs = {"https://lrs.example/xapi", "user", "secret"};
    tool_ =
        std::make_unique<Tool>(Tool::Parts{.settings = std::move(settings),
                                           .key = *ToolKey::Open(key),
                                           .lessons_folder = absl::StrCat(PHRENIC_SOURCE_DIR, "/web/public/lessons"),
                                           .classroom = &classroom_,
                                           .exchange = [this](const HttpRequest& request) {
                                             if (request.address == "https://school.example/members") on_members_();
                                             return school_.Answer(request);
                                           }});
  }
  ~ToolTest() override {
    tool_.reset();
    std::filesystem::remove_all(folder_);
  }

  static std::string Header(const Response& response, const std::string& name) {
    for (const auto& [each, value] : response.headers) {
      if (each == name) return value;
    }
    return "";
  }
  Response Login(const std::string& issuer = "https://school.example",
                 const std::string& target = "https://tool.example/lti/launch") {
    return tool_->Handle({.post = true,
                          .target = "/lti/login",
                          .body = WriteForm({{"iss", issuer}, {"login_hint", "7"}, {"target_link_uri", target}})},
                         kExampleNow);
  }
  // The state, the nonce and the cookie of a login.
  struct Begun {
    std::string state, nonce, cookie;
  };
  Begun Begin() {
    const Response response = Login();
    const std::string location = Header(response, "Location");
    const Fields asked = ReadForm(location.substr(location.find('?') + 1));
    const std::string cookie = Header(response, "Set-Cookie");
    return {FieldOf(asked, "state"), FieldOf(asked, "nonce"), cookie.substr(0, cookie.find(';'))};
  }
  Response Post(const Begun& begun, const std::string& token) {
    return tool_->Handle({.post = true,
                          .target = "/lti/launch",
                          .body = WriteForm({{"state", begun.state}, {"id_token", token}}),
                          .cookies = "a=b; " + begun.cookie},
                         kExampleNow);
  }
  Response Launch(json claims) {
    const Begun begun = Begin();
    claims["nonce"] = begun.nonce;
    return Post(begun, school_.Sign(claims));
  }
  // Returns the fields of the fragment to which a launch leads.
  static Fields FragmentOf(const Response& response) {
    const std::string location = Header(response, "Location");
    return ReadForm(location.substr(location.find('#') + 1));
  }
  void Answer(const Response& launched, int step, const std::vector<int>& choices, std::optional<double> number) {
    v1::SubmitAnswerRequest answer;
    answer.set_session_id(classroom_.last.session);
    answer.set_respondent(FieldOf(FragmentOf(launched), "respondent"));
    answer.set_lesson("paralysis");
    answer.set_step(step);
    answer.set_right(true);  // what the page says does not count
    for (const int choice : choices) answer.add_choices(choice);
    if (number.has_value()) answer.set_number(*number);
    tool_->Answered(answer, kExampleNow);
  }
  // Answers all questions of the lesson, rightly or wrongly.
  int AnswerAll(const Response& launched, bool rightly) {
    const v1::Lesson lesson = *Lessons(absl::StrCat(PHRENIC_SOURCE_DIR, "/web/public/lessons")).Find("paralysis");
    for (int i = 0; i < lesson.steps_size(); ++i) {
      if (!lesson.steps(i).has_question()) continue;
      const v1::Question& question = lesson.steps(i).question();
      if (question.has_number()) {
        Answer(launched, i + 1, {}, question.number().value() + (rightly ? 0 : 10 * question.number().tolerance() + 1));
        continue;
      }
      std::vector<int> choices;
      for (int k = 0; k < question.answers_size(); ++k) {
        if (question.answers(k).right() == rightly) choices.push_back(k);
      }
      Answer(launched, i + 1, choices, std::nullopt);
    }
    return QuestionCount(lesson);
  }

  const std::string folder_ = absl::StrCat(testing::TempDir(), "/phrenic-lti-", getpid());
  School school_;
  std::function<void()> on_members_ = [] {};
  OpenClassroom classroom_;
  std::unique_ptr<Tool> tool_;
};

TEST_F(ToolTest, LeadsALearnerToTheLessonAndATeacherToTheSameClass) {
  const Response learner = Launch(ExampleClaims());
  ASSERT_EQ(learner.status, 303U) << learner.text;
  EXPECT_THAT(Header(learner, "Location"), testing::StartsWith("https://tool.example/?session=course-"));
  EXPECT_THAT(Header(learner, "Location"), HasSubstr("&view=student&lesson=paralysis#launch=1&join=x&respondent="));
  const std::string session = classroom_.last.session;
  EXPECT_FALSE(classroom_.last.teaches);
  json teacher = ExampleClaims();
  teacher["https://purl.imsglobal.org/spec/lti/claim/roles"] = {"Instructor"};
  EXPECT_THAT(Header(Launch(teacher), "Location"), HasSubstr("#launch=1&account="));
  EXPECT_TRUE(classroom_.last.teaches);
  EXPECT_EQ(classroom_.last.session, session);
}

TEST_F(ToolTest, KeepsALaunchInTheBrowserThatBeganIt) {
  Begun begun = Begin();
  json claims = ExampleClaims();
  claims["nonce"] = begun.nonce;
  const std::string token = school_.Sign(claims), cookie = begun.cookie;
  EXPECT_THAT(Header(Login(), "Set-Cookie"), HasSubstr("HttpOnly; Secure; SameSite=None"));
  begun.cookie = "";
  EXPECT_EQ(Post(begun, token).status, 401U);
  begun.cookie = cookie.substr(0, cookie.find('=')) + "=" + Begin().state;
  EXPECT_EQ(Post(begun, token).status, 401U);
  begun.cookie = cookie;
  EXPECT_EQ(Post(begun, token).status, 303U);
}

TEST_F(ToolTest, AcceptsATokenOnce) {
  const Begun begun = Begin();
  json claims = ExampleClaims();
  claims["nonce"] = begun.nonce;
  const std::string token = school_.Sign(claims);
  const Response first = Post(begun, token);
  EXPECT_EQ(first.status, 303U);
  EXPECT_THAT(Header(first, "Set-Cookie"), HasSubstr("=; Path=/lti; Max-Age=0;"));
  EXPECT_THAT(Post(begun, token).text, HasSubstr("was used already"));
  EXPECT_THAT(Post(Begin(), token).text, HasSubstr("(nonce)"));  // the same token with another state
}

TEST_F(ToolTest, RefusesWhatThePlatformDidNotSign) {
  json claims = ExampleClaims();
  Begun begun = Begin();
  claims["nonce"] = begun.nonce;
  Provider other;
  EXPECT_THAT(Post(begun, other.Sign(claims)).text, HasSubstr("cannot be trusted"));
  // No signature.
  begun = Begin();
  claims["nonce"] = begun.nonce;
  const auto part = [](const std::string& text) { return absl::WebSafeBase64Escape(text); };
  EXPECT_EQ(Post(begun, part(R"({"alg":"none"})") + "." + part(claims.dump()) + ".").status, 401U);
  // The public key as the secret of a symmetric signature.
  begun = Begin();
  claims["nonce"] = begun.nonce;
  cjose_err error;
  const std::string secret = school_.PublicKeyText();
  cjose_jwk_t* symmetric =
      cjose_jwk_create_oct_spec(reinterpret_cast<const std::uint8_t*>(secret.data()), secret.size(), &error);
  EXPECT_EQ(Post(begun, Provider::SignWith(symmetric, "HS256", claims)).status, 401U);
  cjose_jwk_release(symmetric);
  for (const char* token : {"", ".", "..", "a.b.c", "e30.e30.e30"}) EXPECT_EQ(Post(Begin(), token).status, 401U);
}

TEST_F(ToolTest, FetchesThePlatformsKeysAnewWhenItSignsWithAnother) {
  EXPECT_EQ(Launch(ExampleClaims()).status, 303U);
  EXPECT_EQ(Launch(ExampleClaims()).status, 303U);
  EXPECT_EQ(school_.To("https://school.example/keys", 1).size(), 1U);
  school_.NewKey();
  EXPECT_EQ(Launch(ExampleClaims()).status, 401U);  // fetched less than 10 s ago
  const Begun begun = Begin();
  json claims = ExampleClaims();
  claims["nonce"] = begun.nonce;
  const Response later = tool_->Handle({.post = true,
                                        .target = "/lti/launch",
                                        .body = WriteForm({{"state", begun.state}, {"id_token", school_.Sign(claims)}}),
                                        .cookies = begun.cookie},
                                       kExampleNow + absl::Seconds(11));
  EXPECT_EQ(later.status, 303U) << later.text;
}

TEST_F(ToolTest, KnowsItsPlatformsAndItself) {
  EXPECT_EQ(Login("https://evil.example").status, 403U);
  EXPECT_EQ(Login("https://school.example", "https://evil.example/lti/launch").status, 403U);
  EXPECT_THAT(Header(Login(), "Location"), testing::StartsWith("https://school.example/auth?response_type=id_token&"));
  EXPECT_THAT(Header(Login("https://evil.example"), "Content-Security-Policy"),
              HasSubstr("frame-ancestors https://school.example"));
}

TEST_F(ToolTest, SendsTheScoreWhenAllQuestionsAreAnsweredAndAgainWhenItChanges) {
  const Response launched = Launch(ExampleClaims());
  const int most = AnswerAll(launched, false);
  const std::string scores = "https://school.example/items/3/scores?type=1";
  ASSERT_EQ(school_.To(scores, 1).size(), 1U);
  school_.FailNextPosts(1);
  AnswerAll(launched, true);
  std::vector<HttpRequest> sent;
  for (int i = 0; i < 50; ++i) {  // scores in between may be replaced before they are sent
    sent = school_.To(scores, 2);
    if (json::parse(sent.back().body)["scoreGiven"] == most) break;
    absl::SleepFor(absl::Milliseconds(100));
  }
  const json first = json::parse(sent.front().body), last = json::parse(sent.back().body);
  EXPECT_EQ(first["scoreGiven"], 0);
  EXPECT_EQ(last["scoreGiven"], most);
  EXPECT_EQ(last["scoreMaximum"], most);
  EXPECT_EQ(last["userId"], "user-7");
  EXPECT_EQ(last["gradingProgress"], "FullyGraded");
  EXPECT_THAT(sent.back().headers, testing::Contains("Authorization: Bearer t1"));
  const auto asked = school_.To("https://school.example/token", 1);
  const Fields form = ReadForm(asked.back().body);
  EXPECT_EQ(FieldOf(form, "grant_type"), "client_credentials");
  const json published = json::parse(tool_->Handle({.target = "/lti/jwks"}, kExampleNow).text);
  EXPECT_FALSE(published["keys"][0].contains("d"));
  EXPECT_TRUE(access::KeySet::Parse(published.dump())->Verified(FieldOf(form, "client_assertion")).ok());
}

TEST_F(ToolTest, SendsTheScoreAlsoToTheLineItemOfAnotherActivity) {
  const int most = AnswerAll(Launch(ExampleClaims()), true);
  ASSERT_EQ(school_.To("https://school.example/items/3/scores?type=1", 1).size(), 1U);
  json again = ExampleClaims();
  again[kExampleEndpoint]["lineitem"] = "https://school.example/items/4";
  Launch(again);
  const auto sent = school_.To("https://school.example/items/4/scores", 1);
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(json::parse(sent.back().body)["scoreGiven"], most);
}

TEST_F(ToolTest, StatesWhatALearnerDoes) {
  const Response launched = Launch(ExampleClaims());
  const auto questions = static_cast<std::size_t>(AnswerAll(launched, true));
  std::multiset<std::string> verbs;
  std::set<std::string> ids;
  for (const HttpRequest& request : school_.To("https://lrs.example/xapi/statements", questions + 2)) {
    const json statement = json::parse(request.body);
    verbs.insert(statement["verb"]["display"]["en"].get<std::string>());
    ids.insert(statement["id"].get<std::string>());
    EXPECT_EQ(statement["actor"]["account"]["name"], "user-7");
    EXPECT_FALSE(statement["actor"].contains("name"));
    EXPECT_THAT(request.headers, testing::Contains("Authorization: Basic dXNlcjpzZWNyZXQ="));
    if (statement["verb"]["display"]["en"] == "completed") {
      EXPECT_EQ(statement["result"]["score"]["scaled"], 1.0);
    }
  }
  EXPECT_EQ(verbs.count("launched"), 1U);
  EXPECT_EQ(verbs.count("answered"), questions);
  EXPECT_EQ(verbs.count("completed"), 1U);
  EXPECT_EQ(ids.size(), questions + 2);
}

TEST_F(ToolTest, ReportsNothingOfOtherSessionsLessonsAndTests) {
  const Response launched = Launch(ExampleClaims());
  school_.To("https://lrs.example/xapi/statements", 1);
  v1::SubmitAnswerRequest answer;
  answer.set_session_id("another");
  answer.set_respondent(FieldOf(FragmentOf(launched), "respondent"));
  answer.set_lesson("paralysis");
  answer.set_step(2);
  for (int step = -1; step < 20; ++step) {
    answer.set_step(step);
    tool_->Answered(answer, kExampleNow);
  }
  answer.set_session_id(classroom_.last.session);
  answer.set_lesson("copd");
  tool_->Answered(answer, kExampleNow);
  answer.set_lesson("../index");
  tool_->Answered(answer, kExampleNow);
  answer.set_lesson("paralysis");
  answer.set_phase(v1::ANSWER_PHASE_BEFORE);
  for (int step = 1; step < 20; ++step) {
    answer.set_step(step);
    tool_->Answered(answer, kExampleNow);
  }
  EXPECT_EQ(school_.To("https://lrs.example/xapi/statements", 1).size(), 1U);
}

TEST_F(ToolTest, GivesTheNamesOfTheCoursesMembers) {
  const Response launched = Launch(ExampleClaims());
  const auto names = tool_->Names(classroom_.last.session, kExampleNow);
  EXPECT_THAT(names, testing::ElementsAre(testing::Pair(FieldOf(FragmentOf(launched), "respondent"), "Anna Example")));
  tool_->Names(classroom_.last.session, kExampleNow);
  EXPECT_EQ(school_.To("https://school.example/members2", 1).size(), 1U);  // kept
  EXPECT_TRUE(tool_->Names("thorax", kExampleNow).empty());
}

TEST_F(ToolTest, AsksForTheNamesOfACourseOneCallAtATime) {
  Launch(ExampleClaims());
  int others = 0;
  on_members_ = [&] {
    ++others;
    EXPECT_TRUE(tool_->Names(classroom_.last.session, kExampleNow).empty());  // returns while the first call waits
  };
  EXPECT_EQ(tool_->Names(classroom_.last.session, kExampleNow).size(), 1U);
  EXPECT_EQ(others, 1);
}

TEST_F(ToolTest, RefusesAKeyWithUnreadableNumbers) {
  const std::string file = folder_ + "/bad.json";
  std::ofstream(file) << R"({"keys":[{"kty":"RSA","kid":"1","n":"!","e":"AQAB","d":"AQAB"}]})";
  const auto key = ToolKey::Open(file);
  EXPECT_THAT(std::string(key.status().message()), HasSubstr("not base64url"));
}

TEST_F(ToolTest, SendsTheTeachersChoiceBackSignedAndOnce) {
  const Response page = Launch(ExampleChoiceClaims());
  ASSERT_EQ(page.status, 200U) << page.text;
  EXPECT_THAT(page.text, HasSubstr("value=\"pneumothorax\""));
  const std::string marker = "name=\"ticket\" value=\"";
  const std::string ticket = page.text.substr(page.text.find(marker) + marker.size(), 32);
  const Request chosen{.post = true,
                       .target = "/lti/select",
                       .body = WriteForm({{"ticket", ticket}, {"lesson", "pneumothorax"}, {"learners", "controller"}})};
  const Response sent = tool_->Handle(chosen, kExampleNow);
  ASSERT_EQ(sent.status, 200U) << sent.text;
  EXPECT_THAT(sent.text, HasSubstr("action=\"https://school.example/return\""));
  EXPECT_THAT(Header(sent, "Content-Security-Policy"), HasSubstr("form-action https://school.example;"));
  const std::string jwt = "name=\"JWT\" value=\"";
  const std::string rest = sent.text.substr(sent.text.find(jwt) + jwt.size());
  const auto keys = access::KeySet::Parse(tool_->Handle({.target = "/lti/jwks"}, kExampleNow).text);
  const auto verified = keys->Verified(rest.substr(0, rest.find('"')));
  ASSERT_TRUE(verified.ok()) << verified.status();
  const json claims = json::parse(*verified);
  EXPECT_EQ(claims["iss"], "client-1");
  EXPECT_EQ(claims["aud"], "https://school.example");
  EXPECT_EQ(claims["https://purl.imsglobal.org/spec/lti-dl/claim/data"], "kept");
  const json item = claims["https://purl.imsglobal.org/spec/lti-dl/claim/content_items"][0];
  EXPECT_EQ(item["custom"]["lesson"], "pneumothorax");
  EXPECT_EQ(item["custom"]["learners"], "controller");
  EXPECT_GT(item["lineItem"]["scoreMaximum"], 0);
  EXPECT_EQ(tool_->Handle(chosen, kExampleNow).status, 401U);
}

TEST_F(ToolTest, EscapesWhatOthersWroteInItsPages) {
  json claims = ExampleClaims();
  claims["https://purl.imsglobal.org/spec/lti-ags/claim/endpoint"]["lineitem"] = "https://evil.example/\"><script>";
  const Response response = Launch(claims);
  EXPECT_EQ(response.status, 403U);
  EXPECT_THAT(response.text, testing::Not(HasSubstr("<script")));
}

}  // namespace
}  // namespace phrenic::lti
