#include "server/cluster/redis.h"

#include <hiredis/hiredis.h>

#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"

namespace phrenic::cluster {
namespace {

constexpr char kScheme[] = "redis://";
constexpr int kLargestPort = 65535;

absl::Status BadAddress(const char* what) {
  return absl::InvalidArgumentError(
      absl::StrCat("--cluster: ", what, "; write redis://HOST:PORT, or redis://:PASSWORD@HOST:PORT"));
}

Reply Read(const redisReply& from) {
  Reply reply;
  reply.nothing = from.type == REDIS_REPLY_NIL;
  reply.number = from.type == REDIS_REPLY_INTEGER ? from.integer : 0;
  if (from.str != nullptr) reply.text.assign(from.str, from.len);
  if (from.type != REDIS_REPLY_ARRAY) return reply;
  reply.list.reserve(from.elements);
  for (std::size_t i = 0; i < from.elements; ++i) reply.list.push_back(Read(*from.element[i]));
  return reply;
}

}  // namespace

absl::StatusOr<RedisAddress> ParseRedisAddress(const std::string& url) {
  if (!absl::StartsWith(url, kScheme)) return BadAddress("the address begins otherwise than redis://");
  std::string rest = url.substr(sizeof kScheme - 1);
  RedisAddress address;
  if (const std::size_t at = rest.rfind('@'); at != std::string::npos) {
    if (rest.empty() || rest[0] != ':') return BadAddress("a password stands between \":\" and \"@\"");
    address.password = rest.substr(1, at - 1);
    rest = rest.substr(at + 1);
  }
  const std::size_t colon = rest.rfind(':');
  address.host = rest.substr(0, colon);
  if (address.host.empty()) return BadAddress("there is no host");
  if (colon == std::string::npos) return address;
  const bool good =
      absl::SimpleAtoi(rest.substr(colon + 1), &address.port) && address.port > 0 && address.port <= kLargestPort;
  return good ? absl::StatusOr<RedisAddress>(address) : BadAddress("the port is not 1 to 65535");
}

void Redis::Free::operator()(redisContext* context) const { redisFree(context); }

Redis::Redis(RedisAddress address) : address_(std::move(address)) {}

Redis::~Redis() = default;

absl::Status Redis::GiveUp(const std::string& why) {
  context_.reset();
  loaded_.clear();
  again_ = absl::Now() + kPause;
  return absl::UnavailableError(
      absl::StrCat("Redis at ", address_.host, ":", address_.port, " cannot be reached (", why, "); start it"));
}

absl::Status Redis::Connect() {
  if (context_ != nullptr) return absl::OkStatus();
  if (absl::Now() < again_) {
    return absl::UnavailableError(
        absl::StrCat("Redis at ", address_.host, ":", address_.port, " could not be reached a moment ago; start it"));
  }
  const timeval patience = absl::ToTimeval(kPatience);
  context_.reset(redisConnectWithTimeout(address_.host.c_str(), address_.port, patience));
  if (context_ == nullptr) return GiveUp("no memory");
  if (context_->err != 0) return GiveUp(std::string(context_->errstr));
  redisSetTimeout(context_.get(), patience);
  redisEnableKeepAlive(context_.get());
  if (!address_.password.empty()) {
    const auto good = Send({"AUTH", address_.password});
    if (!good.ok()) return GiveUp(std::string(good.status().message()));
  }
  ++connections_;
  return absl::OkStatus();
}

absl::StatusOr<Reply> Redis::Send(const std::vector<std::string>& words) {
  std::vector<const char*> texts;
  std::vector<std::size_t> sizes;
  texts.reserve(words.size());
  sizes.reserve(words.size());
  for (const std::string& word : words) {
    texts.push_back(word.data());
    sizes.push_back(word.size());
  }
  const std::unique_ptr<redisReply, void (*)(void*)> reply(
      static_cast<redisReply*>(
          redisCommandArgv(context_.get(), static_cast<int>(words.size()), texts.data(), sizes.data())),
      &freeReplyObject);
  if (reply == nullptr) return GiveUp(std::string(context_->errstr));
  if (reply->type == REDIS_REPLY_ERROR) return absl::InternalError(std::string(reply->str, reply->len));
  return Read(*reply);
}

absl::StatusOr<Reply> Redis::Run(const std::vector<std::string>& words) {
  if (absl::Status status = Connect(); !status.ok()) return status;
  auto reply = Send(words);
  // One that is reading its files in after a start says so.
  if (!reply.ok() && absl::StrContains(reply.status().message(), "LOADING")) return GiveUp("it is starting");
  return reply;
}

absl::StatusOr<Reply> Redis::Run(const char* script, const std::vector<std::string>& arguments) {
  if (absl::Status status = Connect(); !status.ok()) return status;
  std::string& sha1 = loaded_[script];
  if (sha1.empty()) {
    auto loaded = Run({"SCRIPT", "LOAD", script});
    if (!loaded.ok()) return loaded;
    sha1 = loaded->text;
  }
  std::vector<std::string> words = {"EVALSHA", sha1, "0"};
  words.reserve(words.size() + arguments.size());
  words.insert(words.end(), arguments.begin(), arguments.end());
  return Run(words);
}

}  // namespace phrenic::cluster
