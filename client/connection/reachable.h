// Whether a program listens at an address.
#ifndef PHRENIC_CLIENT_CONNECTION_REACHABLE_H_
#define PHRENIC_CLIENT_CONNECTION_REACHABLE_H_

#include <string>

namespace phrenic::client {

// Opens and closes a TCP connection to "HOST:PORT". Returns false after two seconds, or if the address is invalid.
bool IsReachable(const std::string& address);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_REACHABLE_H_
