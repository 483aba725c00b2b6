// `phrenic convert`: a surface file in another format. What was written is read back, and told.
#include <algorithm>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/commands/commands.h"
#include "client/files/whole_file.h"
#include "server/compare/inspection.h"
#include "server/mesh/repair.h"
#include "server/mesh/units.h"
#include "server/meshio/meshio.h"

namespace phrenic::client {
namespace {

// A sentence for each thing of `in` that `out` has not.
void TellLosses(const meshio::Surface& in, const Mesh& out) {
  const auto fewer = in.mesh.vertices.cols() - out.vertices.cols();
  if (fewer > 0) std::cerr << "phrenic: " << fewer << " vertices, unused or in the place of another, are not in it\n";
  for (const auto& [name, vertices] : in.mesh.regions) {
    const auto kept = out.regions.find(name);
    if (kept != out.regions.end() && kept->second == vertices) continue;
    std::cerr << "phrenic: the region \"" << name << "\" is not, or not whole, in it; .msh keeps regions\n";
  }
  if (in.frame == meshio::Frame::kRas) std::cerr << "phrenic: turned from RAS to LPS\n";
}

// What `options` asks for, in the order in which each helps the next.
void Repair(const ConvertOptions& options, Mesh& mesh) {
  const auto asked = [&options](const char* repair) {
    const auto& repairs = options.repairs;
    return std::any_of(repairs.begin(), repairs.end(), [&](const auto& one) { return one == repair || one == "all"; });
  };
  const double within = options.within_mm / options.out_unit_mm;
  const auto tell = [](int count, const char* what) { std::cerr << "phrenic: " << count << what; };
  if (asked("weld")) tell(Weld(within, mesh), " vertices were at the place of another, or unused\n");
  if (asked("slivers")) tell(DropSlivers(within, mesh), " triangles were slivers or doubled\n");
  if (asked("fins")) tell(DropFins(mesh), " triangles were of fins\n");
  if (asked("orient")) tell(Orient(mesh), " triangles were turned\n");
}

}  // namespace

int Convert(const Context& context, const ConvertOptions& options) {
  // In units of OUT rather than metres: where the two units are one, every digit is kept.
  auto surface = meshio::ReadSurface(options.in, options.unit_mm / options.out_unit_mm);
  if (!surface.ok()) return Fail(surface.status());
  Repair(options, surface->mesh);
  const auto bytes = meshio::Write(options.out, surface->mesh, 1);
  if (!bytes.ok()) return Fail(bytes.status());
  auto written = meshio::ParseSurface(options.out, *bytes, 1);
  if (!written.ok()) return Fail(written.status());
  if (const absl::Status status = WriteWhole(options.out, *bytes); !status.ok()) return Fail(status);
  TellLosses(*surface, written->mesh);
  written->mesh.vertices *= kMillimetre * options.out_unit_mm;
  const v1::SurfaceReport report = compare::Inspect(options.out, *written, options.out_unit_mm);
  if (context.json()) {
    std::cout << Json(report) << "\n";
  } else {
    std::cout << absl::StrFormat("%s: %d vertices, %d triangles\n", options.out, report.vertices(), report.triangles());
  }
  return kOk;
}

}  // namespace phrenic::client
