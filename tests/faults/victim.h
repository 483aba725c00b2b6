// A server under attack, and what healthy users see of it meanwhile: a viewer of a playing thorax, and a caller.
#ifndef PHRENIC_TESTS_FAULTS_VICTIM_H_
#define PHRENIC_TESTS_FAULTS_VICTIM_H_

#include <grpcpp/client_context.h>

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "tests/faults/guard.h"
#include "tests/faults/raw.h"
#include "tests/support/server_process.h"

namespace phrenic::faults {

// What healthy users and the machine see during an attack.
struct Damage {
  double gap = 0;                               // largest time between two frames of the healthy viewer [s]
  double wait = 0;                              // longest time until a healthy call is answered [s]
  double before = 0, peak = 0, afterwards = 0;  // resident memory [MB]; afterwards: at most 10 s later
  bool died = false;
};

// A server with the accounts "healthy", "greedy" and "thief", each of the role owner. "healthy" watches a session of
// its own, `kWatched`, and calls again and again on new connections. Ends the server if it needs more than 6 GB, to
// protect the machine. Any thread may call the methods that are const.
class Victim {
 public:
  static constexpr char kWatched[] = "healthy-session";

  // Empties `folder`. `open`: behind deploy/guard if that can be started, as a server that other machines reach. Check
  // ready().
  Victim(const std::string& folder, std::vector<std::string> flags, bool open);
  ~Victim();
  Victim(const Victim&) = delete;
  Victim& operator=(const Victim&) = delete;

  bool ready() const { return problem_.empty(); }
  const std::string& problem() const { return problem_; }

  // Ports of the server, on loopback.
  int port() const { return server_->port(); }
  int web_port() const { return server_->web_port(); }
  // The port that is open to others, and whether it is encrypted; the server's gRPC port without a guard.
  bool guarded() const { return guard_ != nullptr && guard_->running(); }
  int open_port() const { return guarded() ? guard_->port() : port(); }
  std::shared_ptr<grpc::Channel> NewChannel() const { return server_->NewChannel(); }
  bool alive() const { return alive_; }
  // False if the server has ended or the attack has taken its time, so that an attack ends early.
  bool Continues() const;

  // Returns the header with an account's token; none if `name` is empty.
  Headers As(const std::string& name) const;
  // Signs a call, and gives it a deadline of five seconds.
  void Sign(const std::string& name, grpc::ClientContext& context, double seconds = 5) const;

  // Starts to measure.
  void Begin();
  // Waits until a call is answered and memory is back, or for 20 s and 10 s. Returns what happened since Begin.
  Damage End();

 private:
  void AddAccounts(const std::string& file);
  bool StartSession();
  void Watch();
  void CallAgainAndAgain();
  void GuardMemory();
  double Memory() const { return 1e-6 * static_cast<double>(server_->Memory()); }

  std::map<std::string, std::string> tokens_;
  std::unique_ptr<ServerProcess> server_;
  std::unique_ptr<Guard> guard_;
  std::string problem_;
  std::atomic<bool> alive_ = true, ends_ = false;
  std::atomic<double> began_ = 0, last_frame_ = 0, last_answer_ = 0, gap_ = 0, wait_ = 0;
  double before_ = 0;
  absl::Mutex mutex_;
  grpc::ClientContext* watching_ ABSL_GUARDED_BY(mutex_) = nullptr;
  std::vector<std::thread> threads_;
};

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_VICTIM_H_
