// The parts of the table. Each prints its rows, and returns false where viewers got nothing at all.
#ifndef PHRENIC_TESTS_BENCH_STREAMING_PARTS_H_
#define PHRENIC_TESTS_BENCH_STREAMING_PARTS_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "tests/bench/streaming/viewers.h"
#include "tests/support/server_process.h"

namespace phrenic::bench {

struct Settings {
  std::string scene = "thorax";
  double seconds = 4;
  std::vector<int> viewers = {1, 10, 100, 500};
  bool web_alone = false;  // of the fan-out's rows, those of gRPC-web
  std::string program;     // the phrenicd that runs; empty: this build's
};

// The server with a session that plays.
class Bench {
 public:
  static absl::StatusOr<std::unique_ptr<Bench>> Start(const Settings& settings);

  const Settings& settings() const { return settings_; }
  const ServerProcess& server() const { return *server_; }
  // `speed` 0: as fast as the machine can.
  void Play(double speed);
  v1::Session Session();
  void Sleep(double seconds) const;

 private:
  Bench(const Settings& settings, std::unique_ptr<ServerProcess> server);
  const Settings settings_;
  const std::unique_ptr<ServerProcess> server_;
  const std::unique_ptr<v1::SessionService::Stub> sessions_;
};

// What a while of watching took.
struct Cost {
  double wall = 0, sending = 0, stepping = 0;  // [s]: CPU of all threads but the stepping one, and of that one
};

// The seen frames of that while, and the cost.
Sight Watch(Bench& bench, Viewers& viewers, double seconds, Cost* cost);

// "met" or "MISSED", and the aim.
std::string Verdict(bool met, const std::string& aim);

bool FanOut(Bench& bench);
bool Stalled(Bench& bench);
bool Lines(Bench& bench);
bool Stepping(Bench& bench);

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_STREAMING_PARTS_H_
