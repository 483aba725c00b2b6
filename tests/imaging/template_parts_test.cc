// What a volume does not show is filled from the template: distances to the known truth, marks, and the verdict.
#include "server/imaging/patient/template_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "server/imaging/label_surface.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/patient/patient.h"
#include "server/imaging/phantom.h"
#include "server/mesh/triangle_tree.h"
#include "server/schema/schema.h"

namespace phrenic::imaging {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kVoxelSize = 4;  // [mm]

v1::LabelMap Names() { return *ReadLabelMap("totalsegmentator"); }

bool IsCage(const v1::LabelMeaning& label) {
  const v1::Structure structure = label.anatomy().structure();
  return structure == v1::STRUCTURE_RIB || structure == v1::STRUCTURE_COSTAL_CARTILAGE ||
         structure == v1::STRUCTURE_STERNUM_BODY || structure == v1::STRUCTURE_MANUBRIUM ||
         structure == v1::STRUCTURE_XIPHOID;
}
bool IsLung(const v1::LabelMeaning& label) { return label.anatomy().structure() == v1::STRUCTURE_LUNG; }

// Returns a phantom without the labels that fulfil the condition. Keeps the whole ones.
LabelVolume Without(bool (*gone)(const v1::LabelMeaning&), const PhantomBody& body) {
  static std::map<std::string, LabelVolume> made;
  if (!made.contains(body.name)) made[body.name] = *MakePhantom(body, {kVoxelSize, 0.02, 20, 1}, Names());
  LabelVolume volume = made[body.name];
  const v1::LabelMap map = Names();
  for (const v1::LabelMeaning& label : map.labels()) {
    if (gone(label)) std::replace(volume.labels.begin(), volume.labels.end(), Label(label.number()), Label(0));
  }
  return volume;
}

std::vector<Part> Seen(const LabelVolume& volume) {
  Fallbacks ignored;
  return *FindParts(volume, Names(), ignored);
}

// Distances of surfaces [mm].
struct Distance {
  double assd = 0, hd95 = 0;
};

std::vector<double> OneWay(const Mesh& from, const Mesh& to) {
  const TriangleTree tree(to.vertices, to.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(to.vertices, boxes);
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < from.vertices.cols(); ++i) {
    distances.push_back(1e3 * std::sqrt(tree.Nearest(to.vertices, boxes, from.vertices.col(i), 1).squared));
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

Distance Between(const Mesh& a, const Mesh& b) {
  Distance distance;
  for (const auto& way : {OneWay(a, b), OneWay(b, a)}) {
    for (const double one : way) distance.assd += one / static_cast<double>(2 * way.size());
    distance.hd95 = std::max(distance.hd95, way[way.size() * 95 / 100]);
  }
  return distance;
}

// Returns the mean ASSD and the largest HD95 of the filled parts of a structure to the truth.
Distance OffTruth(const FilledParts& filled, v1::Structure structure, const PhantomBody& body) {
  Distance all;
  int count = 0;
  for (const Part& part : filled.parts) {
    if (!part.filled || !part.Is(structure)) continue;
    const bool made = part.surface.triangles.cols() > 0;
    const Mesh surface = made ? part.surface : *SurfaceOf(filled.volume, part.mask, 6);
    const Distance one = Between(surface, *PhantomPart(body, part.anatomy, 6));
    all.assd += one.assd;
    all.hd95 = std::max(all.hd95, one.hd95);
    ++count;
  }
  all.assd /= count;
  return all;
}

// The template in its own size, its origin where the phantom's is.
TemplateFit Unregistered(const PhantomBody& body) {
  TemplateFit fit;
  fit.shift = body.shift;
  return fit;
}

TEST(TemplateParts, RibsAreFilledFromLungsAndSpineCloserThanTheUnregisteredTemplate) {
  for (const char* name : {"small", "flat"}) {
    const PhantomBody body = *FindPhantomBody(name);
    const LabelVolume volume = Without(IsCage, body);
    const FilledParts filled = FillFromTemplate(volume, Seen(volume));
    EXPECT_THAT(filled.report.not_filled(), IsEmpty());
    EXPECT_EQ(filled.report.parts_size(), 24 + 3 + 20) << "ribs, the sternum's parts, cartilages";
    const Distance off = OffTruth(filled, v1::STRUCTURE_RIB, body);
    const TemplateFit fit = Unregistered(body);
    const Distance without = OffTruth(FillFromTemplate(volume, Seen(volume), &fit), v1::STRUCTURE_RIB, body);
    std::printf("ribs of %s from lungs and spine: assd %.1f mm, hd95 %.1f mm; unregistered %.1f and %.1f\n", name,
                off.assd, off.hd95, without.assd, without.hd95);
    EXPECT_LT(off.assd, 2);
    EXPECT_LT(off.hd95, 6);
    EXPECT_LT(off.assd, 0.8 * without.assd);
  }
}

TEST(TemplateParts, LungsAreFilledFromRibsAndSpineCloserThanTheUnregisteredTemplate) {
  const PhantomBody body = *FindPhantomBody("small");
  const LabelVolume volume = Without(IsLung, body);
  const FilledParts filled = FillFromTemplate(volume, Seen(volume));
  EXPECT_THAT(filled.report.parts(), testing::ElementsAre("lung-right", "lung-left"));
  const Distance off = OffTruth(filled, v1::STRUCTURE_LUNG, body);
  const TemplateFit fit = Unregistered(body);
  const Distance without = OffTruth(FillFromTemplate(volume, Seen(volume), &fit), v1::STRUCTURE_LUNG, body);
  std::printf("lungs of small from ribs and spine: assd %.1f mm, hd95 %.1f mm; unregistered %.1f and %.1f\n", off.assd,
              off.hd95, without.assd, without.hd95);
  EXPECT_LT(off.assd, 2);
  EXPECT_LT(off.hd95, 6);
  EXPECT_LT(off.assd, 0.8 * without.assd);
}

TEST(TemplateParts, AWholeVolumeIsNotFilled) {
  const LabelVolume volume = Without([](const v1::LabelMeaning&) { return false; }, *FindPhantomBody("adult"));
  const std::vector<Part> seen = Seen(volume);
  const FilledParts filled = FillFromTemplate(volume, seen);
  EXPECT_THAT(filled.report.parts(), IsEmpty());
  EXPECT_EQ(filled.parts.size(), seen.size());
  EXPECT_EQ(filled.volume.size, volume.size);
}

TEST(TemplateParts, AGridThatIsTooSmallGrowsAndKeepsItsPlace) {
  const PhantomBody body = *FindPhantomBody("adult");
  LabelVolume volume = Without(IsCage, body);
  const std::vector<Part> before = Seen(volume);
  const FilledParts wide = FillFromTemplate(volume, before);
  // Keeps the slices along i that hold the lungs alone.
  Eigen::Vector3i low = volume.size, high = Eigen::Vector3i::Zero();
  for (const Part& part : before) {
    if (!part.Is(v1::STRUCTURE_LUNG)) continue;
    low = low.cwiseMin(part.mask.low);
    high = high.cwiseMax(part.mask.low + part.mask.size);
  }
  LabelVolume narrow = volume;
  narrow.size.x() = high.x() - low.x();
  narrow.to_patient = volume.to_patient * Eigen::Translation3d(low.x(), 0, 0);
  narrow.labels.clear();
  for (int k = 0; k < volume.size.z(); ++k) {
    for (int j = 0; j < volume.size.y(); ++j) {
      for (int i = low.x(); i < high.x(); ++i) narrow.labels.push_back(volume.labels[volume.Index({i, j, k})]);
    }
  }
  const FilledParts grown = FillFromTemplate(narrow, Seen(narrow));
  EXPECT_GT(grown.volume.size.x(), narrow.size.x());
  const auto rib = [](const FilledParts& filled) -> const Part& {
    return *std::find_if(filled.parts.begin(), filled.parts.end(),
                         [](const Part& part) { return part.name == "rib-7-left"; });
  };
  EXPECT_LT((rib(grown).mask.Position(grown.volume, 0) - rib(wide).mask.Position(wide.volume, 0)).norm(),
            2 * kVoxelSize);
}

TEST(TemplateParts, WithoutAnythingToRegisterToNothingIsFilledAndTheReasonSaid) {
  const LabelVolume volume =
      Without([](const v1::LabelMeaning& label) { return IsCage(label) || IsLung(label); }, *FindPhantomBody("adult"));
  const FilledParts filled = FillFromTemplate(volume, Seen(volume));
  EXPECT_THAT(filled.report.parts(), IsEmpty());
  EXPECT_THAT(filled.report.not_filled(), HasSubstr("two whole lungs, or to 4 whole ribs of each side"));
}

v1::Scene ThoraxScene() {
  std::ifstream file(PHRENIC_SCENES_DIR "/thorax.textproto");
  std::stringstream text;
  text << file.rdbuf();
  return *schema::ParseScene("thorax.textproto", text.str());
}

absl::StatusOr<Patient> MakeCoarse(const LabelVolume& volume, bool fill) {
  PatientOptions options;
  options.edge_length = 8;
  options.diaphragm.vertices = 2500;
  options.fill = fill;
  return MakePatient(volume, Names(), ThoraxScene(), options, [](double, std::string_view) { return true; });
}

TEST(TemplateParts, APatientWithoutRibsIsFilledMarkedAndNeverBetterThanWithCare) {
  const PhantomBody body = *FindPhantomBody("small");
  const LabelVolume volume = Without(IsCage, body);
  EXPECT_THAT(std::string(MakeCoarse(volume, false).status().message()), HasSubstr("no ribs")) << "without filling";
  const auto patient = MakeCoarse(volume, true);
  ASSERT_TRUE(patient.ok()) << patient.status();
  const v1::PatientReport& report = patient->report;
  EXPECT_EQ(report.readiness().verdict(), v1::READINESS_VERDICT_USABLE_WITH_CARE) << report.readiness().DebugString();
  EXPECT_THAT(report.readiness().findings(0).what(), HasSubstr("filled from the generated thorax"));
  EXPECT_THAT(report.fallbacks(), Contains(HasSubstr("from the generated thorax, scaled by 0.8")));
  ASSERT_EQ(report.assumptions_size(), report.fallbacks_size());
  for (int i = 0; i < report.assumptions_size(); ++i) {
    const v1::Assumption& assumption = report.assumptions(i);
    const bool scaled = report.fallbacks(i).find("scaled by") != std::string::npos;
    EXPECT_EQ(assumption.kind() == v1::ASSUMPTION_KIND_TEMPLATE, scaled) << report.fallbacks(i);
    if (scaled) {
      EXPECT_EQ(assumption.parts_size(), report.fill().parts_size());
      EXPECT_EQ(assumption.values_size(), 4);
    }
  }
  EXPECT_GT(report.fill().diaphragm_share(), 0.1) << "the wall is the template's";
  for (const v1::PatientSurface& surface : report.surfaces()) {
    EXPECT_EQ(surface.from_template(), surface.label_volume_ml() == 0) << surface.body();
    const auto made = std::find_if(patient->bodies.begin(), patient->bodies.end(),
                                   [&surface](const PatientBody& one) { return one.name == surface.body(); });
    const auto marked = made->mesh.regions.find(kFromTemplate);
    const std::size_t vertices = marked == made->mesh.regions.end() ? 0 : marked->second.size();
    EXPECT_EQ(vertices, surface.from_template() ? static_cast<std::size_t>(surface.vertices()) : 0U) << surface.body();
  }
  v1::Anatomy sheet;
  sheet.set_structure(v1::STRUCTURE_DIAPHRAGM);
  Mesh truth = *PhantomPart(body, sheet, 6);
  truth.vertices.row(0).array() += 1e-3 * report.moved_left_mm();
  const Distance off = Between(patient->bodies.front().mesh, truth);
  std::printf("diaphragm without ribs: assd %.1f mm, hd95 %.1f mm\n", off.assd, off.hd95);
  EXPECT_LT(off.assd, 6);
}

}  // namespace
}  // namespace phrenic::imaging
