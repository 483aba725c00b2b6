// Soak test: clients connect, watch and disconnect, most without cancelling; the server's resources must not grow.
#include <grpcpp/create_channel.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "phrenic/v1/frames.grpc.pb.h"
#include "tests/faults/faults.h"

namespace phrenic::faults {
namespace {

constexpr int kSessions = 6, kWatchers = 3;  // per round; per session
constexpr int kFrames = 10;                  // that a viewer reads
constexpr char kScenes[][16] = {"cube-springs", "cube-tensegrity", "sheet-2d"};

// Resources of a server process.
struct Resources {
  double memory = 0, threads = 0, files = 0;  // resident [MB]
};

Resources ResourcesOf(const ServerProcess& server) {
  return {1e-6 * static_cast<double>(server.Memory()), static_cast<double>(server.Threads()),
          static_cast<double>(server.Files())};
}

// Reads some frames, then cancels the stream, or closes the connection without cancelling it.
void Watch(const ServerProcess& server, const std::string& session, bool cancel) {
  grpc::ClientContext context;
  const auto stub = v1::FrameService::NewStub(server.NewChannel());
  v1::WatchFramesRequest request;
  request.set_session_id(session);
  const auto reader = stub->WatchFrames(&context, request);
  v1::WatchFramesResponse response;
  for (int frames = 0; frames < kFrames && reader->Read(&response);) frames += response.has_frame() ? 1 : 0;
  if (!cancel) return;
  context.TryCancel();
  reader->Finish();
}

// Requests a page and disconnects without reading the response.
void RequestPage(const ServerProcess& server) {
  boost::asio::io_context io;
  boost::asio::ip::tcp::socket socket(io);
  boost::system::error_code error;
  socket.connect({boost::asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(server.web_port())}, error);
  boost::asio::write(socket, boost::asio::buffer(std::string("GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n")),
                     error);
}

bool Round(const ServerProcess& server) {
  const auto stub = v1::SessionService::NewStub(server.NewChannel());
  std::vector<std::string> ids;
  std::vector<std::thread> watchers;
  bool good = true;
  for (int i = 0; i < kSessions; ++i) {
    grpc::ClientContext creating, playing;
    v1::CreateSessionRequest create;
    create.mutable_source()->set_name(kScenes[i % std::size(kScenes)]);
    v1::CreateSessionResponse created;
    good = stub->CreateSession(&creating, create, &created).ok() && good;
    v1::PlaySessionRequest play;
    play.set_session_id(created.session().id());
    v1::PlaySessionResponse played;
    good = stub->PlaySession(&playing, play, &played).ok() && good;
    ids.push_back(created.session().id());
    for (int k = 0; k < kWatchers; ++k)
      watchers.emplace_back([&server, id = ids.back(), k] { Watch(server, id, k == 0); });
    RequestPage(server);
  }
  for (std::thread& watcher : watchers) watcher.join();
  for (const std::string& id : ids) {
    grpc::ClientContext deleting;
    v1::DeleteSessionRequest remove;
    remove.set_session_id(id);
    v1::DeleteSessionResponse removed;
    good = stub->DeleteSession(&deleting, remove, &removed).ok() && good;
  }
  return good;
}

// Returns the median of each resource.
Resources MedianOf(std::vector<Resources> all) {
  const auto median = [&](double Resources::*resource) {
    std::ranges::sort(all, {}, resource);
    return all[all.size() / 2].*resource;
  };
  return {median(&Resources::memory), median(&Resources::threads), median(&Resources::files)};
}

// True if the last third of the rounds uses no more than the second third; the first one fills pools and caches.
bool Flat(const std::vector<Resources>& rounds, std::string& note) {
  const auto third = static_cast<std::ptrdiff_t>(rounds.size() / 3);
  const Resources before = MedianOf({rounds.end() - 2 * third, rounds.end() - third});
  const Resources after = MedianOf({rounds.end() - third, rounds.end()});
  note = absl::StrFormat("memory %.1f -> %.1f MB, threads %.0f -> %.0f, files %.0f -> %.0f", before.memory,
                         after.memory, before.threads, after.threads, before.files, after.files);
  return after.memory <= 1.02 * before.memory + 2 && after.threads <= before.threads + 2 &&
         after.files <= before.files + 2;
}

}  // namespace

Tally ComingAndGoing(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  std::vector<Resources> rounds;
  for (int i = 0; i < std::max(6, times); ++i) {
    rig.Disturb([&] { tally.lost += Round(rig.server()) ? 0 : 1; });
    rig.Recover(tally);
    absl::SleepFor(absl::Milliseconds(200));
    rounds.push_back(ResourcesOf(rig.server()));
  }
  if (!Flat(rounds, tally.note)) ++tally.wrong;
  return tally;
}

}  // namespace phrenic::faults
