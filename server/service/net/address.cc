#include "server/service/net/address.h"

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <boost/asio/ip/address.hpp>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"

namespace phrenic::service {

absl::StatusOr<Address> ParseAddress(const std::string& text) {
  const std::size_t colon = text.find_last_of(':');
  Address address;
  int port = -1;
  if (colon != std::string::npos && colon > 0 && absl::SimpleAtoi(text.substr(colon + 1), &port) && port >= 0 &&
      port <= 65535) {
    address = {text.substr(0, colon), port};
    const bool bracketed = address.host.front() == '[' && address.host.back() == ']';
    if (bracketed) address.host = address.host.substr(1, address.host.size() - 2);
    if (!address.host.empty() && (bracketed || !absl::StrContains(address.host, ":"))) return address;
  }
  return absl::InvalidArgumentError(absl::StrCat(
      "\"", text, "\" is not an address: use HOST:PORT, such as 127.0.0.1:8080, or port 0 for any free port"));
}

bool IsLoopback(const Address& address) {
  boost::system::error_code error;
  const auto number = boost::asio::ip::make_address(address.host, error);
  return error ? address.host == "localhost" : number.is_loopback();
}

absl::Status CannotListen(const std::string& address, const std::string& why) {
  return absl::UnavailableError(
      absl::StrCat("cannot listen on ", address, ": ", why, "; choose another port, or stop the program that uses it"));
}

}  // namespace phrenic::service
