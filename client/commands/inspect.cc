// `phrenic inspect`: reads a surface file as a scene does and reports its contents and defects.
#include <iostream>

#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/print/output.h"
#include "client/print/surface_report.h"
#include "server/compare/inspection.h"
#include "server/mesh/units.h"
#include "server/meshio/meshio.h"

namespace phrenic::client {
namespace {

struct InspectOptions {
  std::string file;
  double unit_mm = 1;  // length of the file's unit [mm]
};

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

}  // namespace

CommandFunction SetUpInspect(CLI::App& command) {
  const auto options = std::make_shared<InspectOptions>();
  command.add_option("FILE", options->file, "a surface (" + meshio::Endings() + ")")->required();
  AddUnit(command, "--unit-mm", options->unit_mm, "FILE's");
  return Bind(&Inspect, options);
}

}  // namespace phrenic::client
