#include "server/mesh/repair_all.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>

#include "server/mesh/repair.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

constexpr int kMostRounds = 10;  // a repair may uncover another defect
constexpr double kApart = 2;     // of vertices that were split, in distances at which vertices coincide

// Runs one repair. Returns how much it changed.
int Run(std::string_view repair, const RepairOptions& options, Mesh& mesh) {
  if (repair == "weld") return Weld(options.within, mesh);
  if (repair == "cuts") return JoinCuts(options.gap, mesh);
  if (repair == "slivers") return DropSlivers(options.within, mesh);
  if (repair == "fins") return DropFins(mesh);
  if (repair == "orient") return Orient(mesh);
  if (repair == "pinches") return SplitPinches(kApart * options.within, mesh);
  return repair == "crumbs" ? DropCrumbs(options.crumb, mesh) : CloseHoles(options.hole, mesh);
}

}  // namespace

RepairReport RepairAll(const RepairOptions& options, Mesh& mesh) {
  const auto wanted = [&options](std::string_view repair) {
    return std::any_of(options.repairs.begin(), options.repairs.end(),
                       [&](const std::string& name) { return name == repair || name == "all"; });
  };
  RepairReport report;
  report.changes.assign(std::size(kRepairs), 0);
  for (int round = 0; round < kMostRounds; ++round) {
    int changed = 0;
    for (size_t r = 0; r < std::size(kRepairs); ++r) {
      if (!wanted(kRepairs[r])) continue;
      const int now = Run(kRepairs[r], options, mesh);
      report.changes[r] += now;
      changed += now;
    }
    if (changed == 0) break;
  }
  report.open = FindHoles(mesh);
  report.parts = static_cast<int>(Components(mesh).size());
  return report;
}

}  // namespace phrenic
