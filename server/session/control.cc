#include "server/session/control.h"

#include <algorithm>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "google/protobuf/util/time_util.h"
#include "server/crypto/secret.h"

namespace phrenic::session {
namespace {

constexpr std::int64_t kLongestName = 40;

bool IsContinuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }  // byte of a character in UTF-8

std::string ClockTime(absl::Time time) { return absl::FormatTime("%H:%M:%S UTC", time, absl::UTCTimeZone()); }

void Renew(ControlState::Person& person, absl::Time now) { person.expires = now + person.time_to_live; }

void DescribePerson(const ControlState::Person& person, v1::Control& control, bool owner) {
  v1::Participant& participant = *control.add_participants();
  participant.set_name(person.name);
  participant.set_asks(person.asks);
  participant.set_owner(owner);
}

}  // namespace

absl::Status CheckName(const std::string& field, const std::string& name) {
  const auto characters = std::count_if(name.begin(), name.end(), [](char c) { return !IsContinuation(c); });
  const bool plain = std::none_of(name.begin(), name.end(), [](char c) { return absl::ascii_iscntrl(c); });
  const bool trimmed = absl::StripAsciiWhitespace(name).size() == name.size();
  if (plain && trimmed && characters >= 1 && characters <= kLongestName) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(field, ": a name has 1 to ", kLongestName,
                   " characters, none of them a control character, and neither begins nor ends with a space"));
}

absl::StatusOr<ControlBook> ControlBook::Make(v1::ControlPolicy policy, const std::string& owner,
                                              const std::string& account) {
  if (!owner.empty()) {
    if (absl::Status status = CheckName("owner_name", owner); !status.ok()) return status;
  }
  ControlBook book;
  book.state_.policy = policy == v1::CONTROL_POLICY_UNSPECIFIED ? v1::CONTROL_POLICY_EVERYBODY : policy;
  book.state_.owner.name = owner.empty() ? "owner" : owner;
  book.state_.owner.token = NewToken();
  book.state_.account = account;
  return book;
}

absl::Status ControlBook::AddLink(ControlState::Link link, absl::Time now) {
  std::erase_if(state_.links, [now](const ControlState::Link& each) { return each.expires <= now; });
  if (state_.links.size() >= kMostLinks) {
    return absl::ResourceExhaustedError(
        absl::StrCat("the session has ", kMostLinks, " join links, and no more are allowed; revoke one first"));
  }
  state_.links.push_back(std::move(link));
  ++state_.revision;
  return absl::OkStatus();
}

absl::Status ControlBook::RemoveLink(const std::string& id) {
  if (std::erase_if(state_.links, [&id](const ControlState::Link& each) { return each.id == id; }) == 0) {
    return absl::NotFoundError(absl::StrCat("link_id: the session has no link \"", id, "\""));
  }
  ++state_.revision;
  return absl::OkStatus();
}

bool ControlBook::IsOwner(std::string_view token) const { return SameToken(token, state_.owner.token); }

ControlBook::Person* ControlBook::Find(std::string_view token) {
  if (IsOwner(token)) return &state_.owner;
  const auto found = std::find_if(state_.people.begin(), state_.people.end(),
                                  [token](const Person& person) { return SameToken(token, person.token); });
  return found == state_.people.end() ? nullptr : &*found;
}

const ControlBook::Person* ControlBook::Holder() const {
  for (const Person& person : state_.people) {
    if (person.token == state_.holder) return &person;
  }
  return nullptr;
}

void ControlBook::GiveTo(std::string holder) {
  state_.holder = std::move(holder);
  ++state_.revision;
  if (!state_.holder.empty() || state_.policy == v1::CONTROL_POLICY_OWNER) return;
  for (Person& person : state_.people) person.asks = false;  // they have what they asked for
}

