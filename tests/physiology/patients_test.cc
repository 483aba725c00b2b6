// Three phantom patients (small, tall, flattened domes) breathe inside the published ranges, or the README lists the
// measure, when their models are made from noisy label volumes.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include "server/imaging/labels/label_map.h"
#include "server/imaging/patient/patient.h"
#include "server/imaging/phantom.h"
#include "server/mechanics/compile/compile.h"
#include "server/physiology/physiology.h"
#include "server/schema/schema.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

v1::Scene ThoraxScene() {
  std::ifstream file(PHRENIC_SOURCE_DIR "/server/scenes/thorax.textproto");
  std::stringstream text;
  text << file.rdbuf();
  return *schema::ParseScene("thorax.textproto", text.str());
}

absl::StatusOr<imaging::Patient> PatientOf(const std::string& body) {
  const v1::LabelMap map = *imaging::ReadLabelMap("totalsegmentator");
  const auto volume = imaging::MakePhantom(*imaging::FindPhantomBody(body), {3, 0.02, 40, 1}, map);
  if (!volume.ok()) return volume.status();
  imaging::PatientOptions options;
  options.name = body;
  options.edge_length = 6;
  options.diaphragm.vertices = 6000;
  return imaging::MakePatient(*volume, map, ThoraxScene(), options, [](double, std::string_view) { return true; });
}

class Patients : public testing::TestWithParam<const char*> {};

TEST_P(Patients, BreatheQuietlyInsideThePublishedRanges) {
  auto patient = PatientOf(GetParam());
  ASSERT_TRUE(patient.ok()) << patient.status();
  patient->scene.clear_presets();  // only the quiet breath
  std::map<std::string, const Mesh*> meshes;
  for (const imaging::PatientBody& body : patient->bodies) meshes[body.name] = &body.mesh;
  const auto model =
      Compile(patient->scene, [&](const v1::Body& body) -> absl::StatusOr<Mesh> { return *meshes.at(body.name()); });
  ASSERT_TRUE(model.ok()) << model.status();
  const auto table = physiology::CheckPhysiology(**model, {}, [](double) { return true; });
  ASSERT_TRUE(table.ok()) << table.status();
  const std::string page = PhysiologyPage("Patients");
  int inside = 0;
  for (const v1::PhysiologyRow& row : table->rows()) {
    if (row.verdict() == v1::VERDICT_NOT_MODELLED || row.verdict() == v1::VERDICT_NOT_JUDGED) continue;
    std::printf("%-6s %-28s %7.2f   accepted %g to %g\n", GetParam(), row.what().c_str(), row.value(), row.low(),
                row.high());
    inside += row.verdict() == v1::VERDICT_INSIDE ? 1 : 0;
    const bool listed = page.find(row.breath() + ": " + row.what()) != std::string::npos;
    EXPECT_TRUE(row.verdict() == v1::VERDICT_INSIDE || listed) << row.what() << ": " << row.value();
  }
  EXPECT_GE(inside, 11);
}

INSTANTIATE_TEST_SUITE_P(Bodies, Patients, testing::Values("small", "tall", "flat"),
                         [](const auto& body) { return std::string(body.param); });

}  // namespace
}  // namespace phrenic
