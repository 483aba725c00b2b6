#include "client/connection/reachable.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <chrono>

#include "absl/strings/str_cat.h"
#include "server/service/net/address.h"

namespace phrenic::client {

bool IsReachable(const std::string& address) {
  constexpr std::chrono::seconds kMostWait(2);
  const auto parts = service::ParseAddress(address);
  if (!parts.ok()) return false;
  boost::asio::io_context io;
  boost::system::error_code error;
  const auto endpoints = boost::asio::ip::tcp::resolver(io).resolve(parts->host, absl::StrCat(parts->port), error);
  if (error) return false;
  bool reached = false;
  boost::beast::tcp_stream stream(io);
  stream.expires_after(kMostWait);
  stream.async_connect(endpoints, [&](const boost::system::error_code& refused, const auto&) { reached = !refused; });
  io.run();
  return reached;
}

}  // namespace phrenic::client
