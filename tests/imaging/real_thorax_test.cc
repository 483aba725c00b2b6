// Filling from the template in the surfaces of a real thorax, which the template was not made from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "server/imaging/derived_diaphragm.h"
#include "server/imaging/patient/patient.h"
#include "server/imaging/patient/template_parts.h"
#include "server/imaging/surfaces/derived_thorax.h"
#include "server/imaging/surfaces/voxelised_parts.h"
#include "server/imaging/voxelise.h"
#include "server/mesh/triangle_tree.h"
#include "server/meshio/meshio.h"
#include "server/schema/schema.h"

namespace phrenic::imaging {
namespace {

const std::filesystem::path kRealFolder = std::filesystem::path(PHRENIC_SHARED_DIR) / "data";

// Returns the mean distance of a's vertices from b [mm].
double MeanTo(const Mesh& a, const Mesh& b) {
  const TriangleTree tree(b.vertices, b.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(b.vertices, boxes);
  double sum = 0;
  for (Eigen::Index i = 0; i < a.vertices.cols(); ++i) {
    sum += 1e3 * std::sqrt(tree.Nearest(b.vertices, boxes, a.vertices.col(i), 1).squared);
  }
  return sum / static_cast<double>(a.vertices.cols());
}

double Assd(const Mesh& a, const Mesh& b) { return (MeanTo(a, b) + MeanTo(b, a)) / 2; }

class RealThorax : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!std::filesystem::exists(kRealFolder)) return;
    std::ifstream file(PHRENIC_SCENES_DIR "/thorax-patient.textproto");
    std::stringstream text;
    text << file.rdbuf();
    const v1::Scene scene = *schema::ParseScene("thorax-patient.textproto", text.str());
    const BodySource source = [](const v1::Body& body) {
      return meshio::ReadFile((kRealFolder / body.file().path()).string(), body.file().unit());
    };
    std::vector<PatientBody> bodies = *ReadSurfaces(source, scene);
    for (PatientBody& body : bodies) {
      (body.anatomy.structure() == v1::STRUCTURE_DIAPHRAGM ? diaphragm_ : surfaces_).push_back(std::move(body));
    }
    seen_ = *VoxeliseParts(surfaces_);
  }
  void SetUp() override {
    if (surfaces_.empty()) GTEST_SKIP() << "no " << kRealFolder;
  }
  static FilledParts FillWithout(const std::function<bool(const Part&)>& gone, const TemplateFit* fit = nullptr) {
    std::vector<Part> parts = seen_.parts;
    std::erase_if(parts, gone);
    return FillFromTemplate(seen_.volume, std::move(parts), fit);
  }
  // Returns the mean distance of the filled ribs from the real ones [mm].
  static double RibsOff(const FilledParts& filled) {
    double sum = 0, count = 0;
    for (const Part& part : filled.parts) {
      const auto real = std::ranges::find_if(surfaces_, [&part](const PatientBody& body) {
        return body.anatomy.SerializeAsString() == part.anatomy.SerializeAsString();
      });
      if (!part.filled || !part.Is(v1::STRUCTURE_RIB) || real == surfaces_.end()) continue;
      sum += Assd(part.surface, real->mesh), ++count;
    }
    return sum / count;
  }
  static double DiaphragmOff(const LabelVolume& volume, const std::vector<Part>& parts) {
    Fallbacks ignored;
    const auto frame = FindCageFrame(volume, parts, ignored);
    const FittedCage cage(volume, parts, *frame, ignored);
    DiaphragmOptions options;
    options.vertices = 2500;
    const auto derived = DeriveDiaphragm(volume, parts, *frame, cage, options, ignored);
    EXPECT_TRUE(derived.ok()) << derived.status();
    return derived.ok() ? Assd(derived->mesh, diaphragm_.front().mesh) : 1e3;
  }

  inline static std::vector<PatientBody> surfaces_, diaphragm_;
  inline static VoxelisedParts seen_;
};

bool IsOfCage(const Part& part) {
  return part.Is(v1::STRUCTURE_RIB) || part.Is(v1::STRUCTURE_COSTAL_CARTILAGE) || part.Is(v1::STRUCTURE_STERNUM_BODY) ||
         part.Is(v1::STRUCTURE_MANUBRIUM) || part.Is(v1::STRUCTURE_XIPHOID);
}

