// Compares the Hausdorff distance with CGAL's bounded_error_Hausdorff_distance on anatomical surfaces.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "server/compare/surface_distance.h"
#include "server/meshio/meshio.h"
#include "tests/compare/surfaces.h"

namespace phrenic::compare {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Converts to CGAL in millimetres. Triangles do not share vertices, so that CGAL accepts non-manifold surfaces.
CgalMesh ToCgal(const Mesh& mesh) {
  CgalMesh cgal;
  const auto add = [&](int vertex) {
    const Eigen::Vector3d x = 1e3 * mesh.vertices.col(vertex);
    return cgal.add_vertex(Kernel::Point_3(x[0], x[1], x[2]));
  };
  for (const auto triangle : mesh.triangles.colwise()) {
    const auto a = add(triangle[0]), b = add(triangle[1]), c = add(triangle[2]);
    cgal.add_face(a, b, c);
  }
  return cgal;
}

void ExpectAgreement(const Mesh& a, const Mesh& b) {
  const auto ours = MeasureDistance(Measured(a), Measured(b), {});
  ASSERT_TRUE(ours.ok()) << ours.status();
  const CgalMesh cgal_a = ToCgal(a), cgal_b = ToCgal(b);
  const double error = 2e-4 * ours->hd_max();
  namespace pmp = CGAL::Polygon_mesh_processing;
  const double a_to_b = pmp::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(cgal_a, cgal_b, error);
  const double b_to_a = pmp::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(cgal_b, cgal_a, error);
  EXPECT_NEAR(ours->hd_a_to_b(), a_to_b, 1e-3 * a_to_b);
  EXPECT_NEAR(ours->hd_b_to_a(), b_to_a, 1e-3 * b_to_a);
  EXPECT_NEAR(ours->hd_max(), std::max(a_to_b, b_to_a), 1e-3 * ours->hd_max());
  EXPECT_LE(ours->hd_max_bound(), ours->hd_max() * 1.001);
  std::printf("A to B: %.5f, CGAL %.5f; B to A: %.5f, CGAL %.5f mm\n", ours->hd_a_to_b(), a_to_b, ours->hd_b_to_a(),
              b_to_a);
}

Mesh Anatomy(const std::string& file) {
  const auto mesh = meshio::ReadFile(std::string(PHRENIC_SHARED_DIR) + "/data/thorax/" + file, 1e-3);
  EXPECT_TRUE(mesh.ok()) << mesh.status();
  return mesh.value_or(Mesh());
}

// Deforms a surface smoothly by up to 1 cm, as a breath does.
Mesh Bent(Mesh mesh) {
  for (auto x : mesh.vertices.colwise()) {
    x[2] += 0.008 * std::sin(x[0] / 0.06) + 0.003;
    x[1] += 0.002 * std::cos(x[2] / 0.04);
  }
  return mesh;
}

class Cgal : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(std::string(PHRENIC_SHARED_DIR) + "/data/thorax/diaphragm.obj")) {
      GTEST_SKIP() << "the anatomical surfaces are missing";
    }
  }
};

TEST_F(Cgal, AgreesOnTheLobesOfALung) {
  ExpectAgreement(Anatomy("lungs/superior_lobe_of_left_lung_closed.obj"),
                  Anatomy("lungs/inferior_lobe_of_left_lung_closed.obj"));
}

TEST_F(Cgal, AgreesOnRibsBesideEachOther) {
  ExpectAgreement(Anatomy("ribs/left_fifth_rib_FJ3232.obj"), Anatomy("ribs/left_sixth_rib_FJ3233.obj"));
}

TEST_F(Cgal, AgreesOnTheDiaphragmAndTheSameBent) {
  ExpectAgreement(Anatomy("diaphragm.obj"), Bent(Anatomy("diaphragm.obj")));
}

}  // namespace
}  // namespace phrenic::compare
