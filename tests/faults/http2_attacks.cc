// Attacks on the gRPC port: HTTP/2 frames that no correct client sends, or far more of them.
#include <algorithm>
#include <cmath>
#include <deque>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "phrenic/v1/frames.pb.h"
#include "tests/faults/attacks.h"

namespace phrenic::faults {
namespace {

constexpr char kWatchFrames[] = "/phrenic.v1.FrameService/WatchFrames";

// Reads until `streams` have ended, the connection ends, or for `seconds`.
void Await(Http2& connection, int streams, double seconds) {
  const absl::Time until = absl::Now() + absl::Seconds(seconds);
  while (connection.open() && connection.ended() < streams && absl::Now() < until) {
    connection.Read(0.1);
  }
}

// Holds what the attack has opened while healthy users go on.
void Hold(const Victim& victim, double seconds) {
  const absl::Time until = absl::Now() + absl::Seconds(seconds);
  while (victim.Continues() && absl::Now() < until) absl::SleepFor(absl::Milliseconds(20));
}

}  // namespace

Outcome IllegalMetadata(const Victim& victim, int times) {
  constexpr const char* kNames[] = {"authorization", "x-session-id", "x-control-token", "x-join",
                                    "x-request-id",  "grpc-timeout", "user-agent"};
  Outcome outcome;
  for (int i = 0; i < times && victim.Continues(); ++i) {
    Http2 connection(victim.port());
    const std::string odd(1, static_cast<char>(i % 2 == 0 ? 0x80 + i % 128 : i % 32));
    const bool in_name = i % 4 == 3;
    connection.Call(kGetServer, {{in_name ? "x-" + odd : kNames[i % std::size(kNames)], "a" + odd}}, "");
    Await(connection, 1, 2);
    ++outcome.tried;
    ++(connection.data_frames() == 0 ? outcome.refused : outcome.served);
  }
  return outcome;
}

Outcome RapidResets(const Victim& victim, int times) {
  constexpr int kBatch = 200;
  const std::string block = HeaderBlock(CallHeaders(kGetServer));
  Outcome outcome;
  int connections = 0;
  while (outcome.tried < times && victim.Continues()) {
    Http2 connection(victim.open_port(), victim.guarded());
    ++connections;
    std::uint32_t stream = 1;
    while (outcome.tried < times && victim.Continues() && connection.open() && stream < (1U << 30)) {
      std::string frames;
      for (int i = 0; i < kBatch; ++i, stream += 2) {
        frames += Frame(FrameType::kHeaders, kEndHeaders, stream, block);
        frames += Frame(FrameType::kReset, 0, stream, std::string("\0\0\0\x08", 4));
      }
      if (!connection.Send(frames)) break;
      connection.Read(0);
      outcome.tried += kBatch;
    }
    if (!connection.open()) absl::SleepFor(absl::Milliseconds(1));
    if (connections > 20'000) break;
  }
  outcome.refused = connections - 1;
  outcome.note = absl::StrCat(connections, " connections, all but the last one ended by the server");
  return outcome;
}

// All streams of one connection, each as far as the server's windows allow.
Outcome UnfinishedMessages(const Victim& victim, int times) {
  constexpr std::size_t kMessage = 16U << 20;
  const std::string bytes(1U << 18, 'x'), prefix = GrpcMessage(std::string(kMessage - 64, 'x')).substr(0, 5);
  Http2 connection(victim.open_port(), victim.guarded());
  std::vector<std::pair<std::uint32_t, std::size_t>> streams;  // with what is left to send
  for (int i = 0; i < times && connection.open(); ++i) {
    const std::uint32_t stream = connection.Open(CallHeaders("/phrenic.v1.UploadService/AddUploadChunk"));
    streams.emplace_back(stream, kMessage - 128);
    connection.SendData(stream, prefix);
  }
  const absl::Time until = absl::Now() + absl::Seconds(15);
  absl::Time taken = absl::Now();  // when the server last took something
  std::size_t sent = 0;
  while (connection.open() && victim.Continues() && absl::Now() < until && absl::Now() < taken + absl::Seconds(3)) {
    std::size_t now = 0;
    for (auto& [stream, left] : streams) {
      const std::size_t some =
          connection.SendData(stream, std::string_view(bytes).substr(0, std::min(left, bytes.size())));
      left -= some, now += some;
    }
    connection.Read(now > 0 ? 0 : 0.05);
    sent += now;
    if (now > 0) taken = absl::Now();
  }
  Outcome outcome;
  outcome.tried = times;
  outcome.refused = connection.open() ? connection.ended() : times;
  outcome.served = times - outcome.refused;
  outcome.note = absl::StrCat(sent >> 20, " MB were taken");
  return outcome;
}

// One value of 4 kB enters the table of headers, then each further byte repeats it.
Outcome HeaderBomb(const Victim& victim, int times) {
  constexpr int kRepeats = 16'000;
  Outcome outcome;
  for (int i = 0; i < times && victim.Continues(); ++i) {
    Http2 connection(victim.open_port(), victim.guarded());
    const std::string name = "x-bomb", value(3900, 'a');
    std::string block = HeaderBlock(CallHeaders(kGetServer));
    const std::string literal = HeaderBlock({{name, value}});
    block.push_back(0x40);  // a literal that enters the table
    block += literal.substr(1);
    block += std::string(kRepeats - block.size() % kRepeats, static_cast<char>(0x80 + 62));
    block.resize(16'384, static_cast<char>(0x80 + 62));
    connection.Send(Frame(FrameType::kHeaders, kEndHeaders | kEndStream, 1, block));
    Await(connection, 1, 3);
    ++outcome.tried;
    ++(connection.ended() > 0 || !connection.open() ? outcome.refused : outcome.served);
  }
  return outcome;
}

Outcome EndlessHeaders(const Victim& victim, int times) {
  constexpr int kFrames = 2'000;
  Outcome outcome;
  std::deque<Http2> held;
  const std::string more = HeaderBlock({{"x-more", std::string(16'000, 'a')}});
  for (int i = 0; i < times && victim.Continues(); ++i) {
    Http2& connection = held.emplace_back(victim.open_port(), victim.guarded());
    connection.Send(Frame(FrameType::kHeaders, 0, 1, HeaderBlock(CallHeaders(kGetServer))));
    bool taken = true;
    for (int f = 0; f < kFrames && taken; ++f) taken = connection.Send(Frame(FrameType::kContinuation, 0, 1, more));
    connection.Read(0);
    ++outcome.tried;
    ++(taken && connection.open() ? outcome.served : outcome.refused);
  }
  return outcome;
}

// Frames that the server must answer or count, from clients that read nothing.
Outcome ControlFrames(const Victim& victim, int times) {
  constexpr int kBatch = 500;
  const std::string frames[] = {Frame(FrameType::kPing, 0, 0, "12345678"),
                                Frame(FrameType::kSettings, 0, 0, ""),
                                Frame(FrameType::kData, 0, 1, ""),
                                Frame(FrameType::kWindow, 0, 0, std::string("\0\0\0\1", 4)),
                                Frame(FrameType::kPriority, 0, 1, std::string("\0\0\0\3\1", 5)),
                                Frame(static_cast<FrameType>(200), 0, 0, "xxxx")};
  Outcome outcome;
  std::deque<Http2> held;
  for (const std::string& frame : frames) {
    Http2& connection = held.emplace_back(victim.open_port(), victim.guarded());
    connection.Open(CallHeaders(kGetServer));
    std::string batch;
    for (int i = 0; i < kBatch; ++i) batch += frame;
    bool taken = true;
    for (int i = 0; i < times / static_cast<int>(std::size(frames)) && taken && victim.Continues(); i += kBatch) {
      taken = connection.Send(batch, false);
      outcome.tried += kBatch;
    }
    outcome.refused += taken ? 0 : 1;
  }
  outcome.note = absl::StrCat(outcome.refused, " of ", std::size(frames), " kinds were stopped");
  return outcome;
}

Outcome OddDeadlines(const Victim& victim, int times) {
  const std::string timeouts[] = {
      "0n", "1n", "99999999H", "00000000H", "-1S", "1e9S", "S", "", "999999999999999999999H", "1 S", "+1S", "1s"};
  Outcome outcome;
  std::deque<Http2> held;  // streams with far deadlines stay open until the end
  for (int i = 0; i < times && victim.Continues(); ++i) {
    Headers more = victim.As("healthy");
    more.emplace_back("grpc-timeout", timeouts[static_cast<std::size_t>(i) % std::size(timeouts)]);
    Http2& connection = held.size() > 20 ? held.front() : held.emplace_back(victim.port());
    v1::WatchFramesRequest request;
    request.set_session_id("nobodys");
    const std::string web =
        absl::StrCat("POST ", kGetServer, " HTTP/1.1\r\nHost: localhost:", victim.web_port(),
                     "\r\ngrpc-timeout: ", more.back().second,
                     "\r\ncontent-type: application/grpc-web+proto\r\ncontent-length: 5\r\n\r\n", std::string(5, '\0'));
    if (i % 2 == 0) {
      const int status = StatusOf(victim.web_port(), web);
      ++(status >= 100 && status < 400 ? outcome.served : outcome.refused);
    } else {
      const int before = connection.ended();
      connection.Call(kWatchFrames, more, request.SerializeAsString());
      Await(connection, before + 1, 1);
      ++(connection.ended() > before || !connection.open() ? outcome.refused : outcome.served);
    }
    ++outcome.tried;
    if (!held.empty() && !held.front().open()) held.pop_front();
  }
  return outcome;
}

Outcome IdleConnections(const Victim& victim, int times) {
  Outcome outcome;
  std::deque<RawConnection> held;
  for (int i = 0; i < times && victim.Continues(); ++i)
    held.emplace_back(i % 2 == 0 ? victim.open_port() : victim.guarded() ? victim.open_port() : victim.web_port());
  Hold(victim, 3);
  for (RawConnection& connection : held) {
    connection.Receive(0);
    ++(connection.open() ? outcome.served : outcome.refused);
  }
  outcome.tried = static_cast<int>(held.size());
  return outcome;
}

}  // namespace phrenic::faults