// This person has about the template's size: scaled by what is seen of lungs and spine, its ribs are no closer than in
// their own size at the same place.
TEST_F(RealThorax, RibsFromLungsAndSpineAreNearTheRealOnes) {
  const FilledParts filled = FillWithout(IsOfCage);
  ASSERT_TRUE(filled.report.not_filled().empty()) << filled.report.not_filled();
  std::vector<Part> rest = seen_.parts;
  std::erase_if(rest, IsOfCage);
  const auto fit = FitTemplate(seen_.volume, rest, false);
  ASSERT_TRUE(fit.ok()) << fit.status();
  const Eigen::Vector3d centre(0, 20, 200);  // of the template [mm]
  TemplateFit unscaled;
  unscaled.shift = fit->ToPerson(centre) - centre;
  std::printf("real thorax, ribs from lungs and spine: assd %.1f mm, fit %.1f mm; unscaled %.1f mm\n", RibsOff(filled),
              filled.report.residual_mm(), RibsOff(FillWithout(IsOfCage, &unscaled)));
  EXPECT_LT(RibsOff(filled), 8);
}

TEST_F(RealThorax, TheFilledHeartKeepsTheSheetDown) {
  const FilledParts filled = FillWithout([](const Part&) { return false; });
  const double off = DiaphragmOff(filled.volume, filled.parts), without = DiaphragmOff(seen_.volume, seen_.parts);
  std::printf("real thorax without heart and liver, diaphragm: assd %.1f mm filled, %.1f mm not filled\n", off,
              without);
  EXPECT_LT(off, 5);
  EXPECT_LT(off, 0.7 * without);
}

// Returns the surfaces as labels of a file with voxels of this size, without heart and liver, which they lack.
LabelVolume Voxelised(const std::vector<PatientBody>& bodies, const LabelVolume& grid, double voxel,
                      v1::LabelMap& map) {
  LabelVolume volume;
  const Eigen::Vector3d finer = grid.Spacing() / voxel;
  volume.size = grid.size.cast<double>().cwiseProduct(finer).array().ceil().cast<int>();
  volume.to_patient = grid.to_patient;
  volume.to_patient.linear() = grid.to_patient.linear() * finer.cwiseInverse().asDiagonal();
  volume.labels.assign(static_cast<std::size_t>(volume.size.cast<std::int64_t>().prod()), 0);
  for (const PatientBody& body : bodies) {
    v1::LabelMeaning& label = *map.add_labels();
    label.set_number(map.labels_size());
    label.set_name(body.name);
    *label.mutable_anatomy() = body.anatomy;
    const Mask mask = VoxeliseMask(body.mesh, volume, 0);
    for (int k = 0; k < mask.size.z(); ++k) {
      for (int j = 0; j < mask.size.y(); ++j) {
        for (int i = 0; i < mask.size.x(); ++i) {
          const Eigen::Vector3i at = mask.low + Eigen::Vector3i(i, j, k);
          if (mask.inside[mask.Index(i, j, k)] == 0 || !volume.Contains(at)) continue;
          volume.labels[volume.Index(at)] = static_cast<Label>(label.number());
        }
      }
    }
  }
  return volume;
}

// All steps of `phrenic patient`.
TEST_F(RealThorax, ItsLabelsOf2MmHaveItsDiaphragmWithoutATower) {
  v1::LabelMap map;
  const LabelVolume volume = Voxelised(surfaces_, seen_.volume, 2, map);
  std::ifstream file(PHRENIC_SCENES_DIR "/thorax.textproto");
  std::stringstream text;
  text << file.rdbuf();
  PatientOptions options;
  options.edge_length = 6;
  options.diaphragm.vertices = 2500;
  const auto patient = MakePatient(volume, map, *schema::ParseScene("thorax.textproto", text.str()), options,
                                   [](double, std::string_view) { return true; });
  ASSERT_TRUE(patient.ok()) << patient.status();
  Mesh real = diaphragm_.front().mesh;
  real.vertices.row(0).array() += 1e-3 * patient->report.moved_left_mm();
  const double off = Assd(patient->bodies.front().mesh, real);
  const v1::Readiness& readiness = patient->report.readiness();
  std::printf("real thorax, labels of 2 mm: diaphragm assd %.1f mm, %s\n", off,
              v1::ReadinessVerdict_Name(readiness.verdict()).c_str());
  EXPECT_LT(off, 5);
  for (const v1::ReadinessFinding& finding : readiness.findings()) {
    std::printf("  %s\n", finding.what().c_str());
    EXPECT_NE(finding.kind(), v1::FINDING_KIND_TOWER) << finding.what();
  }
}

}  // namespace
}  // namespace phrenic::imaging
