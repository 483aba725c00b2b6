#include "server/access/accounts.h"

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"
#include "server/access/fetch.h"
#include "server/crypto/sha256.h"

namespace phrenic::access {
namespace {

constexpr absl::Duration kKeysAge = absl::Minutes(1);  // before keys are fetched from an address again

std::filesystem::file_time_type ModifiedAt(const std::string& file) {
  std::error_code missing;
  return std::filesystem::last_write_time(file, missing);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Accounts>> Accounts::Open(AccountOptions options) {
  std::unique_ptr<Accounts> accounts(new Accounts(std::move(options)));
  if (absl::Status status = accounts->ReadTokenFile(); !status.ok()) return status;
  if (absl::Status status = accounts->ReadKeys(); !status.ok()) return status;
  return accounts;
}

absl::Status Accounts::ReadTokenFile() {
  if (options_.tokens_file.empty()) return absl::OkStatus();
  tokens_changed_ = ModifiedAt(options_.tokens_file);
  auto tokens = ReadTokens(options_.tokens_file);
  if (!tokens.ok()) return tokens.status();
  absl::MutexLock lock(&mutex_);
  tokens_ = std::make_shared<const TokenTable>(*std::move(tokens));
  return absl::OkStatus();
}

absl::Status Accounts::ReadKeys() {
  if (options_.jwt.keys.empty()) return absl::OkStatus();
  keys_changed_ = ModifiedAt(options_.jwt.keys);
  keys_due_ = absl::Now() + kKeysAge;
  auto keys = JwtKeys::Read(options_.jwt);
  if (!keys.ok()) return keys.status();
  absl::MutexLock lock(&mutex_);
  keys_ = *std::move(keys);
  return absl::OkStatus();
}

absl::Status Accounts::Refresh() {
  if (!options_.tokens_file.empty() && ModifiedAt(options_.tokens_file) != tokens_changed_) {
    if (absl::Status status = ReadTokenFile(); !status.ok()) return status;
  }
  if (options_.jwt.keys.empty()) return absl::OkStatus();
  const bool due =
      IsAddress(options_.jwt.keys) ? absl::Now() >= keys_due_ : ModifiedAt(options_.jwt.keys) != keys_changed_;
  return due ? ReadKeys() : absl::OkStatus();
}

bool Accounts::StillHas(const Account& account) const {
  if (account.token_sha256.empty()) return true;
  absl::MutexLock lock(&mutex_);
  return tokens_ != nullptr && tokens_->contains(account.token_sha256);
}

std::string Accounts::Qualified(const std::string& stored) const {
  if (stored.empty() || options_.jwt.keys.empty()) return stored;
  absl::MutexLock lock(&mutex_);
  const bool in_file = tokens_ != nullptr && std::any_of(tokens_->begin(), tokens_->end(),
                                                         [&](const auto& each) { return each.second.name == stored; });
  return in_file ? stored : JwtAccountName(options_.jwt.issuer, stored);
}

absl::StatusOr<Account> Accounts::Check(std::string_view token) const {
  std::shared_ptr<const TokenTable> tokens;
  std::shared_ptr<const JwtKeys> keys;
  {
    absl::MutexLock lock(&mutex_);
    tokens = tokens_;
    keys = keys_;
  }
  // The lookups compare hashes, so their duration reveals nothing about a token.
  const std::string hash = Sha256Hex(token);
  if (tokens != nullptr) {
    if (const auto found = tokens->find(hash); found != tokens->end()) return found->second;
  }
  if (auto issued = issued_.Find(hash, absl::Now()); issued.has_value()) return *std::move(issued);
  if (keys != nullptr) return keys->Check(token, absl::Now());
  return absl::UnauthenticatedError(
      "authorization: no account has this token; check that it is complete, or ask for a new one (phrenicd token add)");
}

}  // namespace phrenic::access
