#include "tests/bench/streaming/gateway_viewers.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

#include "absl/strings/str_cat.h"
#include "tests/bench/streaming/sockets.h"

namespace phrenic::bench {
namespace {

constexpr int kLook = 100;              // between two looks at whether to end [ms]
constexpr std::size_t kPrefix = 5;      // of a gRPC-web frame: flags, length
constexpr std::size_t kAtOnce = 64000;  // [bytes]

// A call of `method` as a browser makes it.
std::string Post(const std::string& method, const google::protobuf::Message& message) {
  const std::string body = message.SerializeAsString();
  std::string framed(kPrefix, '\0');
  for (int i = 0; i < 4; ++i) framed[1 + i] = static_cast<char>(body.size() >> (24 - 8 * i));
  framed += body;
  return absl::StrCat("POST /phrenic.v1.FrameService/", method,
                      " HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/grpc-web+proto\r\nContent-Length: ",
                      framed.size(), "\r\n\r\n", framed);
}

// Takes the answers' chunks, each a gRPC-web frame, out of what came.
class Chunks {
 public:
  void Append(std::string_view bytes) { held_.append(bytes); }

  // The next message; false where more bytes are needed. Trailers come as nothing.
  bool Next(std::string* message) {
    if (!headed_) {
      const std::size_t end = held_.find("\r\n\r\n");
      if (end == std::string::npos) return false;
      held_.erase(0, end + 4);
      headed_ = true;
    }
    const std::size_t line = held_.find("\r\n");
    if (line == std::string::npos) return false;
    const std::size_t size = std::stoul(held_.substr(0, line), nullptr, 16);
    if (held_.size() < line + 2 + size + 2) return false;
    const bool trailers = size < kPrefix || held_[line + 2] != 0;
    *message = trailers ? "" : held_.substr(line + 2 + kPrefix, size - kPrefix);
    held_.erase(0, line + 2 + size + 2);
    if (size == 0) headed_ = false;  // the answer is over: another head follows
    return true;
  }

 private:
  std::string held_;
  bool headed_ = false;
};

// Of one viewer, served by the one thread.
struct Page {
  Socket stream, acknowledging;
  Chunks frames, answers;
  v1::AckFramesRequest newest;
  int taken = 0, enough = 1;  // since the last acknowledgement, and for another
  bool asking = false;
};

class GatewayViewers final : public Viewers {
 public:
  GatewayViewers(int web_port, const Wanted& wanted) : Viewers(wanted.viewers), window_(wanted.window) {
    for (int i = 0; i < wanted.viewers; ++i) {
      Page& page = pages_.emplace_back();
      const v1::WatchFramesRequest request = RequestOf(wanted, i);
      page.newest.set_session_id(request.session_id());
      page.newest.set_watch_id(request.watch_id());
      page.stream = ConnectTo(web_port);
      page.acknowledging = ConnectTo(web_port);
      SendAll(page.stream, Post("WatchFrames", request));
    }
    thread_ = std::thread([this] { Serve(); });
  }

  ~GatewayViewers() override {
    stopped_ = true;
    thread_.join();
  }

 private:
  void Serve() {
    std::vector<pollfd> polled;
    for (const Page& page : pages_) {
      polled.push_back({.fd = page.stream.handle(), .events = POLLIN, .revents = 0});
      polled.push_back({.fd = page.acknowledging.handle(), .events = POLLIN, .revents = 0});
    }
    std::vector<char> bytes(kAtOnce);
    while (!stopped_) {
      poll(polled.data(), polled.size(), kLook);
      for (std::size_t i = 0; i < polled.size(); ++i) {
        if (polled[i].revents == 0) continue;
        const ssize_t got = recv(polled[i].fd, bytes.data(), bytes.size(), 0);
        if (got <= 0) polled[i].fd = -1;
        if (got <= 0) continue;
        Page& page = pages_[i / 2];
        (i % 2 == 0 ? page.frames : page.answers).Append({bytes.data(), static_cast<std::size_t>(got)});
        i % 2 == 0 ? TakeFrames(page) : TakeAnswers(page);
      }
    }
  }

  void TakeFrames(Page& page) {
    std::string message;
    v1::WatchFramesResponse event;
    while (page.frames.Next(&message)) {
      if (!event.ParseFromString(message) || !event.has_frame()) continue;
      const std::int64_t last = page.newest.sequence();
      seen().Add(event.frame(), static_cast<std::int64_t>(message.size()), last);
      if (last == 0) FirstCame();
      page.newest.set_sequence(event.frame().sequence());
      ++page.taken;
    }
    Tell(page);
  }

  void TakeAnswers(Page& page) {
    std::string message;
    v1::AckFramesResponse answer;
    while (page.answers.Next(&message)) {
      if (message.empty()) page.asking = false;
      if (message.empty() || !answer.ParseFromString(message)) continue;
      page.newest.set_basis_epoch(answer.basis_epoch());
      page.enough = std::max(1, answer.max_unacked_frames() / 2);
    }
    Tell(page);
  }

  // As the viewer in the browser: the newest alone, one call at a time, for half of those that may be on their way.
  void Tell(Page& page) {
    if (window_ == 0 || page.asking || page.taken < page.enough) return;
    page.taken = 0;
    page.asking = SendAll(page.acknowledging, Post("AckFrames", page.newest));
  }

  const int window_;
  std::vector<Page> pages_;
  std::atomic<bool> stopped_ = false;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<Viewers> WatchOverGateway(int web_port, const Wanted& wanted) {
  return std::make_unique<GatewayViewers>(web_port, wanted);
}

}  // namespace phrenic::bench
