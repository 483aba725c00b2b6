// Injects faults into a server under load and prints losses and recovery times: build/faults [--share S] [FAULT ...].
// Exit code 1 if a session was lost or a response was wrong.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "absl/strings/str_cat.h"
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
    std::printf("%-9s %-46s skipped: %s\n", fault.name, fault.description, tally.skipped.c_str());
  } else {
    std::printf("%-9s %-46s %6d %6d %6d %9.0f %9.0f\n", fault.name, fault.description, tally.tried, tally.lost,
                tally.wrong, 1e3 * Quantile(tally.recovered, 0.5), 1e3 * Quantile(tally.recovered, 1));
  }
  if (!tally.note.empty()) std::printf("%-9s %s\n", "", tally.note.c_str());
  std::fflush(stdout);
}

int Run(const std::vector<std::string>& chosen, double share) {
  std::printf("%-9s %-46s %6s %6s %6s %9s %9s\n", "fault", "", "tried", "lost", "wrong", "recovery", "max [ms]");
  Oracle oracle;
  int bad = 0;
  for (const Fault& fault : kFaults) {
    if (!chosen.empty() && std::find(chosen.begin(), chosen.end(), fault.name) == chosen.end()) continue;
    const std::string folder =
        (std::filesystem::temp_directory_path() / absl::StrCat("phrenic-faults-", fault.name, "-", getpid())).string();
    const int times = std::max(1, static_cast<int>(std::lround(share * fault.times)));
    const Tally tally = fault.run(oracle, folder, times);
    std::filesystem::remove_all(folder);
    std::filesystem::remove_all(folder + ".disk");
    PrintLine(fault, tally);
    bad += tally.lost + tally.wrong;
  }
  return bad == 0 ? 0 : 1;
}

}  // namespace
}  // namespace phrenic::faults

int main(int argc, char** argv) {
  CLI::App app("Injects faults into a server under load");
  std::vector<std::string> names, chosen;
  for (const auto& fault : phrenic::faults::kFaults) names.emplace_back(fault.name);
  double share = 1;
  app.add_option("FAULT", chosen, "faults to inject; default: all")->check(CLI::IsMember(names));
  app.add_option("--share", share, "fraction of the usual number of injections")->check(CLI::Range(0.001, 100.0));
  CLI11_PARSE(app, argc, argv);
  return phrenic::faults::Run(chosen, share);
}
