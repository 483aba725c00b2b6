#include "server/mechanics/breathing/chamber.h"

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

struct TurnedPoints {
  Points x, v;
};
struct Areas {
  Points a;
};

// Returns the points in the coordinates of `axes`. They are valid until `memory` is used again.
ConstPoints Turn(const Eigen::Matrix3d& axes, const ConstPoints& y, Points& memory) {
  if (axes.isIdentity(0)) return y;
  if (memory.cols() < y.cols()) memory.resize(3, y.cols());
  memory.leftCols(y.cols()).noalias() = axes * y;
  return memory.leftCols(y.cols());
}

// Returns right-handed axes as rows; the third is the normal.
Eigen::Matrix3d AxesOf(const Vector& normal) {
  if (normal == Vector::UnitZ()) return Eigen::Matrix3d::Identity();
  const Vector p = normal.unitOrthogonal();
  Eigen::Matrix3d axes;
  axes << p.transpose(), normal.cross(p).transpose(), normal.transpose();
  return axes;
}

}  // namespace

const ChamberReading* ChamberReadings::Find(const std::string& key, What what) const {
  for (const Kept& kept : kept_) {
    if (kept.key == key && kept.what >= what) return &kept.reading;
  }
  return nullptr;
}

absl::Status Chamber::Add(const v1::SurfacePatch& scene, double side, std::string_view path,
                          const ModelBuilder& builder) {
  const std::string field(path);
  const auto bodies = builder.Bodies(scene.bodies(), field + ".bodies");
  if (!bodies.ok()) return bodies.status();
  const int before = triangles();
  absl::StrAppend(&key_, side > 0 ? "+" : "-", scene.SerializeAsString());
  for (const int b : *bodies) {
    const auto selection = builder.Select(b, scene.region(), scene.exclude_region(), field);
    if (!selection.ok()) return selection.status();
    Part part{BodyPoints(builder.model, b), Chosen(builder.model.bodies[b].mesh, *selection, scene), {}, {}, side};
    if (part.triangles.cols() == 0) continue;
    part.packets = PackTriangles(part.triangles);
    const bool whole = part.triangles.cols() == builder.model.bodies[b].mesh.triangles.cols();
    part.border = whole ? builder.BorderOf(b) : BoundaryVertices(part.triangles);
    parts_.push_back(std::move(part));
  }
  if (triangles() > before) return absl::OkStatus();
  return FieldError(path, "chooses no triangle: name bodies with a surface, and extend region and facing");
}

absl::Status Chamber::SetPlane(const v1::Plane* scene, std::string_view path) {
  Vector sum = Vector::Zero(), normal = Vector::UnitZ();
  double count = 0;
  for (const Part& part : parts_) {
    for (const int i : part.border) sum += part.points.rest().col(i), ++count;
  }
  Vector point =
      count > 0 ? Vector(sum / count) : Vector(parts_.front().points.rest().col(parts_.front().triangles(0, 0)));
  absl::StrAppend(&key_, "/", scene == nullptr ? "" : scene->SerializeAsString());
  if (scene != nullptr) {
    point = ToEigen(scene->point());
    if (scene->has_normal()) normal = ToEigen(scene->normal());
  }
  if (!(normal.norm() > 0)) {
    return FieldError(absl::StrCat(std::string(path), ".normal"), "has no direction: set x, y or z");
  }
  normal.normalize();
  axes_ = AxesOf(normal);
  height_ = normal.dot(point);
  rest_volume_ = VolumeAtRest();
  return absl::OkStatus();
}

double Chamber::VolumeAtRest() const {
  double sum = 0;
  Points memory;
  for (const Part& part : parts_) {
    sum += part.side * SumTriangles(part.packets, height_, Turn(axes_, part.points.rest(), memory).data()).volume;
  }
  return sum;
}

ChamberReading Chamber::Sum(ChamberReadings::What what, const EvalContext& at) const {
  const ChamberReading* const found = at.readings == nullptr ? nullptr : at.readings->Find(key_, what);
  if (found != nullptr) return *found;
  TurnedPoints& turned = at.scratch.Get<TurnedPoints>();
  ChamberReading sum;
  for (const Part& part : parts_) {
    ChamberReading reading;
    if (what == ChamberReadings::What::kVolume) {
      reading = SumTriangles(part.packets, height_, Turn(axes_, part.points.Positions(at), turned.x).data());
    } else {
      const BodyPoints::Moving body = part.points.Locate(at);
      const ConstPoints x = Turn(axes_, body.x, turned.x), v = Turn(axes_, body.v, turned.v);
      reading = SumTriangles(part.packets, height_, x.data(), v.data());
    }
    sum.volume += part.side * reading.volume;
    sum.flow += part.side * reading.flow;
  }
  if (at.readings != nullptr) at.readings->Add(key_, what, sum);
  return sum;
}

double Chamber::Volume(const EvalContext& at) const { return Sum(ChamberReadings::What::kVolume, at).volume; }

ChamberReading Chamber::Read(const EvalContext& at) const { return Sum(ChamberReadings::What::kFlowToo, at); }

void Chamber::AddAreas(const EvalContext& at, double scale, MutablePoints f) const {
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

const Points& Chamber::AreaVectors(const EvalContext& at) const {
  Points& a = at.scratch.Get<Areas>().a;
  a.setZero(3, at.x.cols());
  AddAreas(at, 1, a);
  return a;
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
