// A Redis client for one connection, with a timeout on every command (hiredis, protocol RESP2).
#ifndef PHRENIC_SERVER_CLUSTER_REDIS_H_
#define PHRENIC_SERVER_CLUSTER_REDIS_H_

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/cluster/redis_tls_files.h"

struct redisContext;
struct redisReply;

namespace phrenic::cluster {

class RedisTls;

// Where Redis listens, and how this server identifies itself there.
struct RedisAddress {
  std::string host;
  int port = 6379;
  std::string password;  // empty: no AUTH
  bool encrypted = false;
  RedisTlsFiles tls = {};
};

// Parses "redis://HOST:PORT" or "redis://:PASSWORD@HOST:PORT", or rediss:// with TLS. INVALID_ARGUMENT, without the
// password, if it is not valid.
absl::StatusOr<RedisAddress> ParseRedisAddress(const std::string& url);

// A reply of Redis: nil, an integer, a string, or a list of replies.
struct Reply {
  bool nil = false;
  std::int64_t number = 0;
  std::string text;
  std::vector<Reply> list;
};

// Not thread-safe.
class Redis {
 public:
  // Connects at the first Run.
  explicit Redis(RedisAddress address);
  ~Redis();
  Redis(const Redis&) = delete;
  Redis& operator=(const Redis&) = delete;

  // Sends a command and returns the reply. Errors: UNAVAILABLE if Redis cannot be reached, does not answer within
  // kTimeout or is loading its data, after which the connection is closed and calls fail at once for kReconnectPause;
  // INTERNAL for an error reply.
  absl::StatusOr<Reply> Run(const std::vector<std::string>& words);
  // Runs a Lua script by EVALSHA; the text is sent once per connection. `script` must be a constant with static
  // storage.
  absl::StatusOr<Reply> Run(const char* script, const std::vector<std::string>& arguments);
  // Returns the number of connections made so far; a change means that Redis may have restarted.
  int connections() const { return connections_; }

  // Of connecting, and of each command: callers wait no longer, so that calls of clients fail in time.
  static constexpr absl::Duration kTimeout = absl::Milliseconds(400);
  // After a failure, so that a Redis that is down costs each caller no timeout.
  static constexpr absl::Duration kReconnectPause = absl::Milliseconds(500);

 private:
  struct Free {
    void operator()(redisContext* context) const;
  };
  // Connects, with TLS if `encrypted`, and authenticates. UNAVAILABLE.
  absl::Status Connect();
  // Closes the connection and returns UNAVAILABLE.
  absl::Status Disconnect(const std::string& why);
  // Performs the handshake of TLS on the connection's socket. The errors of RedisTls::Connect.
  absl::Status ConnectTls();
  // Sends a command and waits for the reply; null if the connection fails.
  redisReply* Exchange(std::vector<const char*>& texts, std::vector<std::size_t>& sizes);
  // Connects if needed, sends a command and copies the reply. The errors of Run.
  absl::StatusOr<Reply> Send(const std::vector<std::string>& words);

  const RedisAddress address_;
  std::unique_ptr<redisContext, Free> context_;
  std::unique_ptr<RedisTls> tls_;                   // on context_'s socket; null without TLS
  std::map<const char*, std::string> script_sha1_;  // of the scripts loaded on this connection
  absl::Time retry_at_ = absl::InfinitePast();
  int connections_ = 0;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_SERVER_CLUSTER_REDIS_H_
