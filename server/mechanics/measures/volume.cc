#include "server/mechanics/measures/volume.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/breathing/chamber.h"

namespace phrenic {
namespace {

class VolumeMeasure final : public Measure {
 public:
  VolumeMeasure(std::string name, Chamber chamber, double zero)
      : Measure(std::move(name), "m^3"), chamber_(std::move(chamber)), zero_(zero) {}
  double Value(const EvalContext& at) const override { return chamber_.Volume(at) - zero_; }

 private:
  Chamber chamber_;
  double zero_;  // [m^3]
};

class FlowMeasure final : public Measure {
 public:
  FlowMeasure(std::string name, Chamber chamber) : Measure(std::move(name), "m^3/s"), chamber_(std::move(chamber)) {}
  double Value(const EvalContext& at) const override { return chamber_.Read(at).flow; }

 private:
  Chamber chamber_;
};

// Scene is v1::Volume or v1::Flow, which both have a surface and a plane.
template <typename Scene>
absl::StatusOr<Chamber> MakeChamber(const Scene& scene, std::string_view path, const ModelBuilder& builder) {
  Chamber chamber;
  if (absl::Status s = chamber.Add(scene.surface(), 1, absl::StrCat(std::string(path), ".surface"), builder); !s.ok()) {
    return s;
  }
  const std::string plane = absl::StrCat(std::string(path), ".plane");
  if (absl::Status s = chamber.SetPlane(scene.has_plane() ? &scene.plane() : nullptr, plane); !s.ok()) return s;
  return chamber;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Measure>> MakeVolume(const v1::Volume& scene, const std::string& name,
                                                    std::string_view path, ModelBuilder& builder) {
  auto chamber = MakeChamber(scene, path, builder);
  if (!chamber.ok()) return chamber.status();
  builder.ReportElement("measure", name, chamber->triangles(), "triangles",
                        absl::StrFormat("volume%s, %g litres at rest", scene.from_rest() ? " since rest" : "",
                                        1e3 * chamber->rest_volume()));
  const double zero = scene.from_rest() ? chamber->rest_volume() : 0;
  return std::make_unique<VolumeMeasure>(name, *std::move(chamber), zero);
}

absl::StatusOr<std::unique_ptr<Measure>> MakeFlow(const v1::Flow& scene, const std::string& name, std::string_view path,
                                                  ModelBuilder& builder) {
  auto chamber = MakeChamber(scene, path, builder);
  if (!chamber.ok()) return chamber.status();
  builder.ReportElement("measure", name, chamber->triangles(), "triangles", "rate of the volume");
  return std::make_unique<FlowMeasure>(name, *std::move(chamber));
}

}  // namespace phrenic
