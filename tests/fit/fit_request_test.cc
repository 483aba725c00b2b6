// A fit as a server is asked for it: refused by file and line or by field, with the numbers of FitMotion.
#include "server/fit/fit_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "absl/strings/str_cat.h"
#include "tests/fit/person_truth.h"
#include "tests/fit/synthetic_person.h"

namespace phrenic::fit {
namespace {

using testing::HasSubstr;

constexpr char kPairsHeader[] = "exhale_x,exhale_y,exhale_z,inhale_x,inhale_y,inhale_z\n";

v1::FitMotionRequest RequestOf(const std::string& content, const std::string& name = "pairs.csv") {
  v1::FitMotionRequest request;
  request.mutable_source()->set_name("thorax");
  v1::LandmarkFile& file = *request.add_landmarks();
  file.set_name(name);
  file.set_content(content);
  return request;
}

std::string RefusalOf(const v1::FitMotionRequest& request) {
  return std::string(ReadFitRequest(request).status().message());
}

std::string PairLines(int count) {
  std::string lines = kPairsHeader;
  for (int i = 0; i < count; ++i) absl::StrAppend(&lines, i, ",2,3,4,5,6\n");
  return lines;
}

v1::Body NamedLung(Side side) {
  v1::Body body;
  body.set_name(side == kLeft ? "lung-left" : "lung-right");
  body.mutable_anatomy()->set_structure(v1::STRUCTURE_LUNG);
  body.mutable_anatomy()->set_side(side == kLeft ? v1::SIDE_LEFT : v1::SIDE_RIGHT);
  body.mutable_generated()->set_resolution_mm(8);
  return body;
}

v1::Scene TwoLungs() {
  v1::Scene scene;
  scene.set_name("two-lungs");
  *scene.add_bodies() = NamedLung(kRight);
  *scene.add_bodies() = NamedLung(kLeft);
  return scene;
}

// Returns the generated lungs, changed by `change`.
MeshSource Changed(const std::function<void(Mesh&)>& change) {
  return [change](const v1::Body& body) -> absl::StatusOr<Mesh> {
    Mesh lung = GeneratedLung(body.anatomy().side() == v1::SIDE_LEFT ? kLeft : kRight);
    change(lung);
    return lung;
  };
}

TEST(FitRequest, SetsWhatIsLeftOut) {
  v1::FitMotionRequest request = RequestOf(PairLines(3));
  auto requested = ReadFitRequest(request);
  ASSERT_TRUE(requested.ok()) << requested.status();
  EXPECT_EQ(requested->landmarks.size(), 3);
  EXPECT_EQ(requested->options.numbers, FitOptions().numbers);
  EXPECT_EQ(requested->options.split, FitOptions().split);
  EXPECT_EQ(requested->scene_name, "person");
  EXPECT_EQ(requested->source, "pairs.csv");
  request.set_modes(12);
  request.set_split(4294967295);
  request.set_assimilate(true);
  request.set_scene_name("anna-2");
  request.mutable_landmarks(0)->set_name("Lungen von \xc3\x84nne.csv");
  requested = ReadFitRequest(request);
  ASSERT_TRUE(requested.ok()) << requested.status();
  EXPECT_EQ(requested->options.numbers, 12);
  EXPECT_EQ(requested->options.split, 4294967295U);
  EXPECT_TRUE(requested->options.assimilate);
  EXPECT_EQ(requested->scene_name, "anna-2");
  EXPECT_EQ(requested->source, "landmarks");
}

TEST(FitRequest, PairsTwoFiles) {
  v1::FitMotionRequest request = RequestOf("x,y,z\n1,2,3\n", "exhale.csv");
  *request.add_landmarks() = RequestOf("x,y,z\n1,2,13\n", "inhale.csv").landmarks(0);
  const auto requested = ReadFitRequest(request);
  ASSERT_TRUE(requested.ok()) << requested.status();
  EXPECT_NEAR(requested->landmarks.motion(2, 0), 0.01, 1e-12);
  EXPECT_EQ(requested->source, "exhale.csv and inhale.csv");
  *request.add_landmarks() = request.landmarks(0);
  EXPECT_THAT(RefusalOf(request), HasSubstr("landmarks: 3 files"));
}

TEST(FitRequest, IsRefusedByFileAndLineOrByField) {
  EXPECT_THAT(RefusalOf(RequestOf(absl::StrCat(PairLines(1), "1,2,?,4,5,6\n"))), HasSubstr("pairs.csv:3: \"?\""));
  EXPECT_THAT(RefusalOf(RequestOf("1\n", "")), HasSubstr("landmarks[0]:1:"));
  EXPECT_THAT(RefusalOf(RequestOf("", std::string(256, 'a'))), HasSubstr("landmarks[0].name: has 256 characters"));
  EXPECT_THAT(RefusalOf(RequestOf(PairLines(kMostPairs + 1))),
              HasSubstr("landmarks: 20001 pairs are more than 20000: send every 2th"));
  v1::FitMotionRequest request = RequestOf(PairLines(3));
  request.set_modes(10);
  EXPECT_THAT(RefusalOf(request), HasSubstr("modes: 10 is neither 8 nor 12"));
  request.set_modes(8);
  request.set_scene_name("../x");
  EXPECT_THAT(RefusalOf(request), HasSubstr("scene_name: "));
  request.set_scene_name("");
  request.set_show_landmarks(true);
  request.set_assimilate(true);
  EXPECT_THAT(RefusalOf(request), HasSubstr("leave assimilate out"));
}

TEST(FitRequest, SendsTheNumbersOfTheFit) {
  const SceneLungs lungs{{NamedLung(kRight), NamedLung(kLeft)}, GeneratedLungs()};
  RequestedFit requested;
  requested.landmarks = SyntheticPerson(150);
  requested.options.assimilate = true;
  requested.scene_name = "anna";
  requested.source = "made up";
  const auto result = FitRequested(requested, lungs, {});
  ASSERT_TRUE(result.ok()) << result.status();
  const auto fit = FitMotion(lungs.templates, requested.landmarks, requested.options);
  ASSERT_TRUE(fit.ok());
  EXPECT_EQ(result->held_out().mean_mm(), 1000 * fit->held_out.mean);
  EXPECT_EQ(result->assimilated().p95_mm(), 1000 * fit->assimilated->p95);
  ASSERT_EQ(result->parameters_size(), 8);
  EXPECT_EQ(result->parameters(3).value_mm(), 1000 * fit->parameters[3].value);
  EXPECT_EQ(result->correlation(8 * 2 + 5), fit->correlation(2, 5));
  EXPECT_EQ(result->points().held_out_size(), 150);
  ASSERT_EQ(result->points().predicted().size(), sizeof(double) * 3 * 300);
  double second_y = 0;
  std::memcpy(&second_y, result->points().predicted().data() + 4 * sizeof(double), sizeof(double));
  EXPECT_EQ(second_y, fit->predicted(1, 1));
  EXPECT_EQ(result->scene().name(), "anna");
  EXPECT_THAT(result->scene().description(), HasSubstr("made up"));
  const auto cancelled = FitRequested(requested, lungs, [](double, auto) { return false; });
  EXPECT_EQ(cancelled.status().code(), absl::StatusCode::kCancelled);
}

v1::MeasuredFile& AddMeasured(v1::MeasuredKind kind, const fit::MeasuredFile& file, v1::FitMotionRequest& request) {
  v1::MeasuredFile& sent = *request.add_measured();
  sent.set_kind(kind);
  sent.set_name(file.name);
  sent.set_content(file.bytes);
  return sent;
}

TEST(FitRequest, OfSeveralKindsSendsTheNumbersOfTheJointFit) {
  const PersonTruth& truth = PersonTruth::One();
  v1::FitMotionRequest request;
  request.mutable_source()->set_name("thorax");
  AddMeasured(v1::MEASURED_KIND_EXHALE, truth.Exhale(), request);
  AddMeasured(v1::MEASURED_KIND_LANDMARKS, truth.Landmarks(0.001), request).set_error(2);
  AddMeasured(v1::MEASURED_KIND_VOLUME, truth.Volume(), request);
  const auto requested = ReadFitRequest(request);
  ASSERT_TRUE(requested.ok()) << requested.status();
  EXPECT_EQ(requested->source, "exhale.csv, pairs-1.csv, spiro.csv");
  const SceneLungs lungs{{NamedLung(kRight), NamedLung(kLeft)}, GeneratedLungs()};
  const auto result = FitRequested(*requested, lungs, {});
  ASSERT_TRUE(result.ok()) << result.status();
  const auto fit = FitJointly(GeneratedLungs(), *requested->evidence, {});
  ASSERT_TRUE(fit.ok()) << fit.status();
  ASSERT_EQ(result->numbers_size(), static_cast<int>(fit->numbers.size()));
  EXPECT_EQ(result->numbers(2).value(), fit->numbers[2].value / 1e-3);
  EXPECT_EQ(result->kinds_size(), 3);
  EXPECT_EQ(result->kinds(0).error(), 2);
  EXPECT_EQ(result->parameters_size(), 8);
  EXPECT_EQ(result->derived(0).unit(), "l");
  EXPECT_TRUE(result->own_lungs());
  EXPECT_NEAR(result->scene().parameters().breath_length(), 4.4, 0.1);
}

TEST(FitRequest, OfAColumnPhaseIsOfSeveralTimes) {
  v1::FitMotionRequest request =
      RequestOf("exhale_x,exhale_y,exhale_z,inhale_x,inhale_y,inhale_z,phase\n1,2,3,1,2,1,0.5\n1,2,3,1,2,-1,1\n");
  const auto requested = ReadFitRequest(request);
  ASSERT_TRUE(requested.ok()) << requested.status();
  ASSERT_TRUE(requested->evidence.has_value());
  EXPECT_EQ(requested->evidence->landmarks.phase[0], 0.5);
  EXPECT_EQ(requested->source, "pairs.csv");
  request.set_assimilate(true);
  EXPECT_THAT(RefusalOf(request), HasSubstr("assimilate: belongs to landmarks of one time"));
  request = RequestOf("exhale_x,exhale_y,exhale_z,inhale_x,inhale_y,inhale_z,phase\n1,2,3,1,2,1,2\n");
  EXPECT_THAT(RefusalOf(request), HasSubstr("pairs.csv:2: the phase must be above 0"));
}

TEST(FitRequest, OfSeveralKindsIsRefusedByFileOrByField) {
  v1::FitMotionRequest request = RequestOf(PairLines(3));
  AddMeasured(v1::MEASURED_KIND_VOLUME, PersonTruth::One().Volume(), request);
  EXPECT_THAT(RefusalOf(request), HasSubstr("landmarks: give them among measured"));
  request.clear_landmarks();
  request.set_assimilate(true);
  EXPECT_THAT(RefusalOf(request), HasSubstr("assimilate: belongs to landmarks alone"));
  request.set_assimilate(false);
  request.mutable_measured(0)->set_content("time_s,volume_l\n1,x\n");
  EXPECT_THAT(RefusalOf(request), HasSubstr("spiro.csv:2: \"x\" in column 2"));
  request.mutable_measured(0)->set_side(v1::SIDE_LEFT);
  EXPECT_THAT(RefusalOf(request), HasSubstr("measured[0].side: only an M-mode has a side"));
  request.mutable_measured(0)->clear_side();
  request.mutable_measured(0)->set_kind(v1::MEASURED_KIND_UNSPECIFIED);
  EXPECT_THAT(RefusalOf(request), HasSubstr("measured[0].kind: is unknown"));
  request.clear_measured();
  for (const double error : {1.0, 2.0}) {
    AddMeasured(v1::MEASURED_KIND_LANDMARKS, PersonTruth::One().Landmarks(0.001), request).set_error(error);
  }
  EXPECT_THAT(RefusalOf(request), HasSubstr("its error differs from that of other landmarks"));
  request.clear_measured();
  EXPECT_THAT(RefusalOf(request), HasSubstr("landmarks: is required, or measured"));
}

TEST(SceneLungs, AreClosedAndOfThisSize) {
  const MeshSource same = Changed([](Mesh&) {});
  const auto lungs = MakeSceneLungs(TwoLungs(), same);
  ASSERT_TRUE(lungs.ok()) << lungs.status();
  EXPECT_EQ(lungs->bodies[kLeft].name(), "lung-left");
  EXPECT_EQ(lungs->templates[kRight].surface().vertices, GeneratedLungs()[kRight].surface().vertices);
  v1::Scene one = TwoLungs();
  one.mutable_bodies()->RemoveLast();
  const auto fault = [](const v1::Scene& scene, const MeshSource& source) {
    const absl::Status status = MakeSceneLungs(scene, source).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
    return std::string(status.message());
  };
  EXPECT_THAT(fault(one, same), HasSubstr("the scene \"two-lungs\" has no left lung"));
  const auto open = Changed([](Mesh& lung) { lung.triangles.conservativeResize(3, lung.triangles.cols() - 1); });
  EXPECT_THAT(fault(TwoLungs(), open), HasSubstr("\"lung-right\" is not closed"));
  const auto large = Changed([](Mesh& lung) { lung.vertices *= 10; });
  EXPECT_THAT(fault(TwoLungs(), large), HasSubstr("more than 0.6 m: check its unit"));
}

v1::StudyMotionRequest StudyOf(const std::vector<std::pair<std::string, std::string>>& people) {
  v1::StudyMotionRequest request;
  request.mutable_source()->set_name("thorax");
  for (const auto& [name, content] : people) {
    v1::MotionCase& each = *request.add_cases();
    each.set_name(name);
    each.add_landmarks()->set_content(content);
  }
  return request;
}

TEST(StudyRequest, IsRefusedByFieldAndLine) {
  const auto refusal = [](const v1::StudyMotionRequest& request) {
    return std::string(ReadStudyRequest(request).status().message());
  };
  const std::string pairs = PairLines(4);
  const auto read = ReadStudyRequest(StudyOf({{"anna", pairs}, {"ben", pairs}}));
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->cases[1].name, "ben");
  EXPECT_EQ(read->cases[1].landmarks.size(), 4);
  EXPECT_THAT(refusal(StudyOf({})), HasSubstr("cases: give 1 to 64"));
  EXPECT_THAT(refusal(StudyOf({{"anna", pairs}, {"anna", pairs}})), HasSubstr("cases[1].name: another case"));
  EXPECT_THAT(refusal(StudyOf({{std::string(65, 'a'), pairs}})), HasSubstr("cases[0].name"));
  EXPECT_THAT(refusal(StudyOf({{"anna", std::string(kPairsHeader) + "1,2,x,4,5,6\n"}})),
              HasSubstr("cases[0].landmarks[0]:2:"));
  EXPECT_THAT(refusal(StudyOf({{"a", PairLines(30000)}, {"b", PairLines(30000)}})), HasSubstr("50000 pairs together"));
  v1::StudyMotionRequest nine = StudyOf({{"anna", pairs}});
  nine.set_modes(9);
  EXPECT_THAT(refusal(nine), HasSubstr("modes"));
}

}  // namespace
}  // namespace phrenic::fit
