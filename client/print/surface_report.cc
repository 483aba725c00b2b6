#include "client/print/surface_report.h"

#include <algorithm>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/print/table.h"

namespace phrenic::client {
namespace {

constexpr int kMostComponents = 10;

std::string Box(const v1::SurfaceReport& report) {
  std::string box;
  for (int axis = 0; axis < report.least_mm_size(); ++axis) {
    absl::StrAppendFormat(&box, "%s%s %.2f to %.2f", axis == 0 ? "" : ", ", std::string(1, "xyz"[axis]),
                          report.least_mm(axis), report.greatest_mm(axis));
  }
  return box + " mm";
}

std::string Unit(const v1::SurfaceReport& report) {
  const std::string said = absl::StrFormat("%g mm", report.unit_mm());
  if (report.likely_unit().empty()) return said + "; the size fits no common unit";
  return said + "; the size fits a body part in " + report.likely_unit();
}

void PrintCounts(const v1::SurfaceReport& report, std::ostream& out) {
  const auto line = [&](const char* what, const std::string& is) { out << absl::StrFormat("%-30s%s\n", what, is); };
  line("vertices", absl::StrCat(report.vertices()));
  line("of them unused", absl::StrCat(report.unused_vertices()));
  line("of them duplicate", absl::StrCat(report.duplicate_vertices()));
  line("triangles", absl::StrCat(report.triangles()));
  if (report.network_edges() > 0) line("edges of a network", absl::StrCat(report.network_edges()));
  line("degenerate triangles", absl::StrCat(report.degenerate_triangles()));
  line("boundary edges", absl::StrCat(report.boundary_edges()));
  line("non-manifold edges", absl::StrCat(report.non_manifold_edges()));
  line("inconsistently oriented edges", absl::StrCat(report.misoriented_edges()));
  line("pinched vertices", absl::StrCat(report.pinched_vertices()));
  line("components", absl::StrCat(report.components_size()));
  line("Euler characteristic", absl::StrCat(report.euler_characteristic()));
  line("bounding box", Box(report));
  line("unit", Unit(report));
  line("frame", report.frame().empty() ? "not given in the file; LPS is assumed" : report.frame());
  line("area", absl::StrFormat("%.1f mm^2", report.area_mm2()));
  line("volume", report.has_volume_ml() ? absl::StrFormat("%.3f ml", report.volume_ml()) : "not closed");
  if (report.regions_size() > 0) line("regions", absl::StrJoin(report.regions(), ", "));
}

void PrintComponents(const v1::SurfaceReport& report, std::ostream& out) {
  if (report.components_size() == 0) return;
  out << "\n";
  Table table(
      {"component", "triangles", "vertices", "boundary", "non-manifold", "misoriented", "genus", "volume [ml]"});
  for (int c = 0; c < std::min(kMostComponents, report.components_size()); ++c) {
    const v1::SurfacePart& part = report.components(c);
    table.Add({absl::StrCat(c + 1), absl::StrCat(part.triangles()), absl::StrCat(part.vertices()),
               absl::StrCat(part.boundary_edges()), absl::StrCat(part.non_manifold_edges()),
               absl::StrCat(part.misoriented_edges()), part.has_genus() ? absl::StrCat(part.genus()) : "-",
               part.has_volume_ml() ? absl::StrFormat("%.3f", part.volume_ml()) : "-"});
  }
  table.Print(out);
  const int more = report.components_size() - kMostComponents;
  if (more > 0) out << more << " smaller ones are not shown (-o json shows all)\n";
}

void PrintSentences(const char* title, const google::protobuf::RepeatedPtrField<std::string>& sentences,
                    std::ostream& out) {
  out << "\n" << title << "\n";
  for (const std::string& sentence : sentences) out << "- " << sentence << "\n";
  if (sentences.empty()) out << "- nothing\n";
}

}  // namespace

void PrintSurface(const v1::SurfaceReport& report, std::ostream& out) {
  out << report.name() << "\n";
  PrintCounts(report, out);
  PrintComponents(report, out);
  PrintSentences("To repair", report.repairs(), out);
  PrintSentences("What a scene would refuse", report.refusals(), out);
}

}  // namespace phrenic::client
