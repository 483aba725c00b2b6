// The size of a model is known before it is built, and a scene cannot cost more than its limits.
#include "server/mechanics/compile/scene_size.h"

#include <gmock/gmock.h>

#include <chrono>
#include <cstdint>
#include <limits>

#include "absl/strings/str_cat.h"
#include "google/protobuf/text_format.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/compile/shape_size.h"
#include "server/schema/schema.h"

namespace phrenic {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kHuge = std::numeric_limits<std::int64_t>::max();

v1::Scene Parsed(const std::string& text) {
  v1::Scene scene;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString("name: 's' " + text, &scene)) << text;
  EXPECT_TRUE(schema::Resolve(&scene).ok()) << schema::Resolve(&scene);
  return scene;
}

absl::StatusOr<Mesh> NoFiles(const v1::Body&) { return absl::NotFoundError("no files"); }

constexpr SizeLimits kLimits{.vertices = 4'000'000, .elements = 10'000'000};

std::string Body(const std::string& shape) {
  return "bodies { name: 'x' role: ROLE_DEFORMABLE mass: 1 " + shape + " } ";
}

TEST(SceneSize, SumsAndProductsSaturate) {
  EXPECT_EQ(SaturatingSum(kHuge, kHuge), kHuge);
  EXPECT_EQ(SaturatingProduct(kHuge, 2), kHuge);
  EXPECT_EQ(SaturatingProduct(kHuge, 0), 0);
  EXPECT_EQ(SaturatingProduct(3, 4), 12);
}

TEST(SceneSize, IsAnUpperBoundOfEveryShapesMesh) {
  for (const std::string shape :
       {"polyhedron { vertices {} vertices { x: 1 } vertices { y: 1 } triangles { a: 0 b: 1 c: 2 } }",
        "grid { columns: 5 rows: 7 u { x: 1 } v { y: 1 } }", "block { size { x: 1 y: 1 z: 1 } }",
        "block { size { x: 1 y: 1 z: 1 } columns: 1 rows: 9 layers: 2 }",
        "ellipsoid { radii { x: 1 y: 1 z: 1 } divisions: 6 }",
        "ellipsoid { radii { x: 1 y: 1 z: 1 } upper_half: true }",
        "filling { ellipsoid { radii { x: 1 y: 2 z: 1 } } cell: 0.3 }"}) {
    const v1::Scene scene = Parsed(Body(shape) +
                                   "forces { springs { bodies: 'x' } } forces { gravity { bodies: 'x' "
                                   "acceleration { z: -9 } } }");
    const auto model = Compile(scene, &NoFiles);
    ASSERT_TRUE(model.ok()) << model.status();
    const auto size = EstimateSize(scene, nullptr, kLimits);
    ASSERT_TRUE(size.ok()) << size.status();
    EXPECT_GE(size->vertices, (*model)->bodies[0].mesh.vertices.cols()) << shape;
    EXPECT_LE(size->vertices, 8 * (*model)->bodies[0].mesh.vertices.cols()) << shape;
    EXPECT_GE(size->elements, (*model)->report.springs() + (*model)->rest.cols()) << shape;
  }
}

