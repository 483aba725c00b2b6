// "HOST:PORT" as people write it.
#ifndef PHRENIC_SERVER_SERVICE_NET_ADDRESS_H_
#define PHRENIC_SERVER_SERVICE_NET_ADDRESS_H_

#include <string>

#include "absl/status/statusor.h"

namespace phrenic::service {

struct Address {
  std::string host;  // without the brackets of "[::1]:8080"
  int port = 0;
};

// INVALID_ARGUMENT tells what an address looks like.
absl::StatusOr<Address> ParseAddress(const std::string& text);

// Whether only this machine can reach it: "127.0.0.1", "::1", "localhost".
bool IsLoopback(const Address& address);

// UNAVAILABLE "cannot listen on 127.0.0.1:8080: Address already in use; choose another port, or stop what uses it".
absl::Status CannotListen(const std::string& address, const std::string& why);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_ADDRESS_H_
