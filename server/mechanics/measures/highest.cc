#include "server/mechanics/measures/highest.h"

#include <algorithm>
#include <limits>

#include "absl/strings/str_cat.h"
#include "server/mechanics/skinning/body_points.h"

namespace phrenic {
namespace {

class HighestMeasure final : public Measure {
 public:
  HighestMeasure(std::string name, const BodyPoints& body, std::vector<int> vertices, const Eigen::Vector3d& direction,
                 double zero)
      : Measure(std::move(name), "m"),
        body_(body),
        vertices_(std::move(vertices)),
        direction_(direction),
        zero_(zero) {}

  double Value(const EvalContext& at) const override { return Furthest(body_.Positions(at)) - zero_; }
  // Makes the value relative to that at rest.
  void MeasureFromRest() { zero_ = Furthest(body_.rest()); }

 private:
  double Furthest(const ConstPoints& x) const {
    double furthest = -std::numeric_limits<double>::infinity();
    for (const int i : vertices_) furthest = std::max(furthest, direction_.dot(x.col(i)));
    return furthest;
  }

  BodyPoints body_;
  std::vector<int> vertices_;
  Eigen::Vector3d direction_;  // unit
  double zero_;                // [m]
};

}  // namespace

absl::StatusOr<std::unique_ptr<Measure>> MakeHighest(const v1::Highest& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder) {
  const std::string field(path);
  const auto body = builder.Body(scene.body(), field + ".body");
  if (!body.ok()) return body.status();
  const auto mask = builder.Region(*body, scene.region(), field + ".region");
  if (!mask.ok()) return mask.status();
  std::vector<int> vertices;
  for (int i = 0; i < static_cast<int>(mask->size()); ++i) {
    if ((*mask)[i]) vertices.push_back(i);
  }
  if (vertices.empty()) return FieldError(field + ".region", "has no vertex");
  const Eigen::Vector3d direction = scene.has_direction() ? ToEigen(scene.direction()) : Eigen::Vector3d::UnitZ();
  if (!(direction.norm() > 0)) return FieldError(field + ".direction", "has no direction: set x, y or z");
  const Eigen::Vector3d unit = direction.normalized();
  builder.ReportElement("measure", name, static_cast<std::int64_t>(vertices.size()), "vertices",
                        absl::StrCat("the highest point", scene.from_rest() ? " since rest" : ""));
  auto measure = std::make_unique<HighestMeasure>(name, BodyPoints(builder.model, *body), std::move(vertices), unit,
                                                  unit.dot(ToEigen(scene.point())));
  if (scene.from_rest()) measure->MeasureFromRest();
  return measure;
}

}  // namespace phrenic
