#include "server/mechanics/chamber.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "absl/strings/str_cat.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

using Vector = Eigen::Vector3d;

Triangles Chosen(const Mesh& mesh, const Selection& selection, const v1::SurfacePatch& scene) {
  const Vector facing = ToEigen(scene.facing());
  std::vector<int> chosen;
  for (int t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3i corners = mesh.triangles.col(t);
    if (!selection.Takes(corners)) continue;
    const Vector a = mesh.vertices.col(corners[0]), b = mesh.vertices.col(corners[1]),
                 c = mesh.vertices.col(corners[2]);
    if (!scene.has_facing() || (b - a).cross(c - a).dot(facing) > 0) chosen.push_back(t);
  }
  return mesh.triangles(Eigen::all, chosen);
}

// Six times the volume between a triangle and the plane.
double SixVolumes(const Vector& point, const Vector& n, const Vector& a, const Vector& b, const Vector& c) {
  return ((a - point) + (b - point) + (c - point)).dot(n) * n.dot((b - a).cross(c - a));
}

double SumVolumes(const ConstPoints& x, const Triangles& triangles, const Vector& point, const Vector& n) {
  double sum = 0;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    sum += SixVolumes(point, n, x.col(triangles(0, t)), x.col(triangles(1, t)), x.col(triangles(2, t)));
  }
  return sum / 6;
}

ChamberReading SumReadings(const BodyPoints::Moving& body, const Triangles& triangles, const Vector& point,
                           const Vector& n) {
  ChamberReading sum;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const int i = triangles(0, t), j = triangles(1, t), k = triangles(2, t);
    const Vector a = body.x.col(i), b = body.x.col(j), c = body.x.col(k), ab = b - a, ac = c - a;
    const Vector va = body.v.col(i), vab = body.v.col(j) - body.v.col(i), vac = body.v.col(k) - body.v.col(i);
    const double heights = ((a - point) + (b - point) + (c - point)).dot(n), rises = (3 * va + vab + vac).dot(n);
    const double area = n.dot(ab.cross(ac));
    sum.volume += heights * area;
    sum.flow += rises * area + heights * n.dot(vab.cross(ac) + ab.cross(vac));
  }
  return {sum.volume / 6, sum.flow / 6};
}

}  // namespace

const ChamberReading* ChamberReadings::Find(const std::string& key) const {
  for (const auto& [of, reading] : readings_) {
    if (of == key) return &reading;
  }
  return nullptr;
}

absl::Status Chamber::Add(const v1::SurfacePatch& scene, double side, std::string_view path, const Draft& draft) {
  const std::string field(path);
  const auto bodies = draft.Bodies(scene.bodies(), field + ".bodies");
  if (!bodies.ok()) return bodies.status();
  const int before = triangles();
  absl::StrAppend(&key_, side > 0 ? "+" : "-", scene.SerializeAsString());
  for (const int b : *bodies) {
    const auto selection = draft.Select(b, scene.region(), scene.exclude_region(), field);
    if (!selection.ok()) return selection.status();
    Part part{BodyPoints(draft.model, b), Chosen(draft.model.bodies[b].mesh, *selection, scene), {}, side};
    if (part.triangles.cols() == 0) continue;
    part.border = BorderVertices(part.triangles);
    parts_.push_back(std::move(part));
  }
  if (triangles() > before) return absl::OkStatus();
  return FieldError(path, "chooses no triangle: name bodies with a surface, and widen region and facing");
}

absl::Status Chamber::SetPlane(const v1::Plane* scene, std::string_view path) {
  Vector sum = Vector::Zero();
  double count = 0;
  for (const Part& part : parts_) {
    for (const int i : part.border) sum += part.points.rest().col(i), ++count;
  }
  point_ = count > 0 ? Vector(sum / count) : Vector(parts_.front().points.rest().col(parts_.front().triangles(0, 0)));
  absl::StrAppend(&key_, "/", scene == nullptr ? "" : scene->SerializeAsString());
  if (scene != nullptr) {
    point_ = ToEigen(scene->point());
    if (scene->has_normal()) normal_ = ToEigen(scene->normal());
  }
  if (!(normal_.norm() > 0)) {
    return FieldError(absl::StrCat(std::string(path), ".normal"), "has no direction: set x, y or z");
  }
  normal_.normalize();
  rest_volume_ = VolumeAtRest();
  return absl::OkStatus();
}

double Chamber::VolumeAtRest() const {
  double sum = 0;
  for (const Part& part : parts_) sum += part.side * SumVolumes(part.points.rest(), part.triangles, point_, normal_);
  return sum;
}

double Chamber::Volume(const Instant& at) const {
  if (at.readings != nullptr) return Read(at).volume;
  double sum = 0;
  for (const Part& part : parts_) {
    sum += part.side * SumVolumes(part.points.Positions(at), part.triangles, point_, normal_);
  }
  return sum;
}

ChamberReading Chamber::Read(const Instant& at) const {
  const ChamberReading* const found = at.readings == nullptr ? nullptr : at.readings->Find(key_);
  if (found != nullptr) return *found;
  ChamberReading sum;
  for (const Part& part : parts_) {
    const ChamberReading reading = SumReadings(part.points.Locate(at), part.triangles, point_, normal_);
    sum.volume += part.side * reading.volume;
    sum.flow += part.side * reading.flow;
  }
  if (at.readings != nullptr) at.readings->Add(key_, sum);
  return sum;
}

void Chamber::AddAreas(const Instant& at, double scale, MutablePoints f) const {
  for (const Part& part : parts_) {
    const int first = part.points.first_vertex();
    if (first < 0) continue;
    for (Eigen::Index t = 0; t < part.triangles.cols(); ++t) {
      const int i = first + part.triangles(0, t), j = first + part.triangles(1, t), k = first + part.triangles(2, t);
      const Vector ab = at.x.col(j) - at.x.col(i), ac = at.x.col(k) - at.x.col(i);
      const Vector third = scale * part.side / 6 * ab.cross(ac);
      f.col(i) += third;
      f.col(j) += third;
      f.col(k) += third;
    }
  }
}

int Chamber::triangles() const {
  Eigen::Index count = 0;
  for (const Part& part : parts_) count += part.triangles.cols();
  return static_cast<int>(count);
}

bool Chamber::pushes() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.points.first_vertex() >= 0; });
}

bool Chamber::conserves(const Model& model) const {
  return std::all_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    const int first = part.points.first_vertex();
    return first >= 0 && std::all_of(part.border.begin(), part.border.end(),
                                     [&](int vertex) { return model.inverse_mass[first + vertex] == 0; });
  });
}

}  // namespace phrenic
