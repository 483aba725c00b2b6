#include "server/cluster/redis.h"

#include <hiredis/hiredis.h>

#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "server/cluster/redis_tls.h"

namespace phrenic::cluster {
namespace {

constexpr char kScheme[] = "redis://", kTlsScheme[] = "rediss://";
constexpr int kMaxPort = 65535;

absl::Status BadAddress(const char* what) {
  return absl::InvalidArgumentError(
      absl::StrCat("--cluster: ", what, "; write redis://HOST:PORT, or redis://:PASSWORD@HOST:PORT"));
}

Reply Read(const redisReply& from) {
  Reply reply;
  reply.nil = from.type == REDIS_REPLY_NIL;
  reply.number = from.type == REDIS_REPLY_INTEGER ? from.integer : 0;
  if (from.str != nullptr) reply.text.assign(from.str, from.len);
  if (from.type != REDIS_REPLY_ARRAY) return reply;
  reply.list.reserve(from.elements);
  for (std::size_t i = 0; i < from.elements; ++i) reply.list.push_back(Read(*from.element[i]));
  return reply;
}

}  // namespace

absl::StatusOr<RedisAddress> ParseRedisAddress(const std::string& url) {
  RedisAddress address;
  address.encrypted = absl::StartsWith(url, kTlsScheme);
  if (!address.encrypted && !absl::StartsWith(url, kScheme)) {
    return BadAddress("the address does not begin with redis:// or rediss://");
  }
  std::string rest = url.substr((address.encrypted ? sizeof kTlsScheme : sizeof kScheme) - 1);
  if (const std::size_t at = rest.rfind('@'); at != std::string::npos) {
    if (rest.empty() || rest[0] != ':') return BadAddress("a password must be between \":\" and \"@\"");
    address.password = rest.substr(1, at - 1);
    rest = rest.substr(at + 1);
  }
  const std::size_t colon = rest.rfind(':');
  address.host = rest.substr(0, colon);
  if (address.host.empty()) return BadAddress("the host is missing");
  if (colon == std::string::npos) return address;
  const bool valid =
      absl::SimpleAtoi(rest.substr(colon + 1), &address.port) && address.port > 0 && address.port <= kMaxPort;
  return valid ? absl::StatusOr<RedisAddress>(address) : BadAddress("the port must be 1 to 65535");
}

void Redis::Free::operator()(redisContext* context) const { redisFree(context); }

Redis::Redis(RedisAddress address) : address_(std::move(address)) {}

Redis::~Redis() = default;

absl::Status Redis::Disconnect(const std::string& why) {
  tls_.reset();
  context_.reset();
  script_sha1_.clear();
  retry_at_ = absl::Now() + kReconnectPause;
  return absl::UnavailableError(
      absl::StrCat("Redis at ", address_.host, ":", address_.port, " cannot be reached (", why, "); start Redis"));
}

absl::Status Redis::Connect() {
  if (context_ != nullptr) return absl::OkStatus();
  if (absl::Now() < retry_at_) {
    return absl::UnavailableError(absl::StrCat("Redis at ", address_.host, ":", address_.port,
                                               " could not be reached a moment ago; start Redis"));
  }
  const timeval timeout = absl::ToTimeval(kTimeout);
  context_.reset(redisConnectWithTimeout(address_.host.c_str(), address_.port, timeout));
  if (context_ == nullptr) return Disconnect("no memory");
  if (context_->err != 0) return Disconnect(std::string(context_->errstr));
  redisSetTimeout(context_.get(), timeout);
  redisEnableKeepAlive(context_.get());
  if (address_.encrypted) {
    if (absl::Status status = ConnectTls(); !status.ok()) return status;
  }
  if (!address_.password.empty()) {
    const auto authenticated = Send({"AUTH", address_.password});
    if (!authenticated.ok()) return Disconnect(std::string(authenticated.status().message()));
  }
  ++connections_;
  return absl::OkStatus();
}

absl::Status Redis::ConnectTls() {
  auto tls = RedisTls::Connect(context_->fd, address_.host, address_.tls);
  if (!tls.ok()) return Disconnect(std::string(tls.status().message()));
  tls_ = *std::move(tls);
  return absl::OkStatus();
}

redisReply* Redis::Exchange(std::vector<const char*>& texts, std::vector<std::size_t>& sizes) {
  const int words = static_cast<int>(texts.size());
  if (tls_ == nullptr) {
    return static_cast<redisReply*>(redisCommandArgv(context_.get(), words, texts.data(), sizes.data()));
  }
  return tls_->Exchange(*context_->reader, words, texts.data(), sizes.data());
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
  const std::unique_ptr<redisReply, void (*)(void*)> reply(Exchange(texts, sizes), &freeReplyObject);
  if (reply == nullptr) return Disconnect(tls_ == nullptr ? std::string(context_->errstr) : "the TLS connection ended");
  if (reply->type == REDIS_REPLY_ERROR) return absl::InternalError(std::string(reply->str, reply->len));
  return Read(*reply);
}

absl::StatusOr<Reply> Redis::Run(const std::vector<std::string>& words) {
  if (absl::Status status = Connect(); !status.ok()) return status;
  auto reply = Send(words);
  // Redis answers LOADING while it reads its data after a start.
  if (!reply.ok() && absl::StrContains(reply.status().message(), "LOADING"))
    return Disconnect("it is loading its data");
  return reply;
}

absl::StatusOr<Reply> Redis::Run(const char* script, const std::vector<std::string>& arguments) {
  if (absl::Status status = Connect(); !status.ok()) return status;
  std::string& sha1 = script_sha1_[script];
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
