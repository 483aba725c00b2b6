// Tests a cluster under faults: kills and drains random servers and stops Redis while sessions are stepped and watched
// through nginx. Prints the outages. Exit code 1 if a session was lost or a state was wrong, 77 if programs are
// missing.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "tests/cluster/trial/worker.h"

namespace phrenic::cluster {
namespace {

struct Options {
  int servers = 3, steppers = 6, watchers = 3, kills = 3, drains = 2, outages = 1;
  double outage_seconds = 5;
};

// The events of one kind; times in [s].
struct Row {
  std::string name;
  int events = 0;
  std::vector<double> moved = {};        // from the event to the next answer of a session that moved
  std::vector<double> rolled_back = {};  // simulated time
  std::vector<double> elsewhere = {};    // gaps of sessions that did not move
};

double Quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(fraction * static_cast<double>(values.size())))];
}

class Trial {
 public:
  explicit Trial(const Options& options) : options_(options) {}

  int Run() {
    if (const absl::Status started = deployment_.Start(options_.servers); !started.ok()) {
      std::fprintf(stderr, "%s\n", std::string(started.message()).c_str());
      return 1;
    }
    if (!MakeWorkers()) return 1;
    absl::SleepFor(absl::Seconds(5));  // until all servers take over sessions
    for (int i = 0; i < std::max(options_.kills, options_.drains); ++i) {
      if (i < options_.kills) Disturb(killed_, SIGKILL);
      if (i < options_.drains) Disturb(drained_, SIGTERM);
    }
    for (int i = 0; i < options_.outages; ++i) StopRedis(i % 2 == 1);
    return Judge();
  }

 private:
  std::vector<Worker*> Workers() {
    std::vector<Worker*> all;
    for (const auto& each : steppers_) all.push_back(each.get());
    for (const auto& each : watchers_) all.push_back(each.get());
    return all;
  }

  bool MakeWorkers() {
    bool made = true;
    for (int i = 0; i < options_.steppers; ++i) {
      steppers_.push_back(std::make_unique<Stepper>(deployment_, oracle_, absl::StrCat("stepped-", i)));
      made = made && steppers_.back()->made();
    }
    for (int i = 0; i < options_.watchers; ++i) {
      watchers_.push_back(std::make_unique<Watcher>(deployment_, absl::StrCat("watched-", i)));
      made = made && watchers_.back()->made();
    }
    if (!made) std::fprintf(stderr, "the sessions could not be created\n");
    return made;
  }

  // Waits until every session has answered 4 s after `event`.
  void AwaitAll(absl::Time event) {
    for (const absl::Time end = absl::Now() + absl::Seconds(30); absl::Now() < end;
         absl::SleepFor(absl::Milliseconds(50))) {
      const auto all = Workers();
      const bool all_back = std::all_of(
          all.begin(), all.end(), [event](const Worker* each) { return each->last() > event + absl::Seconds(4); });
      if (all_back) return;
    }
  }

  void Collect(absl::Time event, Row& row) {
    ++row.events;
    for (const Worker* each : Workers()) {
      const std::vector<Gap> gaps = each->GapsSince(event);
      const bool moved = std::any_of(gaps.begin(), gaps.end(), [](const Gap& gap) { return gap.moved; });
      double until = 0, back = 0;
      for (const Gap& gap : gaps) {
        if (gap.moved) until = std::max(until, absl::ToDoubleSeconds(gap.end - event));
        if (gap.moved) back = std::max(back, gap.rolled_back);
        if (!moved) row.elsewhere.push_back(absl::ToDoubleSeconds(gap.end - gap.begin));
      }
      if (!moved) continue;
      row.moved.push_back(until);
      row.rolled_back.push_back(back);
    }
  }

