// Irregular sheets of triangles for the exact cases of plates, membranes and shells.
#ifndef PHRENIC_TESTS_EXACT_SHEETS_H_
#define PHRENIC_TESTS_EXACT_SHEETS_H_

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "server/mechanics/compile/compile.h"
#include "server/schema/schema.h"

namespace phrenic {

// One direction of a sheet: cells from 0 to `length`, and further ones beyond its ends, which mirror those within.
struct SheetAxis {
  double length;
  int cells;
  int before = 0, after = 0;
};

// A grid of cells, each divided by a diagonal, at x = 0 to u.length and y = 0 to v.length, z = 0. Vertices are moved at
// random by up to `disorder` times a cell, those of the border along it, and diagonals are chosen at random; 0:
// regular. The corners of the sheet and its middle stay. Region "inside" has the vertices that are not beyond an end.
struct SheetMesh {
  SheetAxis u, v;
  Mesh mesh;

  SheetMesh(const SheetAxis& along_x, const SheetAxis& along_y, double disorder) : u(along_x), v(along_y) {
    Place(disorder);
    std::mt19937 random(11);
    std::vector<bool> rising(static_cast<size_t>(u.cells * v.cells));
    for (size_t cell = 0; cell < rising.size(); ++cell) rising[cell] = disorder > 0 && random() % 2 == 0;
    std::vector<int> corners;
    for (int j = -v.before; j < v.cells + v.after; ++j) {
      for (int i = -u.before; i < u.cells + u.after; ++i) {
        const int a = At(i, j), b = At(i + 1, j), c = At(i + 1, j + 1), d = At(i, j + 1);
        const int column = i < 0 ? -1 - i : i < u.cells ? i : 2 * u.cells - 1 - i;
        const int row = j < 0 ? -1 - j : j < v.cells ? j : 2 * v.cells - 1 - j;
        if (rising[row * u.cells + column] != ((column != i) != (row != j))) {
          corners.insert(corners.end(), {a, b, c, a, c, d});
        } else {
          corners.insert(corners.end(), {a, b, d, b, c, d});
        }
      }
    }
    mesh.triangles = Eigen::Map<Triangles>(corners.data(), 3, static_cast<Eigen::Index>(corners.size() / 3));
  }

  // The vertex number i along x and j along y.
  int At(int i, int j) const { return (j + v.before) * (u.before + u.cells + u.after + 1) + i + u.before; }
  bool Inside(int i, int j) const { return i >= 0 && i <= u.cells && j >= 0 && j <= v.cells; }
  bool OnBorder(int i, int j) const { return i == 0 || i == u.cells || j == 0 || j == v.cells; }
  // Calls `use(i, j)` for each vertex, those beyond the ends too.
  void ForEach(const std::function<void(int, int)>& use) const {
    for (int j = -v.before; j <= v.cells + v.after; ++j) {
      for (int i = -u.before; i <= u.cells + u.after; ++i) use(i, j);
    }
  }
  static int Mirrored(int i, int cells) { return i < 0 ? -i : i > cells ? 2 * cells - i : i; }

 private:
  void Place(double disorder) {
    mesh.vertices.resize(3, At(u.cells + u.after, v.cells + v.after) + 1);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-disorder, disorder);
    for (int j = 0; j <= v.cells; ++j) {
      for (int i = 0; i <= u.cells; ++i) {
        double x = i, y = j;
        const double dx = shift(random), dy = shift(random);
        const bool middle = 2 * i == u.cells && 2 * j == v.cells;
        if (i > 0 && i < u.cells && !middle) x += dx;
        if (j > 0 && j < v.cells && !middle) y += dy;
        mesh.vertices.col(At(i, j)) << x * u.length / u.cells, y * v.length / v.cells, 0;
        mesh.regions["inside"].push_back(At(i, j));
      }
    }
    ForEach([&](int i, int j) {
      if (Inside(i, j)) return;
      mesh.vertices.col(At(i, j)) = mesh.vertices.col(At(Mirrored(i, u.cells), Mirrored(j, v.cells)));
      if (i < 0) mesh.vertices(0, At(i, j)) *= -1;
      if (j < 0) mesh.vertices(1, At(i, j)) *= -1;
      if (i > u.cells) mesh.vertices(0, At(i, j)) = 2 * u.length - mesh.vertices(0, At(i, j));
      if (j > v.cells) mesh.vertices(1, At(i, j)) = 2 * v.length - mesh.vertices(1, At(i, j));
    });
  }
};

// Compiles a scene with one deformable body, "body", of this mesh. `text` has its other fields and elements:
// "fixed_regions: 'clamp' } forces { bending { bodies: 'body' } }".
inline std::shared_ptr<const Model> CompileMesh(const Mesh& mesh, const std::string& text) {
  const auto scene = schema::ParseScene(
      "test", "name: 'exact' bodies { name: 'body' role: ROLE_DEFORMABLE file { path: 'body.msh' } " + text);
  EXPECT_TRUE(scene.ok()) << scene.status();
  if (!scene.ok()) return nullptr;
  const auto model = Compile(*scene, [&mesh](const v1::Body&) { return mesh; });
  EXPECT_TRUE(model.ok()) << model.status();
  return model.ok() ? *model : nullptr;
}

// Returns the load [N] of `pressure(centre)` [Pa] along an axis on the triangles that are not beyond an end, 3 x n.
inline Points AreaLoad(const SheetMesh& sheet, int axis,
                       const std::function<double(const Eigen::Vector3d&)>& pressure) {
  Points load = Points::Zero(3, sheet.mesh.vertices.cols());
  std::vector<bool> inside(static_cast<size_t>(load.cols()), false);
  for (const int i : sheet.mesh.regions.at("inside")) inside[i] = true;
  for (const auto corners : sheet.mesh.triangles.colwise()) {
    if (!inside[corners[0]] || !inside[corners[1]] || !inside[corners[2]]) continue;
    const auto x = [&](int k) { return Eigen::Vector3d(sheet.mesh.vertices.col(corners[k])); };
    const double area = (x(1) - x(0)).cross(x(2) - x(0)).norm() / 2;
    for (int k = 0; k < 3; ++k) load(axis, corners[k]) += area / 3 * pressure((x(0) + x(1) + x(2)) / 3);
  }
  return load;
}

// Returns the orders log2(error / next error) of errors at mesh sizes that halve.
inline std::vector<double> OrdersOf(const std::vector<double>& errors) {
  std::vector<double> orders;
  for (size_t i = 0; i + 1 < errors.size(); ++i) orders.push_back(std::log2(std::abs(errors[i] / errors[i + 1])));
  return orders;
}

// Prints relative errors at meshes that halve, and orders, and records them in GoogleTest's results.
inline void ReportErrors(const std::string& what, const std::vector<double>& errors,
                         const std::vector<double>& orders) {
  std::string text;
  for (const double error : errors) text += absl::StrFormat(" %+.3f %%", 100 * error);
  for (const double order : orders) text += absl::StrFormat(", order %.2f", order);
  std::printf("%s:%s\n", what.c_str(), text.c_str());
  testing::Test::RecordProperty(what, text);
}
inline void ReportErrors(const std::string& what, const std::vector<double>& errors) {
  ReportErrors(what, errors, OrdersOf(errors));
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_EXACT_SHEETS_H_
