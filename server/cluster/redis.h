// Redis, as far as it is needed: commands one after the other over one connection, each within a time.
#ifndef PHRENIC_SERVER_CLUSTER_REDIS_H_
#define PHRENIC_SERVER_CLUSTER_REDIS_H_

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"

struct redisContext;
struct redisReply;

namespace phrenic::cluster {

// Where Redis is.
struct RedisAddress {
  std::string host;
  int port = 6379;
  std::string password;  // empty: none
};

// "redis://HOST:PORT" or "redis://:PASSWORD@HOST:PORT". INVALID_ARGUMENT names what is wrong, without the password.
absl::StatusOr<RedisAddress> ParseRedisAddress(const std::string& url);

// What Redis answered: nothing, a number, text, or a list of these.
struct Reply {
  bool nothing = false;
  std::int64_t number = 0;
  std::string text;
  std::vector<Reply> list;
};

// Of one thread at a time.
class Redis {
 public:
  // Nothing is sent yet.
  explicit Redis(RedisAddress address);
  ~Redis();
  Redis(const Redis&) = delete;
  Redis& operator=(const Redis&) = delete;

  // Connects first where there is no connection. UNAVAILABLE where Redis cannot be reached or does not answer within
  // kPatience: the connection is given up then, and for kPause every call fails at once. INTERNAL for what it refused.
  absl::StatusOr<Reply> Run(const std::vector<std::string>& words);
  // A script of Lua, a constant, whose text is sent once a connection.
  absl::StatusOr<Reply> Run(const char* script, const std::vector<std::string>& arguments);
  // Grows with every connection that was made.
  int connections() const { return connections_; }

  static constexpr absl::Duration kPatience = absl::Milliseconds(400);
  static constexpr absl::Duration kPause = absl::Milliseconds(500);

 private:
  struct Free {
    void operator()(redisContext* context) const;
  };
  absl::Status Connect();
  absl::Status GiveUp(const std::string& why);
  absl::StatusOr<Reply> Send(const std::vector<std::string>& words);

  const RedisAddress address_;
  std::unique_ptr<redisContext, Free> context_;
  std::map<const char*, std::string> loaded_;  // of this connection: the name that Redis gave to a script
  absl::Time again_ = absl::InfinitePast();
  int connections_ = 0;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_SERVER_CLUSTER_REDIS_H_
