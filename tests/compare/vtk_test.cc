// Compares mean, RMS and 95th percentile with VTK's nearest points for 100,000 random samples.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "server/compare/surface_distance.h"
#include "server/meshio/meshio.h"
#include "tests/compare/surfaces.h"

namespace phrenic::compare {
namespace {

// Debian's interpreter, for which its VTK is built.
constexpr char kPython[] = "/usr/bin/python3";

TEST(Vtk, AgreesOnTheLobesOfALung) {
  const std::string folder = std::string(PHRENIC_SHARED_DIR) + "/data/thorax/lungs/";
  const std::string a = folder + "superior_lobe_of_left_lung_closed.obj";
  const std::string b = folder + "inferior_lobe_of_left_lung_closed.obj";
  if (!std::filesystem::exists(a)) GTEST_SKIP() << "the anatomical surfaces are missing";
  if (std::system((std::string(kPython) + " -c 'import vtk, numpy' >/dev/null 2>&1").c_str()) != 0) {
    GTEST_SKIP() << "VTK is not installed (python3-vtk9)";
  }
  const std::string out = testing::TempDir() + "phrenic_vtk.txt";
  const std::string script = std::string(PHRENIC_SOURCE_DIR) + "/tests/compare/judges/vtk_distances.py";
  ASSERT_EQ(std::system((std::string(kPython) + " " + script + " " + a + " " + b + " >" + out).c_str()), 0);
  double mean = 0, rms = 0, p95 = 0, largest = 0;
  ASSERT_TRUE(std::ifstream(out) >> mean >> rms >> p95 >> largest);
  const auto ours = MeasureDistance(Measured(*meshio::ReadFile(a, 1e-3)), Measured(*meshio::ReadFile(b, 1e-3)), {});
  ASSERT_TRUE(ours.ok()) << ours.status();
  EXPECT_NEAR(ours->mean_a_to_b(), mean, 0.01 * mean);
  EXPECT_NEAR(ours->rms_a_to_b(), rms, 0.01 * rms);
  EXPECT_NEAR(ours->p95_a_to_b(), p95, 0.01 * p95);
  EXPECT_GE(ours->hd_a_to_b(), largest * (1 - 1e-5)) << "a sample of VTK is farther than the maximum";
  std::printf("mean %.4f, VTK %.4f; RMS %.4f, VTK %.4f; p95 %.4f, VTK %.4f mm\n", ours->mean_a_to_b(), mean,
              ours->rms_a_to_b(), rms, ours->p95_a_to_b(), p95);
}

}  // namespace
}  // namespace phrenic::compare
