// Whether anybody listens at an address.
#ifndef PHRENIC_CLIENT_CONNECTION_REACHABLE_H_
#define PHRENIC_CLIENT_CONNECTION_REACHABLE_H_

#include <string>

namespace phrenic::client {

// Opens a connection to "HOST:PORT" and closes it, within two seconds; false for what is no address too.
bool IsReachable(const std::string& address);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_REACHABLE_H_
