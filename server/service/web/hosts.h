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

// Returns the host of "HOST" or "HOST:PORT" in lower case, IPv6 without brackets; nullopt if the text is not valid. An
// IPv4-mapped IPv6 address is given as IPv4. Names have up to 255 letters, digits, ".", "-" and "_"; a port has at most
// 5 digits. An address with a zone ("%eth0") is not valid. Pure function, thread-safe.
std::optional<std::string> HostOf(std::string_view text);

// Immutable, thread-safe. The gateway has one, which its connections share.
class AllowedHosts {
 public:
  // `names` are hosts, with or without a port. `origins` are web origins such as "https://example.org:8443". `listen`
  // is the address listened on; its host is allowed. A wildcard to listen on, such as 0.0.0.0, is left out, since it is
  // no host that a client asks for; so is text that is not valid, which CheckOptions refuses before in `names`.
  AllowedHosts(const std::vector<std::string>& names, const std::vector<std::string>& origins,
               const std::string& listen);

  // True for localhost, 127.0.0.1 and ::1, the hosts given to the constructor, the address that the client connected to
  // (`local`, as text), and the names in the server's certificate (null: none); with any port. False if `host` is not
  // valid. The certificate is read and not kept.
  bool Allow(std::string_view host, const boost::asio::ip::address& local, X509* certificate) const;

 private:
  // Adds the host of "HOST" or "HOST:PORT", if it is one.
  void Add(std::string_view text);

  std::set<std::string> names_;  // in the form of HostOf
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_HOSTS_H_
