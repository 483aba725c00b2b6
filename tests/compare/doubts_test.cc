// Comparisons of surfaces with a wrong unit or frame say so.
#include "server/compare/doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/compare/comparison.h"
#include "server/mesh/ellipsoid.h"
#include "server/mesh/units.h"
#include "tests/compare/surfaces.h"

namespace phrenic::compare {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A body of 160 x 120 x 200 mm, in front of the origin, as organs lie in scans.
Mesh Organ(double scale = 1) {
  Mesh mesh = EllipsoidSurface(Eigen::Vector3d(0.03, -0.12, 0.5), Eigen::Vector3d(0.08, 0.06, 0.1), 8, false);
  mesh.vertices *= scale;
  return mesh;
}

std::vector<std::string> DoubtsOf(const Mesh& a, const Mesh& b) {
  const MeasuredSurface one = Measured(a), other = Measured(b);
  double sum = 0;
  for (const auto point : one.vertices().colwise()) sum += other.Nearest(point).offset.norm();
  return Doubts(one, other, sum / static_cast<double>(one.vertices().cols()));
}

TEST(Doubts, AreNoneAboutTwoScansOfAnOrgan) {
  EXPECT_THAT(DoubtsOf(Organ(), Organ()), IsEmpty());
  EXPECT_THAT(DoubtsOf(Organ(), Organ(1.3)), IsEmpty());
  EXPECT_THAT(DoubtsOf(Organ(), Moved(Organ(), {0.02, 0.03, -0.04})), IsEmpty());
}

TEST(Doubts, NameTheUnitOfASurfaceOfAnotherSize) {
  for (const double ratio : {10.0, 25.4, 100.0, 1000.0}) {
    const auto larger = DoubtsOf(Organ(), Organ(1 / ratio));
    ASSERT_FALSE(larger.empty()) << ratio;
    EXPECT_THAT(larger.front(), HasSubstr("is the unit of B " + absl::StrFormat("%g", ratio) + " times as long"));
    const auto smaller = DoubtsOf(Organ(1 / ratio), Organ());
    EXPECT_THAT(smaller.front(), HasSubstr("is the unit of A " + absl::StrFormat("%g", ratio) + " times as long"));
  }
  EXPECT_THAT(DoubtsOf(Organ(), Organ(1 / 4.5)).front(), HasSubstr("are they the same part"));
}

TEST(Doubts, NameTheFrameOfATurnedSurface) {
  Mesh turned = Organ();
  turned.vertices.topRows<2>() *= -1;
  EXPECT_THAT(DoubtsOf(Organ(), turned), testing::Contains(HasSubstr("is one file in RAS?")));
}

TEST(Doubts, NameSurfacesInDifferentPlaces) {
  EXPECT_THAT(DoubtsOf(Organ(), Moved(Organ(), {0, 0, 0.6})),
              ElementsAre(HasSubstr("the surfaces lie in different places")));
}

TEST(Doubts, AreInTheTable) {
  const std::string metres = ObjText(Organ(1e-3)), millimetres = ObjText(Organ());
  v1::CompareRequest request;
  request.mutable_a()->set_name("a.obj");
  request.mutable_a()->set_content(millimetres);
  request.mutable_b()->set_name("b.obj");
  request.mutable_b()->set_content(metres);
  const ComparisonSink sink{
      .progress = [](double) { return true; }, .vertices = nullptr, .map = nullptr, .mesh = nullptr};
  const auto no_bodies = [](const v1::SessionBody&, v1::ComparedState&) -> absl::StatusOr<Mesh> {
    return absl::NotFoundError("there is no session");
  };
  const auto table = Compare(request, no_bodies, sink);
  ASSERT_TRUE(table.ok()) << table.status();
  ASSERT_GT(table->warnings_size(), 0);
  EXPECT_THAT(table->warnings(0), HasSubstr("1000 times as long as assumed (--unit-a, --unit-b)?"));
  request.mutable_b()->set_unit_mm(1000);
  EXPECT_EQ(Compare(request, no_bodies, sink)->warnings_size(), 0);
}

}  // namespace
}  // namespace phrenic::compare
