#include "tests/faults/rig.h"

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "absl/time/clock.h"

namespace phrenic::faults {
namespace {

constexpr double kMostRecovery = 30;  // [s]
constexpr double kLookEvery = 0.2;    // at whether the server has ended [s]

double Now() { return absl::ToDoubleSeconds(absl::Now() - absl::UnixEpoch()); }

}  // namespace

Rig::Rig(Oracle& oracle, const std::string& folder, std::vector<std::string> environment)
    : store_(folder + "/store"), driver_(oracle) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  server_ = std::make_unique<ServerProcess>(folder + "/log", std::vector<std::string>{"--store", store_},
                                            std::move(environment));
  if (absl::Status status = server_->Start(); !status.ok()) std::fprintf(stderr, "%s\n", status.ToString().c_str());
  if (driver_.Connect(server_->address(), true)) return;
  std::fprintf(stderr, "the session could not be created: %s\n", driver_.error().c_str());
}

void Rig::StepSome(int steps) {
  for (int i = 0; i < steps; ++i) driver_.Step();
}

void Rig::Disturb(const std::function<void()>& fault) {
  std::atomic<bool> stop = false;
  std::thread client([&] {
    while (!stop) driver_.Step();
  });
  absl::SleepFor(absl::Seconds(Wait(0.06)));
  disturbed_ = Now();
  fault();
  stop = true;
  client.join();
}

// A call may fail on a busy machine or a slow line without a session being lost; the table states the time it takes.
bool Rig::StepsAgain() {
  const double until = Now() + kMostRecovery;
  do {
    if (driver_.Step()) return true;
  } while (Now() < until);
  return false;
}

// The server may still be ending when the fault returns: its sockets close before the process has ended.
absl::StatusOr<bool> Rig::FindSession() {
  const double until = Now() + kMostRecovery;
  bool restarted = false;
  do {
    if (!restarted && !server_->running()) {
      if (absl::Status status = server_->Start(); !status.ok()) return status;
      restarted = true;
      driver_.Connect(server_->address());
    }
    const double asked = Now();
    if (driver_.FindTick(kLookEvery).has_value()) return true;
    if (Now() - asked < kLookEvery) return false;  // the server answers that it has no such session
  } while (Now() < until);
  return false;
}

void Rig::Recover(Tally& tally) {
  ++tally.tried;
  driver_.Connect(server_->address());
  const absl::StatusOr<bool> found = FindSession();
  if (!found.ok()) {
    std::fprintf(stderr, "the server does not restart: %s\n", found.status().ToString().c_str());
    ++tally.lost;
    return;
  }
  const bool steps = *found && StepsAgain();
  tally.recovered.push_back(Now() - disturbed_);
  if (!steps) {
    std::fprintf(stderr, "the session is lost: %s\n", driver_.error().c_str());
    ++tally.lost;
  }
  tally.wrong += driver_.wrong() - wrong_before_;
  wrong_before_ = driver_.wrong();
}

}  // namespace phrenic::faults
