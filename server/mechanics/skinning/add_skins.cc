#include "server/mechanics/skinning/add_skins.h"

#include <numeric>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/parallel/compile_threads.h"
#include "server/mechanics/skinning/bar_weights.h"
#include "server/mechanics/skinning/inverse_distance_weights.h"
#include "server/mechanics/skinning/sheet_skin.h"
#include "server/mechanics/skinning/smooth_weights.h"
#include "server/mechanics/skinning/triangle_skin.h"
#include "server/mesh/locality.h"
#include "server/mesh/units.h"

namespace phrenic {
namespace {

absl::Status CheckBody(const BodyModel& body, std::string_view path) {
  if (body.role != v1::ROLE_SEEN) {
    return FieldError(path, absl::StrCat("body \"", body.name, "\" must have ROLE_SEEN to follow other bodies"));
  }
  if (body.skin >= 0) return FieldError(path, absl::StrCat("body \"", body.name, "\" already follows other bodies"));
  return absl::OkStatus();
}

// Sorts the weights by vertex. Stable: keeps the order of each vertex's weights.
std::vector<SkinWeight> ByVertex(const std::vector<SkinWeight>& weights, Eigen::Index vertices) {
  std::vector<int> next(static_cast<size_t>(vertices) + 1, 0);
  for (const SkinWeight& weight : weights) ++next[weight.vertex + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<SkinWeight> sorted(weights.size());
  for (const SkinWeight& weight : weights) sorted[next[weight.vertex]++] = weight;
  return sorted;
}

// Appends lists of weights, one after another.
std::vector<SkinWeight> Joined(const std::vector<std::vector<SkinWeight>>& parts) {
  size_t count = 0;
  for (const auto& part : parts) count += part.size();
  std::vector<SkinWeight> joined;
  joined.reserve(count);
  for (const auto& part : parts) joined.insert(joined.end(), part.begin(), part.end());
  return joined;
}

// Calls append(PartRange, weights) for parts of so many vertices, on all cores, and returns the weights in order.
template <typename Append>
std::vector<SkinWeight> WeighAll(Eigen::Index vertices, const StopCheck& stop, const Append& append) {
  std::vector<std::vector<SkinWeight>> parts(static_cast<size_t>(CountParts(vertices)));
  ForEachPartUntil(
      std::ssize(parts), [&stop] { return stop.Stopped(); },
      [&](std::int64_t part) { append(PartOf(vertices, part), parts[part]); });
  return Joined(parts);
}

Skin SkinByDistance(const SkinDrivers& drivers, const BodyModel& body, int b, const StopCheck& stop) {
  const Points& vertices = body.mesh.vertices;
  const std::vector<int> order = HilbertOrder(vertices);
  const auto append = [&](const PartRange& range, std::vector<SkinWeight>& weights) {
    InverseDistanceWeights by_distance(drivers);
    for (std::int64_t i = range.first; i < range.end; ++i) {
      by_distance.Append(vertices.col(order[i]), order[i], weights);
    }
  };
  const std::vector<SkinWeight> weights = WeighAll(vertices.cols(), stop, append);
  return {.body = b, .weights = SkinWeights(ByVertex(weights, vertices.cols())), .triangles = {}, .sheet = nullptr};
}

void AddSkin(Skin skin, ModelBuilder& builder) {
  builder.model.bodies[skin.body].skin = static_cast<int>(builder.model.skins.size());
  builder.model.skins.push_back(std::move(skin));
}

void SkinAllByDistance(const std::vector<int>& bodies, const std::vector<int>& drivers, const std::string& name,
                       ModelBuilder& builder) {
  const SkinDrivers search(builder, drivers);
  std::int64_t vertices = 0;
  for (const int b : bodies) {
    AddSkin(SkinByDistance(search, builder.model.bodies[b], b, builder.stop), builder);
    vertices += builder.model.bodies[b].mesh.vertices.cols();
  }
  builder.ReportElement("seen", name, vertices, "vertices", "computed per frame, not per step");
}

void SkinAllSmoothly(const std::vector<int>& bodies, const std::vector<int>& drivers, const std::string& name,
                     ModelBuilder& builder) {
  const SmoothWeights smooth(builder, drivers);
  std::int64_t vertices = 0;
  for (const int b : bodies) {
    const Points& rest = builder.model.bodies[b].mesh.vertices;
    const auto append = [&](const PartRange& range, std::vector<SkinWeight>& of) {
      for (std::int64_t i = range.first; i < range.end; ++i) smooth.Append(rest.col(i), static_cast<int>(i), of);
    };
    const std::vector<SkinWeight> weights = WeighAll(rest.cols(), builder.stop, append);
    AddSkin({.body = b, .weights = SkinWeights(weights), .triangles = {}, .sheet = nullptr}, builder);
    vertices += rest.cols();
  }
  builder.ReportElement("seen", name, vertices, "vertices", "by smooth weights, computed per frame, not per step");
}

absl::Status SkinAllAsBars(const std::vector<int>& bodies, const std::vector<int>& drivers, const std::string& name,
                           const std::string& path, ModelBuilder& builder) {
  if (drivers.size() != 2) {
    return FieldError(path, absl::StrCat("SKIN_MODE_BAR is between two bodies, not ", drivers.size(),
                                         "; name the bodies at both ends of the bar"));
  }
  const SkinDrivers search(builder, drivers);
  for (const int b : bodies) {
    const Points& rest = builder.model.bodies[b].mesh.vertices;
    AddSkin({.body = b, .weights = SkinWeights(BarWeights(search, rest)), .triangles = {}, .sheet = nullptr}, builder);
    builder.ReportElement("seen", name, rest.cols(), "vertices", "as a bar between two bodies, computed per frame");
  }
  return absl::OkStatus();
}

absl::Status BindAllToTriangles(const std::vector<int>& bodies, const std::vector<int>& drivers,
                                const std::string& name, const std::string& path, ModelBuilder& builder) {
  const auto binder = TriangleBinder::Make(builder, drivers, path);
  if (!binder.ok()) return binder.status();
  for (const int b : bodies) {
    v1::MappingReport& report = *builder.model.report.add_mappings();
    AddSkin(binder->Bind(b, report), builder);
    builder.ReportElement(
        "seen", name, builder.model.bodies[b].mesh.vertices.cols(), "vertices",
        absl::StrFormat(
            "bound to triangles, computed per frame: mean distance %.2g mm at rest, largest %.2g mm; a uniform "
            "stretch of 1 %% is followed within %.2g mm",
            report.mean_distance_mm(), report.largest_distance_mm(), report.largest_strain_error_mm()));
  }
  return absl::OkStatus();
}

absl::Status BindAllToSheet(const std::vector<int>& bodies, const std::vector<int>& drivers, double thickness,
                            const std::string& name, const std::string& path, ModelBuilder& builder) {
  const auto binder = SheetBinder::Make(builder, drivers, absl::StrCat(path, ".drivers"));
  if (!binder.ok()) return binder.status();
  for (const int b : bodies) {
    v1::MappingReport& report = *builder.model.report.add_mappings();
    absl::StatusOr<Skin> skin = binder->Bind(b, thickness, path, report);
    if (!skin.ok()) return skin.status();
    AddSkin(*std::move(skin), builder);
    builder.ReportElement(
        "seen", name, builder.model.bodies[b].mesh.vertices.cols(), "vertices",
        absl::StrFormat("bound to the middle surface of a sheet %.2g mm thick at rest, computed per "
                        "frame: mean distance %.2g mm at rest, largest %.2g mm",
                        kMillimetresAMetre * thickness, report.mean_distance_mm(), report.largest_distance_mm()));
  }
  return absl::OkStatus();
}

absl::Status CheckCorrections(const v1::Skin& scene, std::string_view path) {
  const bool by_weights = scene.mode() == v1::SKIN_MODE_UNSPECIFIED || scene.mode() == v1::SKIN_MODE_NEAREST_VERTICES ||
                          scene.mode() == v1::SKIN_MODE_SMOOTH;
  if (by_weights || (scene.obstacle().empty() && scene.wall().empty())) return absl::OkStatus();
  return FieldError(
      absl::StrCat(std::string(path), scene.obstacle().empty() ? ".wall" : ".obstacle"),
      "only SKIN_MODE_NEAREST_VERTICES and SKIN_MODE_SMOOTH can have one; leave it out, or set that mode");
}

}  // namespace

absl::Status AddSkins(const v1::Skin& scene, const std::string& given, std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "skin", scene.bodies());
  const std::string field = absl::StrCat(std::string(path), ".bodies");
  const std::string drivers_field = absl::StrCat(std::string(path), ".drivers");
  auto bodies = builder.Bodies(scene.bodies(), field);
  if (!bodies.ok()) return bodies.status();
  auto drivers = builder.Bodies(scene.drivers(), drivers_field);
  if (!drivers.ok()) return drivers.status();
  for (const int b : *bodies) {
    if (absl::Status status = CheckBody(builder.model.bodies[b], field); !status.ok()) return status;
  }
  if (absl::Status status = CheckCorrections(scene, path); !status.ok()) return status;
  if (scene.mode() == v1::SKIN_MODE_TRIANGLES)
    return BindAllToTriangles(*bodies, *drivers, name, drivers_field, builder);
  if (scene.mode() == v1::SKIN_MODE_SHEET)
    return BindAllToSheet(*bodies, *drivers, scene.thickness(), name, std::string(path), builder);
  if (scene.mode() == v1::SKIN_MODE_BAR) return SkinAllAsBars(*bodies, *drivers, name, drivers_field, builder);
  if (scene.mode() == v1::SKIN_MODE_SMOOTH) {
    SkinAllSmoothly(*bodies, *drivers, name, builder);
  } else {
    SkinAllByDistance(*bodies, *drivers, name, builder);
  }
  return absl::OkStatus();
}

}  // namespace phrenic
