// Attacks on the web port: HTTP/1.1.
#include <deque>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/time/clock.h"
#include "tests/faults/attacks.h"

namespace phrenic::faults {
namespace {

std::string Lines(const Headers& headers) {
  std::string text;
  for (const auto& [name, value] : headers) absl::StrAppend(&text, name, ": ", value, "\r\n");
  return text;
}

// Returns a gRPC-web call with an empty request.
std::string WebCall(const std::string& path, const std::string& host, const Headers& more) {
  return absl::StrCat("POST ", path, " HTTP/1.1\r\n", host, Lines(more),
                      "content-type: application/grpc-web+proto\r\ncontent-length: 5\r\n\r\n", std::string(5, '\0'));
}

std::string HostLine(int port) { return absl::StrCat("Host: localhost:", port, "\r\n"); }

void CountStatus(int status, Outcome& outcome) {
  if (status == 0) absl::SleepFor(absl::Milliseconds(15));  // so that the end of the server is seen
  ++outcome.tried;
  ++(status >= 100 && status < 400 ? outcome.served : outcome.refused);
}

}  // namespace

// Every byte that RFC 9110 does not allow, in values of headers that reach gRPC, and in their names.
Outcome IllegalHeaders(const Victim& victim, int times) {
  constexpr const char* kNames[] = {"authorization", "x-session-id", "x-control-token", "x-join", "x-request-id"};
  Outcome outcome;
  for (int i = 0; i < times && victim.Continues(); ++i) {
    const char byte = static_cast<char>(i % 3 == 0   ? 0x80 + i % 128
                                        : i % 3 == 1 ? 1 + i % 31
                                        : i % 2 == 0 ? '\t'
                                                     : 0x7f);
    const std::string odd(1, byte), name = kNames[i % std::size(kNames)];
    const Headers headers =
        i % 4 == 3 ? Headers{{absl::StrCat("x-", odd, "a"), "1"}} : Headers{{name, absl::StrCat("a", odd, "b")}};
    CountStatus(StatusOf(victim.web_port(), WebCall(kGetServer, HostLine(victim.web_port()), headers)), outcome);
  }
  return outcome;
}

// Each sends all but the last byte and waits.
Outcome LargeBodies(const Victim& victim, int times) {
  constexpr std::size_t kBody = 31U << 20, kPiece = 1U << 18;
  const std::string piece(kPiece, 'x');
  const std::string head =
      absl::StrCat("POST /phrenic.v1.UploadService/AddUploadChunk HTTP/1.1\r\n", HostLine(victim.web_port()),
                   "content-type: application/grpc-web+proto\r\ncontent-length: ", kBody, "\r\n\r\n",
                   GrpcMessage(std::string(kBody - 5, 'x')).substr(0, 5));
  Outcome outcome;
  std::deque<RawConnection> held;
  for (int i = 0; i < times && victim.Continues(); ++i) {
    RawConnection& connection = held.emplace_back(victim.web_port());
    bool taken = connection.Send(head);
    for (std::size_t sent = 5; taken && sent + kPiece < kBody; sent += kPiece) taken = connection.Send(piece);
    ++outcome.tried;
    ++(taken && connection.Receive(0).empty() ? outcome.served : outcome.refused);
  }
  absl::SleepFor(absl::Seconds(1));
  return outcome;
}

Outcome SlowHeads(const Victim& victim, int times) {
  const std::string request = absl::StrCat("GET / HTTP/1.1\r\n", HostLine(victim.web_port()), "x-slow: ");
  Outcome outcome;
  std::deque<RawConnection> held;
  for (int i = 0; i < times && victim.Continues(); ++i) held.emplace_back(victim.web_port());
  for (std::size_t at = 0; at < 60 && victim.Continues(); ++at) {
    const std::string byte = at < request.size() ? request.substr(at, 1) : "a";
    for (RawConnection& connection : held) connection.Send(byte);
    absl::SleepFor(absl::Milliseconds(50));
  }
  for (const RawConnection& connection : held) ++(connection.open() ? outcome.served : outcome.refused);
  outcome.tried = static_cast<int>(held.size());
  return outcome;
}

// What a page of another site can send after its name was pointed at this machine, and ambiguous requests.
Outcome ForeignHosts(const Victim& victim, int times) {
  const Headers signed_in = victim.As("healthy");
  const std::string own = HostLine(victim.web_port()), evil = "Host: evil.example\r\n";
  const std::string list = "/phrenic.v1.SessionService/ListSessions", get = "GET /healthz HTTP/1.1\r\n";
  Headers foreign = signed_in, chunked = signed_in;
  foreign.emplace_back("origin", "http://evil.example");
  const std::string requests[] = {
      absl::StrCat(get, evil, "\r\n"),
      absl::StrCat(get, "Host: evil.example:", victim.web_port(), "\r\n\r\n"),
      absl::StrCat(get, "Host: localhost.evil.example\r\n\r\n"),
      absl::StrCat(get, "Host: 127.0.0.1.evil.example\r\n\r\n"),
      absl::StrCat(get, "Host: localhost@evil.example\r\n\r\n"),
      absl::StrCat(get, "\r\n"),
      absl::StrCat(get, own, own, "\r\n"),
      absl::StrCat(get, own, evil, "\r\n"),
      absl::StrCat("GET http://evil.example/healthz HTTP/1.1\r\n", own, "\r\n"),
      absl::StrCat(get, own, "Transfer-Encoding: gzip\r\n\r\n"),
      absl::StrCat(get, own, "Transfer-Encoding: chunked, identity\r\n\r\n"),
      absl::StrCat(get, own, "Transfer-Encoding: chunked\r\nContent-Length: 3\r\n\r\n0\r\n\r\n"),
      absl::StrCat(get, own, "Content-Length: 3\r\nContent-Length: 4\r\n\r\nabcd"),
      WebCall(list, evil, foreign),
      WebCall(list, own, foreign),
      WebCall(list, evil, signed_in),
      WebCall(list, "", signed_in),
      WebCall(list, own + own, signed_in),
  };
  Outcome outcome;
  std::set<std::size_t> served;
  for (int i = 0; i < times && victim.Continues(); ++i) {
    const std::string& request = requests[static_cast<std::size_t>(i) % std::size(requests)];
    const int status = StatusOf(victim.web_port(), request);
    CountStatus(status, outcome);
    if (status >= 100 && status < 400) served.insert(static_cast<std::size_t>(i) % std::size(requests));
  }
  if (served.empty()) return outcome;
  outcome.broken.push_back(
      absl::StrCat(served.size(), " of ", std::size(requests), " foreign or ambiguous requests were served"));
  outcome.note = absl::StrCat("served: ", absl::StrJoin(served, ", "));
  return outcome;
}

Outcome Upgrades(const Victim& victim, int times) {
  const std::string own = HostLine(victim.web_port());
  const std::string requests[] = {
      absl::StrCat("GET / HTTP/1.1\r\n", own,
                   "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n",
                   "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"),
      absl::StrCat("GET / HTTP/1.1\r\n", own,
                   "Connection: Upgrade, HTTP2-Settings\r\nUpgrade: h2c\r\nHTTP2-Settings: AAMAAABkAAQAAP__\r\n\r\n"),
      absl::StrCat("GET / HTTP/1.1\r\n", own, "Connection: Upgrade\r\nUpgrade: ", std::string(7000, 'x'), "\r\n\r\n"),
      absl::StrCat("CONNECT evil.example:443 HTTP/1.1\r\n", own, "\r\n"),
      absl::StrCat("TRACE / HTTP/1.1\r\n", own, "\r\n"),
      absl::StrCat("PUT /index.html HTTP/1.1\r\n", own, "content-length: 4\r\n\r\nabcd"),
      absl::StrCat("POST ", kGetServer, " HTTP/1.1\r\n", own, "expect: 200-maybe\r\ncontent-length: 5\r\n\r\n",
                   std::string(5, '\0')),
      "GET /\r\n",
      "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
      std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11) + std::string(500, 'x'),
  };
  Outcome outcome;
  for (int i = 0; i < times && victim.Continues(); ++i) {
    const int port = i % 2 == 0 ? victim.web_port() : victim.port();
    const std::size_t request = static_cast<std::size_t>(i / 2) % std::size(requests);
    RawConnection(port).Send(requests[request]);
    if (i >= 2 * static_cast<int>(std::size(requests))) continue;  // once with its answer, then only sent
    const int status = StatusOf(port, requests[request]);
    CountStatus(status, outcome);
    if (status == 101) outcome.broken.push_back(absl::StrCat("upgrade ", request, " was accepted"));
  }
  outcome.tried = times;
  return outcome;
}

}  // namespace phrenic::faults
