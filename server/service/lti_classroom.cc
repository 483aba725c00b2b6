#include "server/service/lti_classroom.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "server/access/rules.h"
#include "server/crypto/secret.h"
#include "server/crypto/sha256.h"

namespace phrenic::service {
namespace {

constexpr absl::Duration kLessonTime = absl::Hours(12), kLinkTime = absl::Hours(24);
constexpr char kTeacher[] = "Teacher";  // under which all teachers of the course control the session
constexpr char kLinkMaker[] = "lti";
constexpr std::size_t kLinkIdLength = 8, kMostLinksKept = 10'000;

}  // namespace

absl::StatusOr<std::shared_ptr<session::Session>> LtiClassroom::FindOrCreate(const lti::Visit& visit) {
  auto found = table_.Find(visit.session);
  if (found.ok()) {
    if ((*found)->access()->account == visit.account) return found;
    return absl::FailedPreconditionError("The session of this course belongs to another account on this server.");
  }
  v1::CreateSessionRequest request;
  request.set_session_id(visit.session);
  request.mutable_source()->set_name(visit.scene);
  auto control = session::ControlBook::Make(v1::CONTROL_POLICY_OWNER, kTeacher, visit.account);
  if (!control.ok()) return control.status();
  session::Requester requester;
  requester.owner = requester.share = visit.account;
  auto made = table_.Create(request, *std::move(control), requester);
  if (made.ok()) lent_.erase(visit.session);
  if (absl::IsResourceExhausted(made.status())) {
    return absl::UnavailableError(
        absl::StrCat("The server has no room for another class now. ", made.status().message()));
  }
  return made;
}

absl::StatusOr<std::string> LtiClassroom::OwnerToken(session::Session& session, bool learners_control) {
  std::string token;
  // Learners of a session that an earlier server made have a link if control was lent to them.
  const auto access = session.access();
  const bool linked = std::any_of(access->links.begin(), access->links.end(), [](const auto& link) {
    return link.role == v1::ACCESS_ROLE_CONTROLLER && link.made_by == kLinkMaker;
  });
  const bool first = learners_control && !linked && !lent_.contains(session.id());
  const auto read = session.ChangeControl([&](session::ControlBook& book, absl::Time now) {
    token = book.state().owner.token;
    const bool lend = first && book.state().policy == v1::CONTROL_POLICY_OWNER && book.state().holder.empty();
    return lend ? book.HandToEverybody(token, now) : absl::OkStatus();
  });
  if (!read.ok()) return read.status();
  if (lent_.size() >= kMostLinksKept) lent_.erase(lent_.begin());
  if (learners_control) lent_.insert(session.id());
  return token;
}

absl::StatusOr<std::string> LtiClassroom::LinkOf(session::Session& session, v1::AccessRole role) {
  const absl::Time now = absl::Now();
  const std::string key = absl::StrCat(session.id(), " ", std::string(access::NameOf(role)));
  const auto kept = links_.find(key);
  if (kept != links_.end() && now < kept->second.renewed) {
    const auto access = session.access();
    const std::string hash = Sha256Hex(kept->second.secret);
    const bool live = std::any_of(access->links.begin(), access->links.end(),
                                  [&](const auto& link) { return link.secret_sha256 == hash; });
    if (live) return kept->second.secret;
  }
  std::string secret = NewToken();
  const auto added = session.ChangeControl([&](session::ControlBook& book, absl::Time time) {
    return book.AddLink({NewToken().substr(0, kLinkIdLength), Sha256Hex(secret), role, now + kLinkTime, kLinkMaker},
                        time);
  });
  if (!added.ok()) return added.status();
  if (links_.size() >= kMostLinksKept) links_.clear();
  links_[key] = {secret, now + kLinkTime - kLessonTime};
  return secret;
}

absl::StatusOr<std::string> LtiClassroom::Admit(const lti::Visit& visit) {
  absl::MutexLock lock(&mutex_);
  auto session = FindOrCreate(visit);
  if (!session.ok()) return session.status();
  const auto token = OwnerToken(**session, visit.learners_control);
  if (!token.ok()) return token.status();
  const v1::Session status = (*session)->status();
  if (status.state() == v1::SESSION_STATE_PAUSED && status.viewers() == 0) {
    // A learner who controls the session has paused it, if it may not be played.
    auto played = (*session)->Play(std::nullopt, false, 0, *token);
    if (!played.ok() && !absl::IsPermissionDenied(played.status())) return played.status();
  }
  if (visit.teaches) {
    const std::string account = accounts_.Issue({visit.account, v1::ACCESS_ROLE_OWNER}, absl::Now() + kLessonTime);
    return absl::StrCat("account=", account, "&control=", *token);
  }
  auto secret = LinkOf(**session, visit.learners_control ? v1::ACCESS_ROLE_CONTROLLER : v1::ACCESS_ROLE_VIEWER);
  if (!secret.ok()) return secret.status();
  return "join=" + *secret;
}

}  // namespace phrenic::service