v1::Control ControlBook::Describe(absl::Time now) const {
  v1::Control control;
  control.set_policy(state_.policy);
  control.set_owner(state_.owner.name);
  control.set_revision(state_.revision);
  if (const Person* holder = Holder(); holder != nullptr) {
    control.set_controller(holder->name);
    *control.mutable_expire_time() =
        google::protobuf::util::TimeUtil::NanosecondsToTimestamp(absl::ToUnixNanos(holder->expires));
  } else if (state_.policy == v1::CONTROL_POLICY_OWNER) {
    control.set_controller(state_.owner.name);
  }
  if (now < state_.owner.expires) DescribePerson(state_.owner, control, true);
  for (const Person& person : state_.people) DescribePerson(person, control, false);
  return control;
}

absl::Status ControlBook::Refuse(absl::Time now) const {
  const v1::Control control = Describe(now);
  const Person* const holder = Holder();
  const std::string until = holder == nullptr
                                ? ", who owns it"
                                : absl::StrCat(", until ", ClockTime(holder->expires), " unless they renew it");
  return absl::PermissionDeniedError(
      absl::StrCat("control_token: the session is controlled by ", control.controller(), until,
                   "; ask for control with \"Ask\" in the viewer, `phrenic control take` or TakeControl, or fork the "
                   "session and change the fork"));
}

absl::Status ControlBook::Check(std::string_view token, absl::Time now) {
  Expire(now);
  Person* const person = Find(token);
  if (person != nullptr && person != &state_.owner) Renew(*person, now);
  const Person* const holder = Holder();
  if (holder != nullptr) return person == holder ? absl::OkStatus() : Refuse(now);
  if (state_.policy != v1::CONTROL_POLICY_OWNER || person == &state_.owner) return absl::OkStatus();
  return Refuse(now);
}

absl::Status ControlBook::CheckAlone(std::string_view token, absl::Time now) {
  if (absl::Status status = Check(token, now); !status.ok()) return status;
  if (Holder() != nullptr || state_.policy == v1::CONTROL_POLICY_OWNER) return absl::OkStatus();
  return absl::PermissionDeniedError("control_token: everybody controls the session; take control first");
}

absl::Status ControlBook::CheckFree(const std::string& name, const Person* self, absl::Time now) const {
  const auto is_other = [&](const Person& person) { return &person != self && person.name == name; };
  // An owner keeps the name while away, so that no one else can pass for the owner.
  if (!is_other(state_.owner) && std::none_of(state_.people.begin(), state_.people.end(), is_other)) {
    return absl::OkStatus();
  }
  return absl::AlreadyExistsError(
      absl::StrCat("name: another person is ", name, " in this session, as ",
                   is_other(state_.owner) && now >= state_.owner.expires ? "its owner, who is away" : "others see",
                   "; enter under another name"));
}

absl::StatusOr<std::string> ControlBook::Enter(const std::string& name, std::string_view token,
                                               absl::Duration time_to_live, absl::Time now) {
  Expire(now);
  Person* person = Find(token);
  const bool keeps_name = person != nullptr && (name.empty() || name == person->name);
  const bool was_there = person != nullptr && now < person->expires;
  if (!keeps_name) {
    if (absl::Status status = CheckName("name", name); !status.ok()) return status;
    if (absl::Status status = CheckFree(name, person, now); !status.ok()) return status;
  }
  if (person == nullptr) {
    if (state_.people.size() >= kMostPeople) {
      return absl::ResourceExhaustedError(absl::StrCat("there are ", state_.people.size(),
                                                       " people in the session, and no more are allowed; watching "
                                                       "needs no name, or try again later"));
    }
    person = &state_.people.emplace_back();
    person->token = NewToken();
  }
  if (!keeps_name) person->name = name;
  person->time_to_live = time_to_live;
  Renew(*person, now);
  if (!keeps_name || !was_there) ++state_.revision;
  return person->token;
}

absl::StatusOr<ControlBook::Person*> ControlBook::Known(std::string_view token, absl::Time now) {
  Expire(now);
  Person* const person = Find(token);
  if (person == nullptr) {
    return absl::PermissionDeniedError(
        "control_token: no one is in the session with this token, or their time is over; enter it first "
        "(EnterSession)");
  }
  if (person != &state_.owner) Renew(*person, now);
  return person;
}