  void Disturb(Row& row, int signal) {
    const std::string victim = absl::StrCat("server-", 1 + random_() % static_cast<unsigned>(options_.servers));
    const absl::Time event = absl::Now();
    std::fprintf(stderr, "%s: %s\n", row.name.c_str(), victim.c_str());
    deployment_.End(victim, signal);
    AwaitAll(event);
    Collect(event, row);
    deployment_.StartAgain(victim);
    absl::SleepFor(absl::Seconds(5));
  }

  void StopRedis(bool delete_data) {
    Row& row = delete_data ? emptied_ : outage_;
    std::fprintf(stderr, "%s\n", row.name.c_str());
    const absl::Time event = absl::Now();
    deployment_.End("redis", SIGKILL);
    absl::SleepFor(absl::Seconds(options_.outage_seconds));
    std::error_code ignored;
    if (delete_data) std::filesystem::remove_all(deployment_.folder() + "/appendonlydir", ignored);
    deployment_.StartAgain("redis");
    AwaitAll(absl::Now());
    Collect(event, row);
    absl::SleepFor(absl::Seconds(3));
  }

  int Judge() {
    int lost = 0, wrong = 0, steps = 0;
    for (Worker* each : Workers()) each->Stop();
    for (const auto& each : steppers_) {
      if (each->Lost()) {
        ++lost;
        std::fprintf(stderr, "lost: %s\n", each->error().c_str());
      }
      wrong += each->wrong();
      steps += each->steps();
    }
    for (const auto& each : watchers_) {
      bool gone = false;
      const bool right = each->Right(gone);
      if (gone) ++lost;
      if (!gone && !right) ++wrong;
    }
    std::printf("%d servers, %d sessions stepped (%d answers), %d played and watched\n", options_.servers,
                options_.steppers, steps, options_.watchers);
    std::printf("sessions lost %d, wrong states %d\n\n", lost, wrong);
    std::printf("%-26s %6s %6s %8s %8s %8s %12s %14s\n", "", "events", "moved", "p50 [s]", "p99 [s]", "max [s]",
                "back, max [s]", "elsewhere, max [s]");
    for (const Row* row : {&killed_, &drained_, &outage_, &emptied_}) {
      if (row->events == 0) continue;
      std::printf("%-26s %6d %6zu %8.2f %8.2f %8.2f %12.2f %14.2f\n", row->name.c_str(), row->events, row->moved.size(),
                  Quantile(row->moved, 0.5), Quantile(row->moved, 0.99), Quantile(row->moved, 1),
                  Quantile(row->rolled_back, 1), Quantile(row->elsewhere, 1));
    }
    return lost + wrong == 0 ? 0 : 1;
  }

  const Options options_;
  std::mt19937 random_{7};
  Deployment deployment_;
  faults::Oracle oracle_;
  std::vector<std::unique_ptr<Stepper>> steppers_;
  std::vector<std::unique_ptr<Watcher>> watchers_;
  Row killed_{"a server is killed"}, drained_{"a server is drained"}, outage_{"Redis is stopped"},
      emptied_{"Redis loses its data"};
};

int Main(int argc, char** argv) {
  Options options;
  CLI::App app("cluster_trial: kills and drains servers of a local cluster and reports the outages.");
  app.add_option("--servers", options.servers, "servers")->check(CLI::Range(2, 16))->capture_default_str();
  app.add_option("--stepped", options.steppers, "sessions that are stepped")->capture_default_str();
  app.add_option("--watched", options.watchers, "sessions that play and are watched")->capture_default_str();
  app.add_option("--kills", options.kills, "servers killed, one after the other")->capture_default_str();
  app.add_option("--drains", options.drains, "servers stopped by SIGTERM")->capture_default_str();
  app.add_option("--outages", options.outages, "stops of Redis; every second one deletes its data")
      ->capture_default_str();
  app.add_option("--outage-seconds", options.outage_seconds, "duration of each stop [s]")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (!HasTools()) return kSkipped;
  return Trial(options).Run();
}

}  // namespace
}  // namespace phrenic::cluster

int main(int argc, char** argv) { return phrenic::cluster::Main(argc, argv); }
