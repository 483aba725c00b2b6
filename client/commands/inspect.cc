// `phrenic inspect`: what a surface file holds, read here as a scene would read it.
#include <iostream>

#include "client/commands/commands.h"
#include "client/print/surface_report.h"
#include "server/compare/inspection.h"
#include "server/mesh/units.h"
#include "server/meshio/meshio.h"

namespace phrenic::client {
namespace {}  // namespace

int Inspect(const Context& context, const InspectOptions& options) {
  const auto surface = meshio::ReadSurface(options.file, kMillimetre * options.unit_mm);
  if (!surface.ok()) return Fail(surface.status());
  const v1::SurfaceReport report = compare::Inspect(options.file, *surface, options.unit_mm);
  if (context.json()) {
    std::cout << Json(report) << "\n";
  } else {
    PrintSurface(report, std::cout);
  }
  return kOk;
}

}  // namespace phrenic::client
