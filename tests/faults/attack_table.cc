#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "tests/faults/attacks.h"

namespace phrenic::faults {
namespace {

constexpr double kMostTaken = 1000;   // memory above that before an attack, at any time [MB]
constexpr double kLongestWait = 2.5;  // of a healthy call; long, as the machine may be busy [s]

std::string Milliseconds(double seconds) {
  return std::isfinite(seconds) ? absl::StrFormat("%.0f", 1e3 * seconds) : "no more";
}

// Adds the promises that every attack tests.
void Judge(const Damage& damage, double largest_gap, std::vector<std::string>& broken) {
  if (damage.died) return broken.emplace_back("the server died"), void();
  if (damage.gap > largest_gap) broken.push_back("the healthy viewer waited too long");
  if (damage.wait > kLongestWait) broken.push_back("healthy calls were not answered in time");
  if (damage.peak > damage.before + kMostTaken) broken.push_back("it took too much memory");
  if (damage.afterwards > damage.before + kReturnedMemory) broken.push_back("memory was kept");
}

void PrintRow(const Attack& attack, const Outcome& outcome, const Damage& damage,
              const std::vector<std::string>& broken) {
  const std::string numbers =
      outcome.refused + outcome.served == 0 ? "" : absl::StrFormat("%d; %d", outcome.refused, outcome.served);
  std::printf("| %s: %s | %d | %s | %s | %s | %.0f; %.0f; %.0f | %s |\n", attack.name, attack.description,
              outcome.tried, numbers.c_str(), Milliseconds(damage.gap).c_str(), Milliseconds(damage.wait).c_str(),
              damage.before, damage.peak, damage.afterwards,
              broken.empty() ? "held" : absl::StrJoin(broken, "; ").c_str());
  std::fflush(stdout);
  if (!outcome.note.empty()) std::fprintf(stderr, "%s: %s\n", attack.name, outcome.note.c_str());
  for (const std::string& promise : broken) {
    std::fprintf(stderr, "FAIL: %s: %s (gap %.0f ms, wait %.0f ms, memory %.0f; %.0f; %.0f MB)\n", attack.name,
                 promise.c_str(), 1e3 * damage.gap, 1e3 * damage.wait, damage.before, damage.peak, damage.afterwards);
  }
}

}  // namespace

void PrintAttackHeader() {
  std::printf(
      "\n| attack | tries | refused; served | healthy viewer's largest gap [ms] | longest wait of a healthy call [ms] "
      "| memory before; peak; within 10 s after [MB] | promises |\n|--|--|--|--|--|--|--|\n");
}

int RunAttack(const Attack& attack, const std::string& folder, double share, double largest_gap) {
  Outcome outcome;
  Damage damage;
  {
    Victim victim(folder, absl::StrSplit(attack.flags, ' ', absl::SkipEmpty()), attack.open);
    if (!victim.ready()) {
      std::fprintf(stderr, "%s: %s\n", attack.name, victim.problem().c_str());
      return 1;
    }
    victim.Begin();
    outcome = attack.run(victim, std::max(1, static_cast<int>(std::lround(share * attack.times))));
    damage = victim.End();
    if (attack.open && !victim.guarded()) std::fprintf(stderr, "%s: without a guard\n", attack.name);
  }
  std::vector<std::string> broken = outcome.broken;
  Judge(damage, largest_gap, broken);
  PrintRow(attack, outcome, damage, broken);
  std::filesystem::remove_all(folder);
  return static_cast<int>(broken.size());
}

}  // namespace phrenic::faults