// Each of these took minutes or gigabytes.
TEST(SceneSize, PathologicalScenesAreRefusedAtOnceByTheirField) {
  const std::string grid = Body("grid { columns: 300 rows: 300 u { x: 0.1 } v { y: 0.1 } }");
  std::string springs, layers;
  for (int i = 0; i < 200; ++i) springs += "forces { springs { bodies: 'x' } } ";
  for (int i = 0; i < 20'000; ++i) layers += "layers { name: 'l' } ";
  for (const auto& [text, field] : std::vector<std::pair<std::string, std::string>>{
           {Body("block { size { x: 1 y: 1 z: 1 } columns: 500 rows: 500 layers: 500 }"), "bodies[0].block"},
           {Body("filling { ellipsoid { radii { x: 1e300 y: 1e300 z: 1e300 } } cell: 1e-6 }"), "bodies[0].filling"},
           {grid + springs, "forces["},
           {"bodies { name: 'x{number}' for_each { numbers { first: 1 last: 200 } } role: ROLE_DEFORMABLE mass: 1 "
            "grid { columns: 200 rows: 200 u { x: 1 } v { y: 1 } } } ",
            "bodies[100].grid"},
           {grid + layers, "layers: are 20000"},
           {Body("grid { columns: 2 rows: 2 u { x: 1 } v { y: 1 } }") + "title: '" + std::string(1 << 20, 'a') + "'",
            "title: has 1048576 bytes"}}) {
    const v1::Scene scene = Parsed(text);
    const auto start = std::chrono::steady_clock::now();
    const auto model = Compile(scene, &NoFiles, {.limits = kLimits});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_FALSE(model.ok()) << field;
    EXPECT_THAT(std::string(model.status().message()), HasSubstr(field));
    EXPECT_TRUE(absl::IsResourceExhausted(model.status()) || absl::IsInvalidArgument(model.status())) << model.status();
    EXPECT_LT(seconds.count(), 5) << field;
    EXPECT_LT(model.status().message().size(), 500U);
  }
}

TEST(SceneSize, AFileIsCountedOnceItIsRead) {
  const v1::Scene scene = Parsed(
      "bodies { name: 'f{number}' for_each { numbers { first: 1 last: 200 } } role: "
      "ROLE_AT_REST file { path: 'a.obj' } }");
  int reads = 0;
  const MeshSource source = [&reads](const v1::Body&) {
    ++reads;
    Mesh mesh;
    mesh.vertices.setZero(3, 1000);
    return mesh;
  };
  const auto model = Compile(scene, source, {.limits = {.vertices = 3500}});
  EXPECT_TRUE(absl::IsResourceExhausted(model.status())) << model.status();
  EXPECT_THAT(std::string(model.status().message()), HasSubstr("bodies[3].file"));
  EXPECT_EQ(reads, 4);
}

// Every pair of vertices is near: within the limits, the work is not.
std::string AllPairs() {
  return Body("grid { columns: 200 rows: 200 u { x: 1e-6 } v { y: 1e-6 } }") +
         "forces { cross_layer { bodies: 'x' distance: 100 } }";
}

TEST(SceneSize, ACompileStopsWhenNobodyWaitsForIt) {
  int asked = 0;
  const auto model =
      Compile(Parsed(AllPairs()), &NoFiles, {.limits = kLimits, .cancelled = [&] { return ++asked > 3; }});
  EXPECT_TRUE(absl::IsCancelled(model.status())) << model.status();
  EXPECT_EQ(asked, 4);
}

TEST(SceneSize, ACompileStopsAfterItsTimeInEveryLoopOverPairs) {
  const std::string tiny = Body("grid { columns: 200 rows: 200 u { x: 1e-6 } v { y: 1e-6 } }");
  const std::string fine = "filling { ellipsoid { radii { x: 1 y: 1 z: 1 } divisions: 200 } cell: 0.025 }";
  for (const std::string& text :
       {AllPairs(), tiny + "constraints { rigid_links { body: 'x' pairing { distance: 100 } } }", Body(fine)}) {
    const auto start = std::chrono::steady_clock::now();
    const auto model = Compile(Parsed(text), &NoFiles, {.limits = kLimits, .longest = 0.5});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_TRUE(absl::IsResourceExhausted(model.status())) << text << model.status();
    EXPECT_THAT(std::string(model.status().message()), HasSubstr("--max-compile-seconds"));
    EXPECT_LT(seconds.count(), 20) << text;
  }
}

// Links that share a vertex couple in pairs.
TEST(SceneSize, LinksThatAllShareOneVertexAreRefused) {
  std::string hub = Body("grid { columns: 100 rows: 100 u { x: 0.1 } v { y: 0.1 } }") +
                    "constraints { rigid_links { body: 'x' list {";
  for (int i = 1; i < 9000; ++i) hub += absl::StrCat(" links { a: 0 b: ", i, " }");
  const auto model = Compile(Parsed(hub + " } } }"), &NoFiles, {.limits = kLimits});
  EXPECT_TRUE(absl::IsResourceExhausted(model.status())) << model.status();
  EXPECT_THAT(std::string(model.status().message()), HasSubstr("constraints[0].rigid_links: its 8999 links"));
}

// The factor of Laplace's equation on a surface of random triangles is nearly full.
TEST(SceneSize, FibresOnATangledSurfaceAreRefused) {
  constexpr int kVertices = 9000;
  std::string random = "polyhedron {";
  std::uint32_t bits = 1;
  const auto next = [&bits] { return bits = bits * 1664525 + 1013904223; };
  for (int i = 0; i < kVertices; ++i) {
    random += absl::StrCat(" vertices { x: ", next() % 1000, " y: ", next() % 1000, " z: ", i % 1000, " }");
  }
  for (int i = 0; i < 3 * kVertices; ++i) {
    random += absl::StrCat(" triangles { a: ", (next() >> 8U) % kVertices, " b: ", (next() >> 8U) % kVertices,
                           " c: ", (next() >> 8U) % kVertices, " }");
  }
  random +=
      " } regions { name: 'from' low { } high { x: 1000 y: 1000 z: 10 } } regions { name: 'to' low { z: 990 } high { "
      "x: "
      "1000 y: 1000 z: 1000 } }";
  const auto model =
      Compile(Parsed(Body(random) + "forces { fibres { bodies: 'x' from_region: 'from' to_region: 'to' } }"), &NoFiles,
              {.limits = kLimits});
  EXPECT_THAT(std::string(model.status().message()), HasSubstr("too much work"));
}

// A vertex with very many springs costs no more than as many springs elsewhere.
TEST(SceneSize, AHubOfSpringsCompiles) {
  std::string star = "polyhedron { vertices { }";
  for (int i = 1; i < 50'000; ++i)
    star += absl::StrCat(" vertices { x: ", i % 97, " y: ", i % 89, " z: 1 } edges { a: 0 b: ", i, " }");
  const auto start = std::chrono::steady_clock::now();
  const auto model =
      Compile(Parsed(Body(star + " }") + "forces { springs { bodies: 'x' } }"), &NoFiles, {.limits = kLimits});
  EXPECT_TRUE(model.ok()) << model.status();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

}  // namespace
}  // namespace phrenic