absl::StatusOr<ControlBook::Person*> ControlBook::KnownToDecide(std::string_view token, absl::Time now) {
  absl::StatusOr<Person*> person = Known(token, now);
  if (!person.ok() || *person == &state_.owner || *person == Holder()) return person;
  if (Holder() == nullptr && state_.policy != v1::CONTROL_POLICY_OWNER) {
    return absl::PermissionDeniedError("control_token: everybody controls the session; take control first");
  }
  return Refuse(now);
}

absl::StatusOr<bool> ControlBook::Take(std::string_view token, absl::Time now) {
  const absl::StatusOr<Person*> known = Known(token, now);
  if (!known.ok()) return known.status();
  Person& person = **known;
  const bool owner = &person == &state_.owner;
  const bool granted =
      owner || &person == Holder() || (Holder() == nullptr && state_.policy != v1::CONTROL_POLICY_OWNER);
  person.asks = !granted;
  if (owner) state_.policy = v1::CONTROL_POLICY_OWNER;
  GiveTo(!granted ? state_.holder : owner ? "" : person.token);
  return granted;
}

absl::Status ControlBook::Hand(std::string_view token, const std::string& name, absl::Time now) {
  const absl::StatusOr<Person*> by = KnownToDecide(token, now);
  if (!by.ok()) return by.status();
  if (state_.owner.name == name && now < state_.owner.expires) {  // the same as if the owner took it
    state_.policy = v1::CONTROL_POLICY_OWNER;
    GiveTo("");
    return absl::OkStatus();
  }
  const auto to = std::find_if(state_.people.begin(), state_.people.end(),
                               [&name](const Person& person) { return person.name == name; });
  if (to == state_.people.end()) {
    return absl::FailedPreconditionError(
        absl::StrCat("name: no one has entered the session as ", name,
                     "; people enter with their name in the viewer, or by `phrenic control take`"));
  }
  to->asks = false;
  GiveTo(to->token);
  return absl::OkStatus();
}

absl::Status ControlBook::HandToEverybody(std::string_view token, absl::Time now) {
  const absl::StatusOr<Person*> by = KnownToDecide(token, now);
  if (!by.ok()) return by.status();
  if (*by != &state_.owner && state_.policy == v1::CONTROL_POLICY_OWNER) {
    return absl::PermissionDeniedError(absl::StrCat("control_token: only ", state_.owner.name,
                                                    ", who owns the session, lends it to everybody; hand control "
                                                    "to one person, or release it"));
  }
  state_.policy = v1::CONTROL_POLICY_EVERYBODY;
  GiveTo("");
  return absl::OkStatus();
}

absl::Status ControlBook::Release(std::string_view token, absl::Time now) {
  const absl::StatusOr<Person*> known = Known(token, now);
  if (!known.ok()) return known.status();
  if (*known == &state_.owner) {
    return absl::FailedPreconditionError(
        "control_token: an owner's control does not end; hand it to one person, or to everybody");
  }
  (*known)->asks = false;
  GiveTo(*known == Holder() ? "" : state_.holder);
  return absl::OkStatus();
}

bool ControlBook::Expire(absl::Time now) {
  const auto gone = std::erase_if(state_.people, [now](const Person& person) { return person.expires <= now; });
  const bool owner_left = state_.owner.expires != absl::InfinitePast() && state_.owner.expires <= now;
  if (owner_left) state_.owner.expires = absl::InfinitePast();
  if (gone == 0 && !owner_left) return false;
  GiveTo(Holder() == nullptr ? "" : state_.holder);
  return true;
}

absl::Time ControlBook::next_expiry() const {
  absl::Time next = absl::InfiniteFuture();
  for (const Person& person : state_.people) next = std::min(next, person.expires);
  if (state_.owner.expires != absl::InfinitePast()) next = std::min(next, state_.owner.expires);
  return next;
}

}  // namespace phrenic::session
