// Decides which Host headers (RFC 9110 section 7.2) the server answers to. A page of another site whose name suddenly
// resolves to this machine (DNS rebinding) sends its own name there, so that only names that were said are answered.
#ifndef PHRENIC_SERVER_SERVICE_WEB_HOSTS_H_
#define PHRENIC_SERVER_SERVICE_WEB_HOSTS_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <openssl/x509.h>

#include <boost/asio/ip/address.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace phrenic::service {

// Returns the host of "HOST" or "HOST:PORT" in lower case, IPv6 without brackets; nullopt if the text is not valid.
std::optional<std::string> HostOf(std::string_view text);

// Immutable, thread-safe.
class AllowedHosts {
 public:
  // `names` are hosts, with or without a port. `origins` are web origins such as "https://example.org:8443". `listen`
  // is the address listened on; its host is allowed.
  AllowedHosts(const std::vector<std::string>& names, const std::vector<std::string>& origins,
               const std::string& listen);

  // True for localhost, 127.0.0.1 and ::1, the hosts given to the constructor, the address that the client connected to
  // (`local`, as text), and the names in the server's certificate (null: none); with any port.
  bool Allow(std::string_view host, const boost::asio::ip::address& local, X509* certificate) const;

 private:
  void Add(std::string_view text);

  std::set<std::string> names_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_HOSTS_H_
