#include "server/service/net/listen.h"

#include <netinet/tcp.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include "absl/strings/str_cat.h"
#include "server/service/net/address.h"

namespace phrenic::service {
namespace {

using boost::asio::ip::tcp;

absl::StatusOr<tcp::endpoint> Resolve(const std::string& address, tcp::acceptor& acceptor) {
  const absl::StatusOr<Address> parts = ParseAddress(address);
  if (!parts.ok()) return parts.status();
  tcp::resolver resolver(acceptor.get_executor());
  boost::system::error_code error;
  const auto found = resolver.resolve(parts->host, absl::StrCat(parts->port), tcp::resolver::passive, error);
  if (error || found.empty()) {
    return absl::UnavailableError(absl::StrCat(address, ": there is no such address on this machine"));
  }
  return found.begin()->endpoint();
}

}  // namespace

absl::StatusOr<int> ListenOn(const std::string& address, tcp::acceptor& acceptor) {
  const auto endpoint = Resolve(address, acceptor);
  if (!endpoint.ok()) return endpoint.status();
  boost::system::error_code error;
  acceptor.open(endpoint->protocol(), error);
  if (!error) acceptor.set_option(boost::asio::socket_base::reuse_address(true), error);  // not while another listens
  if (!error) acceptor.bind(*endpoint, error);
  if (!error) acceptor.listen(boost::asio::socket_base::max_listen_connections, error);
  if (error) return CannotListen(address, error.message());
  return acceptor.local_endpoint(error).port();
}

void EnableKeepalive(tcp::socket& socket) {
  constexpr int kOn = 1, kQuiet = 9, kBetween = 3, kProbes = 2;  // [s], [s]
  constexpr unsigned kUnanswered = 15'000;                       // [ms]
  const int handle = socket.native_handle();
  setsockopt(handle, SOL_SOCKET, SO_KEEPALIVE, &kOn, sizeof kOn);
  setsockopt(handle, IPPROTO_TCP, TCP_KEEPIDLE, &kQuiet, sizeof kQuiet);
  setsockopt(handle, IPPROTO_TCP, TCP_KEEPINTVL, &kBetween, sizeof kBetween);
  setsockopt(handle, IPPROTO_TCP, TCP_KEEPCNT, &kProbes, sizeof kProbes);
  setsockopt(handle, IPPROTO_TCP, TCP_USER_TIMEOUT, &kUnanswered, sizeof kUnanswered);
}

void AllowManyFiles() {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace phrenic::service
