// Injects faults and attacks into a server under load and prints the tables of deploy/README.md: build/faults
// [--share S] [NAME ...]. Exit code 1 if a session was lost, a response was wrong, or an attack broke a promise.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include "absl/strings/str_cat.h"
#include "tests/faults/attacks.h"
#include "tests/faults/faults.h"

namespace phrenic::faults {
namespace {

double Quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(fraction * static_cast<double>(values.size() - 1))];
}

void PrintLine(const Fault& fault, const Tally& tally) {
  if (!tally.skipped.empty()) {
    std::printf("| %s: %s | 0 | | | skipped: %s |\n", fault.name, fault.description, tally.skipped.c_str());
  } else {
    std::printf("| %s: %s | %d | %d | %d | %.0f; %.0f |\n", fault.name, fault.description, tally.tried, tally.lost,
                tally.wrong, 1e3 * Quantile(tally.recovered, 0.5), 1e3 * Quantile(tally.recovered, 1));
  }
  std::fflush(stdout);
  if (!tally.note.empty()) std::fprintf(stderr, "%s: %s\n", fault.name, tally.note.c_str());
  if (tally.lost + tally.wrong > 0) {
    std::fprintf(stderr, "FAIL: %s: %d sessions lost, %d wrong answers\n", fault.name, tally.lost, tally.wrong);
  }
}

class Chosen {
 public:
  explicit Chosen(std::vector<std::string> names) : names_(std::move(names)) {}
  // True if the row or its table was named, or nothing was.
  bool Has(const char* table, const char* name) const {
    const auto named = [this](const char* word) { return std::ranges::find(names_, word) != names_.end(); };
    return names_.empty() || named(table) || named(name);
  }
  template <class Rows>
  bool HasAny(const char* table, const Rows& rows) const {
    return std::ranges::any_of(rows, [&](const auto& row) { return Has(table, row.name); });
  }

 private:
  const std::vector<std::string> names_;
};

std::string FolderOf(const char* name) {
  return (std::filesystem::temp_directory_path() / absl::StrCat("phrenic-faults-", name, "-", getpid())).string();
}

int RunFaults(const Chosen& chosen, double share) {
  if (!chosen.HasAny("faults", kFaults)) return 0;
  std::printf("| fault | tries | sessions lost | wrong answers | time until it answers, median; longest [ms] |\n");
  std::printf("|--|--|--|--|--|\n");
  Oracle oracle;
  int bad = 0;
  for (const Fault& fault : kFaults) {
    if (!chosen.Has("faults", fault.name)) continue;
    const std::string folder = FolderOf(fault.name);
    const int times = std::max(1, static_cast<int>(std::lround(share * fault.times)));
    const Tally tally = fault.run(oracle, folder, times);
    std::filesystem::remove_all(folder);
    std::filesystem::remove_all(folder + ".disk");
    PrintLine(fault, tally);
    bad += tally.lost + tally.wrong;
  }
  return bad;
}

int RunAttacks(const Chosen& chosen, double share, double largest_gap) {
  if (!chosen.HasAny("attacks", kAttacks)) return 0;
  PrintAttackHeader();
  int bad = 0;
  for (const Attack& attack : kAttacks) {
    if (chosen.Has("attacks", attack.name)) bad += RunAttack(attack, FolderOf(attack.name), share, largest_gap);
  }
  return bad;
}

}  // namespace
}  // namespace phrenic::faults

int main(int argc, char** argv) {
  using namespace phrenic::faults;  // NOLINT(google-build-using-namespace)
  CLI::App app("Injects faults and attacks into a server under load");
  std::vector<std::string> names = {"faults", "attacks"}, chosen;
  for (const auto& fault : kFaults) names.emplace_back(fault.name);
  for (const auto& attack : kAttacks) names.emplace_back(attack.name);
  double share = 1, largest_gap = 1.5;
  app.add_option("NAME", chosen, "faults and attacks to inject; default: all")->check(CLI::IsMember(names));
  app.add_option("--share", share, "fraction of the usual number of injections")->check(CLI::Range(0.001, 100.0));
  app.add_option(
         "--largest-gap", largest_gap,
         "longest time that a healthy viewer may wait for a frame during an attack [s]; 0.15 on a quiet machine")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGPIPE, SIG_IGN);
  const int bad = RunFaults(Chosen(chosen), share) + RunAttacks(Chosen(chosen), share, largest_gap);
  return bad == 0 ? 0 : 1;
}
