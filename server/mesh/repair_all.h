// Runs the repairs of repair.h and holes.h in an order in which each helps the next, until none changes the surface.
// Threads may call it with different meshes.
#ifndef PHRENIC_SERVER_MESH_REPAIR_ALL_H_
#define PHRENIC_SERVER_MESH_REPAIR_ALL_H_

#include <string>
#include <string_view>
#include <vector>

#include "server/mesh/holes.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// Names of the repairs, in the order in which they run.
inline constexpr std::string_view kRepairs[] = {"weld",   "cuts",    "slivers", "fins",
                                                "orient", "pinches", "crumbs",  "holes"};

// Lengths are in the unit of the mesh; the defaults are in metres.
struct RepairOptions {
  std::vector<std::string> repairs;  // of kRepairs; "all" stands for each
  double within = 1e-6;              // vertices closer than this coincide; height of slivers
  double gap = 5e-4;                 // across a cut
  double crumb = 5e-3;               // extent of components that are dropped
  double hole = 1e-2;                // extent of holes that are closed
};

struct RepairReport {
  std::vector<int> changes;  // by kRepairs: vertices, triangles, components or holes that it changed
  std::vector<Hole> open;    // holes and rims that are left
  int parts = 0;             // components that are left
};

// Repairs a surface. A second call changes nothing, and neither does a call on a surface without defects.
RepairReport RepairAll(const RepairOptions& options, Mesh& mesh);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_REPAIR_ALL_H_
