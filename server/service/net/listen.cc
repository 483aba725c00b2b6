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
    return absl::UnavailableError(absl::StrCat(address, ": the host does not resolve to an address of this machine"));
  }
  return found.begin()->endpoint();
}

}  // namespace

absl::StatusOr<int> ListenOn(const std::string& address, tcp::acceptor& acceptor) {
  const auto endpoint = Resolve(address, acceptor);
  if (!endpoint.ok()) return endpoint.status();
  boost::system::error_code error;
  acceptor.open(endpoint->protocol(), error);
  if (!error)
    acceptor.set_option(boost::asio::socket_base::reuse_address(true), error);  // fails while another process listens
  if (!error) acceptor.bind(*endpoint, error);
  if (!error) acceptor.listen(boost::asio::socket_base::max_listen_connections, error);
  if (error) return CannotListen(address, error.message());
  return acceptor.local_endpoint(error).port();
}

void EnableKeepalive(tcp::socket& socket) {
  constexpr int kOn = 1, kProbes = 2;
  constexpr int kIdle = 9, kInterval = 3;    // [s]
  constexpr unsigned kUserTimeout = 15'000;  // [ms]
  const int handle = socket.native_handle();
  setsockopt(handle, SOL_SOCKET, SO_KEEPALIVE, &kOn, sizeof kOn);
  setsockopt(handle, IPPROTO_TCP, TCP_KEEPIDLE, &kIdle, sizeof kIdle);
  setsockopt(handle, IPPROTO_TCP, TCP_KEEPINTVL, &kInterval, sizeof kInterval);
  setsockopt(handle, IPPROTO_TCP, TCP_KEEPCNT, &kProbes, sizeof kProbes);
  setsockopt(handle, IPPROTO_TCP, TCP_USER_TIMEOUT, &kUserTimeout, sizeof kUserTimeout);
}

void RaiseFileLimit() {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace phrenic::service
