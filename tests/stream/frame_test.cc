#include "server/stream/frame.h"

#include <cstring>
#include <limits>

#include "server/stream/encoder.h"
#include "server/stream/geometry.h"
#include "tests/compile_text.h"
#include "tests/scalar_motion.h"
#include "tests/small_scenes.h"

namespace phrenic::stream {
namespace {

std::vector<float> FloatsOf(const std::string& bytes) {
  std::vector<float> floats(bytes.size() / sizeof(float));
  std::memcpy(floats.data(), bytes.data(), bytes.size());
  return floats;
}

std::vector<std::uint32_t> Indices(const std::string& bytes) {
  std::vector<std::uint32_t> indices(bytes.size() / sizeof(std::uint32_t));
  std::memcpy(indices.data(), bytes.data(), bytes.size());
  return indices;
}

Snapshot At(const Model& model, double time) {
  return {.sequence = 1, .state = RunTo(model, time, 0.01), .parameters = model.parameters, .made = absl::UnixEpoch()};
}

TEST(Frame, PositionsAreThoseOfTheStateRoundedToFloats) {
  const auto model = CompileText(kTriangle);
  const Snapshot snapshot = At(*model, 0.5);
  const auto frame = MakeFrame(*model, Layout(*model), snapshot);
  ASSERT_TRUE(frame.ok()) << frame.status();
  const std::vector<float> positions = FloatsOf(frame->positions());
  ASSERT_EQ(positions.size(), 9u);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(positions[i], static_cast<float>(snapshot.state.x.data()[i]));
  EXPECT_LT(positions[5], 0) << "a free corner has not fallen";
  EXPECT_EQ(frame->tick(), 50);
  EXPECT_EQ(frame->time(), snapshot.state.time);
}

TEST(Frame, ProbesReadPositionAndDisplacementFromRest) {
  const auto model = CompileText(kTriangle);
  const Snapshot snapshot = At(*model, 0.5);
  const auto frame = MakeFrame(*model, Layout(*model), snapshot);
  ASSERT_TRUE(frame.ok()) << frame.status();
  ASSERT_EQ(frame->probes_size(), 1);
  EXPECT_EQ(frame->probes(0).name(), "corner");
  EXPECT_EQ(frame->probes(0).y(), snapshot.state.x(1, 2));
  EXPECT_EQ(frame->probes(0).dy(), snapshot.state.x(1, 2) - 1);
  EXPECT_EQ(frame->probes(0).dz(), snapshot.state.x(2, 2));
}

TEST(Frame, ScalarsAreReadWithTheirNamesUnitsAndRates) {
  const auto model = CompileWithScalars(kTriangle);
  Snapshot snapshot = At(*model, 0.5);
  const auto frame = MakeFrame(*model, Layout(*model), snapshot);
  ASSERT_TRUE(frame.ok()) << frame.status();
  ASSERT_EQ(frame->scalars_size(), 2);
  EXPECT_EQ(frame->scalars(0).name(), "angle");
  EXPECT_EQ(frame->scalars(0).unit(), "rad");
  EXPECT_EQ(frame->scalars(0).value(), snapshot.state.scalars.q[0]);
  EXPECT_EQ(frame->scalars(0).rate(), snapshot.state.scalars.v[0]);
  EXPECT_EQ(frame->scalars(1).value(), 0.5);
  snapshot.state.scalars.v[1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(MakeFrame(*model, Layout(*model), snapshot).ok());
}

TEST(Frame, ModelsWithoutScalarsSendNone) {
  const auto model = CompileText(kTriangle);
  EXPECT_EQ(MakeFrame(*model, Layout(*model), At(*model, 0.5))->scalars_size(), 0);
}

TEST(Frame, ElementsKeepTheirMemoryToThemselves) {
  const auto model = CompileText(
      "name: 'strip' bodies { name: 'strip' role: ROLE_DEFORMABLE mass: 1 grid { columns: 4 rows: 2 u { x: 1 } v { y: "
      "1 } "
      "} regions { name: 'from' low {} high { y: 1 } } regions { name: 'tendon' low { x: 3 } high { x: 3 y: 1 } } } "
      "forces "
      "{ muscle { body: 'strip' from_region: 'from' tendon_region: 'tendon' } }");
  EXPECT_FALSE(model->scalars.empty());
  EXPECT_EQ(MakeFrame(*model, Layout(*model), At(*model, 0))->scalars_size(), 0);
}

TEST(Frame, MeasuresAreReadAtItsState) {
  const auto model = CompileText(
      Triangle("measures { name: 'work' kinetic_energy { bodies: 'sheet' } } measures { name: 'height' highest { body: "
               "'sheet' direction { z: -1 } } }"));
  Snapshot snapshot = At(*model, 0.5);
  const auto frame = MakeFrame(*model, Layout(*model), snapshot);
  ASSERT_TRUE(frame.ok()) << frame.status();
  ASSERT_EQ(frame->measures_size(), 2);
  EXPECT_EQ(frame->measures(0).unit(), "J");
  EXPECT_NEAR(frame->measures(0).value(), 0.5 * model->mass.dot(snapshot.state.v.colwise().squaredNorm()), 1e-15);
  EXPECT_EQ(frame->measures(1).value(), -snapshot.state.x.row(2).minCoeff());
  snapshot.state.v(0, 1) = 1e200;
  EXPECT_FALSE(MakeFrame(*model, Layout(*model), snapshot).ok()) << "an energy that is not finite goes out";
}

TEST(Frame, PosesAreRotationThenTranslation) {
  const auto model = CompileText(kTriangle);
  Snapshot snapshot = At(*model, 0);
  Pose& pose = snapshot.state.poses.emplace_back();
  pose.rotation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);  // w x y z
  pose.translation = {1, 2, 3};
  const auto frame = MakeFrame(*model, Layout(*model), snapshot);
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(FloatsOf(frame->poses()), (std::vector<float>{0.5, -0.5, 0.5, 0.5, 1, 2, 3}));
}

TEST(Frame, WithANumberThatIsNotFiniteIsRefused) {
  const auto model = CompileText(kTriangle);
  const Layout layout(*model);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    Snapshot snapshot = At(*model, 0.1);
    snapshot.state.x(1, 2) = bad;
    EXPECT_TRUE(absl::IsInternal(MakeFrame(*model, layout, snapshot).status())) << bad;
    Encoder encoder(model, layout);
    EXPECT_EQ(encoder.Encode(snapshot, {}), nullptr);
    EXPECT_EQ(encoder.Encode(snapshot, {.numbers_only = true}), nullptr);
  }
  Snapshot posed = At(*model, 0.1);
  posed.state.poses.emplace_back().translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(MakeFrame(*model, layout, posed).ok());
}

TEST(Frame, NumbersAreTheFrameWithoutItsArrays) {
  const auto model = CompileText(kTriangle);
  const Layout layout(*model);
  Encoder encoder(model, layout);
  const Snapshot snapshot = At(*model, 0.2);
  v1::WatchFramesResponse full, numbers;
  ASSERT_TRUE(numbers.ParseFromString(*encoder.Encode(snapshot, {.numbers_only = true})));
  ASSERT_TRUE(full.ParseFromString(*encoder.Encode(snapshot, {})));
  EXPECT_FALSE(full.frame().positions().empty());
  EXPECT_TRUE(numbers.frame().positions().empty());
  full.mutable_frame()->clear_positions();
  full.mutable_frame()->clear_codec();
  full.mutable_frame()->clear_bodies();
  EXPECT_EQ(full.SerializeAsString(), numbers.SerializeAsString());
}

TEST(Frame, StreamedBodiesFollowEachOtherAndOthersTakeNoPlace) {
  const auto model = CompileText(Triangle(R"(
    bodies { name: "second" role: ROLE_DEFORMABLE polyhedron { vertices { z: 5 } vertices { z: 6 } edges { a: 0 b: 1 } } }
  )"));
  const Layout layout(*model);
  EXPECT_EQ(layout.placement(0), v1::PLACEMENT_STILL);
  EXPECT_EQ(layout.placement(1), v1::PLACEMENT_STREAMED);
  EXPECT_EQ(layout.first_vertex(1), 0);
  EXPECT_EQ(layout.placement(2), v1::PLACEMENT_STREAMED);
  EXPECT_EQ(layout.first_vertex(2), 3);
  EXPECT_EQ(layout.vertices(), 5);
}

TEST(Frame, ABodyIsPlacedOnceAndOnlyIfAViewerHasIt) {
  const auto model = CompileText(Triangle(R"(
    bodies { name: "second" role: ROLE_DEFORMABLE polyhedron { vertices { z: 5 } vertices { z: 6 } edges { a: 0 b: 1 } } }
  )"));
  const Layout layout(*model);
  Encoder encoder(model, layout);
  Snapshot snapshot = At(*model, 0.2);
  const auto positions = [&](const FrameEncoding& encoding) {
    v1::WatchFramesResponse response;
    EXPECT_TRUE(response.ParseFromString(*encoder.Encode(snapshot, encoding)));
    return response.frame().positions();
  };
  const FrameEncoding second = {.chosen = true, .bodies = {2}};
  positions({.numbers_only = true});
  EXPECT_EQ(encoder.placements(), 0);
  const std::string of_second = positions(second);
  EXPECT_EQ(encoder.placements(), 1);
  const std::string all = positions({});
  EXPECT_EQ(encoder.placements(), 2);
  EXPECT_EQ(all, MakeFrame(*model, layout, snapshot)->positions());
  EXPECT_EQ(all.substr(all.size() - of_second.size()), of_second);
  snapshot.sequence = 2;
  snapshot.state = At(*model, 0.4).state;
  EXPECT_NE(positions({}), all);
  EXPECT_EQ(encoder.placements(), 4) << "another frame";
}

TEST(Geometry, TellsLookAndSurfaceOfEachBody) {
  const auto model = CompileText(kTriangle);
  const Layout layout(*model);
  const auto post = MakeGeometry(*model, layout, 0), sheet = MakeGeometry(*model, layout, 1);
  EXPECT_EQ(post.body_count(), 2);
  EXPECT_EQ(post.layer(), "post") << "a body in no layer makes its own";
  EXPECT_EQ(Indices(post.edges()), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(FloatsOf(post.rest_positions()), (std::vector<float>{2, 0, 0, 3, 0, 0}));
  EXPECT_EQ(sheet.body_index(), 1);
  EXPECT_EQ(sheet.layer_title(), "Tissue");
  EXPECT_EQ(sheet.color(), "#c8553d");
  EXPECT_EQ(sheet.opacity(), 0.5);
  EXPECT_EQ(Indices(sheet.triangles()), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(Indices(sheet.fixed_vertices()), (std::vector<std::uint32_t>{0}));
}

TEST(Geometry, OverlaysHaveTheBodysOwnVertexNumbers) {
  const auto model = CompileText(Triangle(R"(
    bodies { name: "second" role: ROLE_DEFORMABLE polyhedron { vertices { z: 5 } vertices { z: 6 } edges { a: 0 b: 1 } } }
    constraints { rigid_links { body: "second" list { links { a: 0 b: 1 } } } }
    forces { action_line {
      bodies: "second" origin { z: 4 } direction { z: 2 } radius: 0.5 force: 1 fall_off: FALL_OFF_CYLINDER } }
  )"));
  const Layout layout(*model);
  EXPECT_TRUE(MakeGeometry(*model, layout, 1).rigid_links().empty());
  const auto second = MakeGeometry(*model, layout, 2);
  EXPECT_EQ(Indices(second.rigid_links()), (std::vector<std::uint32_t>{0, 1}));
  ASSERT_EQ(second.action_lines_size(), 1);
  EXPECT_EQ(second.action_lines(0).direction(2), 1) << "not a unit vector";
  EXPECT_EQ(second.action_lines(0).length(), 2) << "does not reach the furthest vertex within its radius";
}

}  // namespace
}  // namespace phrenic::stream
