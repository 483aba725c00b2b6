// `phrenic convert`: writes a surface file in another format, reads it back and reports what was lost.
#include <algorithm>
#include <iostream>
#include <iterator>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "server/compare/inspection.h"
#include "server/mesh/repair_all.h"
#include "server/mesh/units.h"
#include "server/meshio/meshio.h"

namespace phrenic::client {
namespace {

constexpr int kMostHoles = 20;  // number that is listed

// The unit of the number of changes of each of kRepairs.
constexpr const char* kChanged[] = {"duplicate or unused vertices removed",
                                    "vertices of cuts merged",
                                    "slivers and doubled triangles removed",
                                    "triangles of fins removed",
                                    "triangles reoriented",
                                    "vertices added where surfaces touched",
                                    "crumbs removed",
                                    "holes closed"};
static_assert(std::size(kChanged) == std::size(kRepairs));

struct ConvertOptions {
  std::string in, out;
  std::vector<std::string> repairs;     // of kRepairs and "all"
  double within_mm = 1e-3;              // points closer than this coincide
  double gap_mm = 0.5;                  // across a cut that is joined
  double crumb_mm = 5, hole_mm = 10;    // extent of parts that are dropped, and of holes that are closed
  std::vector<double> offset_mm;        // shift of the surface, x y z [mm]; empty: none
  double unit_mm = 1, out_unit_mm = 1;  // length of the units of IN and OUT [mm]
};

// Prints a sentence for each property of `in` that `out` lacks.
void ReportLosses(const meshio::Surface& in, const Mesh& out) {
  const auto fewer = in.mesh.vertices.cols() - out.vertices.cols();
  if (fewer > 0) std::cerr << "phrenic: " << fewer << " unused or duplicate vertices are not in the file\n";
  for (const auto& [name, vertices] : in.mesh.regions) {
    const auto kept = out.regions.find(name);
    if (kept != out.regions.end() && kept->second == vertices) continue;
    std::cerr << "phrenic: the region \"" << name << "\" is missing or incomplete in the file; .msh keeps regions\n";
  }
  if (in.frame == meshio::Frame::kRas) std::cerr << "phrenic: converted from RAS to LPS\n";
}

// Applies the chosen repairs, and prints what each changed and what is left.
void Repair(const ConvertOptions& options, Mesh& mesh) {
  if (options.repairs.empty()) return;
  const auto in_units = [&options](double mm) { return mm / options.out_unit_mm; };
  const RepairOptions repair = {options.repairs, in_units(options.within_mm), in_units(options.gap_mm),
                                in_units(options.crumb_mm), in_units(options.hole_mm)};
  const RepairReport report = RepairAll(repair, mesh);
  for (size_t r = 0; r < std::size(kRepairs); ++r) {
    if (report.changes[r] > 0) std::cerr << "phrenic: " << report.changes[r] << " " << kChanged[r] << "\n";
  }
  if (report.parts > 1) std::cerr << "phrenic: " << report.parts << " separate parts are left\n";
  const int shown = std::min(kMostHoles, static_cast<int>(report.open.size()));
  for (int h = 0; h < shown; ++h) {
    std::cerr << "phrenic: " << Describe(report.open[h], options.out_unit_mm) << " is left open\n";
  }
  if (const auto more = report.open.size() - shown; more > 0)
    std::cerr << "phrenic: " << more << " more are left open\n";
}

void Shift(const ConvertOptions& options, Mesh& mesh) {
  if (options.offset_mm.empty()) return;
  mesh.vertices.colwise() += Eigen::Map<const Eigen::Vector3d>(options.offset_mm.data()) / options.out_unit_mm;
}

int Convert(const Context& context, const ConvertOptions& options) {
  // Reads in units of OUT, not metres, so that equal units keep all digits.
  auto surface = meshio::ReadSurface(options.in, options.unit_mm / options.out_unit_mm);
  if (!surface.ok()) return Fail(surface.status());
  Shift(options, surface->mesh);
  Repair(options, surface->mesh);
  const auto bytes = meshio::Write(options.out, surface->mesh, 1);
  if (!bytes.ok()) return Fail(bytes.status());
  auto written = meshio::ParseSurface(options.out, *bytes, 1);
  if (!written.ok()) return Fail(written.status());
  if (const absl::Status status = WriteWhole(options.out, *bytes); !status.ok()) return Fail(status);
  ReportLosses(*surface, written->mesh);
  written->mesh.vertices *= kMillimetre * options.out_unit_mm;
  const v1::SurfaceReport report = compare::Inspect(options.out, *written, options.out_unit_mm);
  if (context.json()) {
    std::cout << Json(report) << "\n";
  } else {
    std::cout << absl::StrFormat("%s: %d vertices, %d triangles\n", options.out, report.vertices(), report.triangles());
  }
  return kOk;
}

}  // namespace

CommandFunction SetUpConvert(CLI::App& command) {
  const auto options = std::make_shared<ConvertOptions>();
  command.add_option("IN", options->in, "a surface (" + meshio::Endings() + ")")->required();
  command
      .add_option("OUT", options->out, "file to write; its ending sets the format (" + meshio::WrittenEndings() + ")")
      ->required();
  AddUnit(command, "--unit-mm", options->unit_mm, "IN's");
  AddUnit(command, "--out-unit-mm", options->out_unit_mm, "OUT's");
  command
      .add_option("--offset-mm", options->offset_mm,
                  "shifts the surface by x,y,z in the frame LPS [mm], such as 0,-135,0 (none)")
      ->check(NumberIn(-1e9, 1e9))
      ->delimiter(',')
      ->expected(3)
      ->allow_extra_args(false);
  command
      .add_option(
          "--repair", options->repairs,
          "weld (merge coincident vertices), cuts (join the sides of cuts), slivers (remove thin and doubled "
          "triangles), fins (remove pieces attached by one edge), orient (make neighbours agree and closed "
          "parts face outwards), pinches (separate surfaces that touch in a point or an edge), crumbs (remove small "
          "parts), holes (close small ones), or all (none)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--within-mm", options->within_mm, "distance below which points coincide for --repair [mm]")
      ->check(NumberIn(0.0, 10.0))
      ->capture_default_str();
  command.add_option("--gap-mm", options->gap_mm, "width of cuts that --repair cuts joins [mm]")
      ->check(NumberIn(0.0, 10.0))
      ->capture_default_str();
  command
      .add_option("--crumb-mm", options->crumb_mm,
                  "extent of parts that --repair crumbs removes, if it is also under a twentieth of the largest part's "
                  "[mm]")
      ->check(NumberIn(0.0, 1000.0))
      ->capture_default_str();
  command
      .add_option("--hole-mm", options->hole_mm,
                  "extent of holes that --repair holes closes, unless they are the rim of a sheet [mm]")
      ->check(NumberIn(0.0, 1000.0))
      ->capture_default_str();
  return Bind(&Convert, options);
}

}  // namespace phrenic::client
