#include "server/lti/tool.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/crypto/secret.h"
#include "server/crypto/sha256.h"
#include "server/lti/form.h"
#include "server/lti/pages.h"
#include "server/lti/xapi.h"

namespace phrenic::lti {
namespace {

using nlohmann::json;

constexpr absl::Duration kLoginTime = absl::Minutes(10), kChoiceTime = absl::Minutes(30),
                         kNamesKept = absl::Minutes(10), kNamesPause = absl::Minutes(1), kNamesTime = absl::Seconds(10);
constexpr int kCookieSeconds = 600, kResponseSeconds = 300;
constexpr std::size_t kMostCourses = 1000, kIdLength = 12, kCookieIdLength = 12;
constexpr char kToolClaim[] = "https://purl.imsglobal.org/spec/lti/claim/";
constexpr char kLinkClaim[] = "https://purl.imsglobal.org/spec/lti-dl/claim/";

// The name of the cookie that binds a state to a browser: one for each, so that two tabs can launch at a time.
std::string CookieName(const std::string& state) { return "phrenic_lti_" + state.substr(0, kCookieIdLength); }

// Sent from a frame of the platform's page, hence SameSite=None; kept apart for each such page (Partitioned), so that
// browsers that refuse the cookies of third parties keep it as well.
std::string CookieOfLogin(const std::string& state, const std::string& value, int seconds) {
  return absl::StrCat(CookieName(state), "=", value, "; Path=/lti; Max-Age=", seconds,
                      "; HttpOnly; Secure; SameSite=None; Partitioned");
}

std::string CourseOf(const Platform& platform, const Launch& launch) {
  const json key = {KeyOf(platform), launch.deployment, launch.course};
  return Sha256Hex(key.dump()).substr(0, kIdLength);
}

}  // namespace

Tool::Tool(Parts parts)
    : parts_(std::move(parts)),
      exchange_([this](access::HttpRequest request) {
        request.cancelled = &cancelled_;
        return parts_.exchange(request);
      }),
      lessons_(parts_.lessons_folder),
      learners_("lti-learner", parts_.store),
      scores_kept_("lti-score", parts_.store),
      statements_kept_("lti-statement", parts_.store),
      logins_(kLoginTime),
      choices_(kChoiceTime),
      scores_(std::make_unique<Outbox>([this](const Parcel& parcel) { return DeliverScore(parcel); }, scores_kept_)),
      statements_(parts_.settings.lrs.used()
                      ? std::make_unique<Outbox>(
                            [this](const Parcel& parcel) {
                              return SendStatement(parts_.settings.lrs, parcel.content, exchange_);
                            },
                            statements_kept_)
                      : nullptr),
      grading_({parts_.settings.url, &lessons_, scores_.get(), statements_.get()}, learners_) {
  const auto fetch = [this](const std::string& address) -> absl::StatusOr<std::string> {
    const auto answer = exchange_({address});
    if (!answer.ok()) return answer.status();
    absl::Status status = StatusOfHttp(address, answer->status);
    if (!status.ok()) return absl::UnavailableError(status.message());
    return answer->body;
  };
  for (const Platform& platform : parts_.settings.platforms) {
    keys_.push_back(std::make_unique<PlatformKeys>(platform.keys_url, fetch));
    clients_.push_back(std::make_unique<PlatformClient>(platform, *parts_.key, exchange_));
  }
}

Tool::~Tool() {
  Cancel();
  scores_.reset();
  statements_.reset();
}

std::vector<std::string> Tool::AllFramers() const {
  std::vector<std::string> framers;
  for (const Platform& platform : parts_.settings.platforms) {
    framers.insert(framers.end(), platform.origins.begin(), platform.origins.end());
  }
  return framers;
}

absl::Status Tool::DeliverScore(const Parcel& parcel) {
  const auto& platforms = parts_.settings.platforms;
  for (std::size_t i = 0; i < platforms.size(); ++i) {
    if (KeyOf(platforms[i]) == parcel.receiver) return clients_[i]->SendScore(parcel.address, parcel.content);
  }
  return absl::UnavailableError("the settings do not name the platform of a score any more");
}

Response Tool::Handle(const Request& request, absl::Time now) {
  const std::string path = request.target.substr(0, request.target.find('?'));
  const std::string query = request.target.size() > path.size() ? request.target.substr(path.size() + 1) : "";
  const Fields fields = ReadForm(request.post ? request.body : query);
  if (path == "/lti/login") return OnLogin(fields, now);
  if (path == "/lti/launch" && request.post) return OnLaunch(fields, request.cookies, now);
  if (path == "/lti/select" && request.post) return OnSelect(fields, now);
  if (path == "/lti/jwks") return {.type = "application/json", .text = parts_.key->public_set()};
  if (path == "/lti/launch") {
    return ErrorPage(absl::InvalidArgumentError("Lessons open from your course: open the activity there."),
                     AllFramers());
  }
  return AssetOf(path);
}

Response Tool::OnLogin(const Fields& fields, absl::Time now) {
  const auto& platforms = parts_.settings.platforms;
  const std::string issuer = FieldOf(fields, "iss"), client = FieldOf(fields, "client_id");
  const auto platform = std::find_if(platforms.begin(), platforms.end(), [&](const Platform& each) {
    return each.issuer == issuer && (client.empty() || each.client_id == client);
  });
  if (platform == platforms.end()) {
    return ErrorPage(
        absl::PermissionDeniedError("This server does not know your learning platform (iss, client_id): its "
                                    "administrator adds it with --lti-platform."),
        AllFramers());
  }
  if (OriginOf(FieldOf(fields, "target_link_uri")) != parts_.settings.url) {
    return ErrorPage(absl::PermissionDeniedError("The activity leads to another server (target_link_uri)."),
                     FramersOf(*platform));
  }
  const std::string state = logins_.Begin(static_cast<std::size_t>(platform - platforms.begin()), now);
  std::vector<std::pair<std::string, std::string>> question = {{"response_type", "id_token"},
                                                               {"response_mode", "form_post"},
                                                               {"scope", "openid"},
                                                               {"prompt", "none"},
                                                               {"client_id", platform->client_id},
                                                               {"redirect_uri", parts_.settings.url + "/lti/launch"},
                                                               {"login_hint", FieldOf(fields, "login_hint")},
                                                               {"state", state},
                                                               {"nonce", logins_.Read(state, now)->nonce}};
  if (fields.contains("lti_message_hint"))
    question.emplace_back("lti_message_hint", FieldOf(fields, "lti_message_hint"));
  const char* joint = absl::StrContains(platform->login_url, "?") ? "&" : "?";
  Response response = Redirect(absl::StrCat(platform->login_url, joint, WriteForm(question)));
  response.headers.emplace_back("Set-Cookie", CookieOfLogin(state, state, kCookieSeconds));
  return response;
}

absl::StatusOr<Tool::Choice> Tool::ReadToken(const Fields& fields, const std::string& cookies, absl::Time now) {
  if (fields.contains("error")) {
    return absl::PermissionDeniedError(
        "Your learning platform did not admit you. Sign in there and open the activity again.");
  }
  const std::string state = FieldOf(fields, "state");
  if (!SameToken(CookieOf(cookies, CookieName(state)), state)) {
    return absl::UnauthenticatedError(
        "Your browser did not keep the cookie of this launch. Open the activity in a window of its own, or allow "
        "cookies "
        "for this site.");
  }
  const auto login = logins_.Read(state, now);
  if (!login.has_value() || login->platform >= keys_.size()) {
    return absl::UnauthenticatedError("This launch has expired: open the activity again in your course.");
  }
  const auto claims = keys_[login->platform]->Verified(FieldOf(fields, "id_token"), now);
  if (absl::IsUnavailable(claims.status())) {
    return absl::UnavailableError(
        absl::StrCat("The keys of your learning platform cannot be read now: try again in a "
                     "minute. ",
                     claims.status().message()));
  }
  if (!claims.ok()) {
    return absl::UnauthenticatedError(
        absl::StrCat("The platform's message cannot be trusted: it ", claims.status().message(), "."));
  }
  auto launch = ReadLaunch(*claims, parts_.settings.platforms[login->platform], login->nonce, parts_.settings.url, now);
  if (!launch.ok()) return launch.status();
  if (absl::Status used = logins_.Use(state, now); !used.ok()) return used;
  return Choice{login->platform, *std::move(launch)};
}

Response Tool::OnLaunch(const Fields& fields, const std::string& cookies, absl::Time now) {
  auto choice = ReadToken(fields, cookies, now);
  absl::StatusOr<Response> response;
  if (!choice.ok()) {
    response = choice.status();
  } else if (choice->launch.chooses) {
    const auto framers = FramersOf(parts_.settings.platforms[choice->platform]);
    response = ChoicePage(lessons_.List(), choices_.Issue(*std::move(choice), now), framers);
  } else {
    response = OpenLesson(*choice, now);
  }
  if (response.ok()) {
    response->headers.emplace_back("Set-Cookie", CookieOfLogin(FieldOf(fields, "state"), "", 0));  // it was used
    return *std::move(response);
  }
  spdlog::warn("lti: a launch was refused: {}", std::string(response.status().message()));
  return ErrorPage(response.status(), AllFramers());
}

absl::StatusOr<Response> Tool::OpenLesson(const Choice& choice, absl::Time now) {
  const Launch& launch = choice.launch;
  const Platform& platform = parts_.settings.platforms[choice.platform];
  std::string scene = "thorax";
  if (!launch.lesson.empty()) {
    const auto lesson = lessons_.Find(launch.lesson);
    if (!lesson.ok()) return lesson.status();
    scene = lesson->scene();
  }
  const std::string course = CourseOf(platform, launch), session = "course-" + course;
  auto credentials = parts_.classroom->Admit({.session = session,
                                              .account = absl::StrCat("lti:", platform.issuer, "#", session),
                                              .scene = scene,
                                              .teaches = launch.teaches,
                                              .learners_control = launch.learners_control});
  if (!credentials.ok()) return credentials.status();
  NoteCourse(session, choice.platform, launch.memberships);
  std::string fragment = "launch=1&" + *credentials;
  if (!launch.teaches) {
    absl::StrAppend(&fragment, "&respondent=", grading_.Enter(platform, launch, course, session, now));
  }
  std::vector<std::pair<std::string, std::string>> query = {{"session", session}, {"view", "student"}};
  if (!launch.lesson.empty()) query.emplace_back("lesson", launch.lesson);
  return Redirect(absl::StrCat(parts_.settings.url, "/?", WriteForm(query), "#", fragment));
}

Response Tool::OnSelect(const Fields& fields, absl::Time now) {
  const auto choice = choices_.Use(FieldOf(fields, "ticket"), now);
  absl::StatusOr<Response> response = absl::UnauthenticatedError(
      "This page was used already or has expired: choose the lesson again from your course.");
  if (choice.has_value()) response = SendChoice(*choice, fields, now);
  return response.ok() ? *std::move(response) : ErrorPage(response.status(), AllFramers());
}

absl::StatusOr<Response> Tool::SendChoice(const Choice& choice, const Fields& fields, absl::Time now) {
  const std::string name = FieldOf(fields, "lesson");
  const auto lesson = lessons_.Find(name);
  if (!lesson.ok()) return lesson.status();
  const bool control = FieldOf(fields, "learners") == "controller";
  json item = {{"type", "ltiResourceLink"},
               {"title", lesson->title()},
               {"text", lesson->summary()},
               {"url", parts_.settings.url + "/lti/launch"},
               {"custom", {{"lesson", name}, {"learners", control ? "controller" : "viewer"}}}};
  if (const int questions = QuestionCount(*lesson); questions > 0) {
    item["lineItem"] = {{"scoreMaximum", questions}, {"label", lesson->title()}, {"resourceId", name}};
  }
  const Platform& platform = parts_.settings.platforms[choice.platform];
  const std::int64_t seconds = absl::ToUnixSeconds(now);
  json claims = {{"iss", platform.client_id},
                 {"aud", platform.issuer},
                 {"iat", seconds},
                 {"exp", seconds + kResponseSeconds},
                 {"nonce", NewToken()}};
  claims[std::string(kToolClaim) + "message_type"] = "LtiDeepLinkingResponse";
  claims[std::string(kToolClaim) + "version"] = "1.3.0";
  claims[std::string(kToolClaim) + "deployment_id"] = choice.launch.deployment;
  claims[std::string(kLinkClaim) + "content_items"] = json::array({item});
  if (!choice.launch.data.empty()) claims[std::string(kLinkClaim) + "data"] = choice.launch.data;
  const auto token = parts_.key->Sign(claims);
  if (!token.ok()) return token.status();
  return SendPage(choice.launch.return_url, *token, FramersOf(platform));
}

void Tool::NoteCourse(const std::string& session, std::size_t platform, const std::string& memberships) {
  if (memberships.empty()) return;
  absl::MutexLock lock(&mutex_);
  if (courses_.size() >= kMostCourses && !courses_.contains(session)) courses_.erase(courses_.begin());
  Course& course = courses_[session];
  if (course.memberships != memberships) course = {platform, memberships, {}, absl::InfinitePast(), false};
}

MemberNames Tool::NamesOfCourse(const std::string& session, absl::Time now) {
  Course course;
  {
    absl::MutexLock lock(&mutex_);
    const auto found = courses_.find(session);
    if (found == courses_.end()) return {};
    if (found->second.reading || now - found->second.read <= kNamesKept) return found->second.names;
    found->second.reading = true;
    course = found->second;
  }
  auto names = clients_[course.platform]->Members(course.memberships, absl::Now() + kNamesTime);
  if (!names.ok()) {
    spdlog::warn("lti: the names of a course cannot be read: {}", std::string(names.status().message()));
  }
  absl::MutexLock lock(&mutex_);
  const auto found = courses_.find(session);
  if (found == courses_.end() || found->second.memberships != course.memberships) return {};
  Course& kept = found->second;
  kept.reading = false;
  kept.read = names.ok() ? now : now - kNamesKept + kNamesPause;  // so that an open table does not ask all the time
  if (names.ok()) kept.names = *std::move(names);
  return kept.names;
}

std::map<std::string, std::string> Tool::Names(const std::string& session, absl::Time now) {
  const MemberNames names = NamesOfCourse(session, now);
  std::map<std::string, std::string> named;
  if (names.empty()) return named;
  for (const auto& [respondent, user] : grading_.Users(session)) {
    if (const auto name = names.find(user); name != names.end()) named[respondent] = name->second;
  }
  return named;
}

void Tool::Restore(const std::vector<store::SavedRecord>& records, std::map<std::string, absl::Status>& lost) {
  learners_.Restore(
      records, [&](const store::SavedRecord& record) { return grading_.Restore(record.bytes); }, lost);
  scores_kept_.Restore(
      records, [&](const store::SavedRecord& record) { return scores_->Restore(record.bytes); }, lost);
  if (statements_ == nullptr) return;
  statements_kept_.Restore(
      records, [&](const store::SavedRecord& record) { return statements_->Restore(record.bytes); }, lost);
}

}  // namespace phrenic::lti
