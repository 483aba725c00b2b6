// Any surfaces of a person's bones, lungs and diaphragm give derived bodies that are valid meshes and a scene that
// compiles to finite positions, or an error. The surfaces are those of the generated thorax, changed: after 'f' and a
// byte that chooses a body, the bytes are that body's OBJ file; otherwise each six bytes change one body.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>

#include "server/anatomy/anatomy.h"
#include "server/imaging/surfaces/derived_bodies.h"
#include "server/mechanics/compile/compile.h"
#include "server/meshio/meshio.h"
#include "server/schema/schema.h"

namespace phrenic::imaging {
namespace {

constexpr double kEdge = 14;  // of the generated surfaces, for speed [mm]

constexpr char kPerson[] = R"(name: "person"
  bodies { name: "diaphragm" role: ROLE_SEEN anatomy { structure: STRUCTURE_DIAPHRAGM }
           derived { file { path: "diaphragm.obj" } } }
  bodies { name: "diaphragm-middle" role: ROLE_DEFORMABLE mass: 12 anatomy { structure: STRUCTURE_DIAPHRAGM }
           derived { resolution_mm: 10 } }
  bodies { name: "chest-wall" role: ROLE_SEEN anatomy { structure: STRUCTURE_INNER_CAGE } derived {} }
  bodies { name: "rib-{number}-{side}" for_each { numbers { first: 1 last: 12 } sides: [SIDE_RIGHT, SIDE_LEFT] }
           layer: "ribs" role: ROLE_DRIVEN anatomy { structure: STRUCTURE_RIB } file { path: "rib.obj" } }
  bodies { name: "cartilage-{number}-{side}" for_each { numbers { first: 1 last: 10 } sides: [SIDE_RIGHT, SIDE_LEFT] }
           role: ROLE_SEEN anatomy { structure: STRUCTURE_COSTAL_CARTILAGE } file { path: "cartilage.obj" } }
  bodies { name: "{vertebra}" for_each { numbers { first: 1 last: 15 } } layer: "spine" role: ROLE_AT_REST
           anatomy { structure: STRUCTURE_VERTEBRA } file { path: "vertebra.obj" } }
  bodies { name: "sternum-body" role: ROLE_DRIVEN anatomy { structure: STRUCTURE_STERNUM_BODY } file { path: "s.obj" } }
  bodies { name: "xiphoid" role: ROLE_DRIVEN anatomy { structure: STRUCTURE_XIPHOID } file { path: "x.obj" } }
  bodies { name: "lung-{side}" for_each { sides: [SIDE_RIGHT, SIDE_LEFT] } role: ROLE_SEEN
           anatomy { structure: STRUCTURE_LUNG } file { path: "lung.obj" } }
  layers { name: "ribs" } layers { name: "spine" })";

constexpr char kMechanics[] = R"(
  motions { skin { bodies: "chest-wall" drivers: ["ribs", "spine"] } }
  motions { insertion { body: "diaphragm-middle" region: "insertion" wall: "chest-wall" apex { z: 0.02 } } }
  forces { wall_contact { bodies: "diaphragm-middle" wall: "chest-wall" } }
  forces { chest_wall { wall: "chest-wall" } })";

std::string Ribs() {
  std::string text = "motions { ribs { bodies: 'ribs' free { sides {} segments { first_rib: 4 last_rib: 7 } } ";
  for (int number = 1; number <= 12; ++number) {
    text += "end_states { number: " + std::to_string(number) + " pump_degrees: 8 bucket_degrees: 9 } ";
  }
  return text + "} } ";
}

const v1::Scene& Person() {
  static const v1::Scene& person = *new v1::Scene(*schema::ParseScene("person", kPerson + Ribs() + kMechanics));
  return person;
}

// The bodies that have a file, in the scene's order.
const std::map<std::string, Mesh>& Files() {
  static const auto& files = *new std::map<std::string, Mesh>([] {
    std::map<std::string, Mesh> made;
    for (const v1::Body& body : Person().bodies()) {
      if (body.has_file() || body.derived().has_file()) made[body.name()] = *anatomy::Generate(body.anatomy(), kEdge);
    }
    return made;
  }());
  return files;
}

Mesh& Chosen(std::map<std::string, Mesh>& files, std::uint8_t byte) {
  return std::next(files.begin(), byte % static_cast<std::ptrdiff_t>(files.size()))->second;
}

// Changes a surface: by a shift, a scale, a cut, a reversal, a point, a copy.
void Change(const std::uint8_t* bytes, std::map<std::string, Mesh>& files) {
  Mesh& mesh = Chosen(files, bytes[0]);
  const Eigen::Vector3d by(bytes[2] - 128.0, bytes[3] - 128.0, bytes[4] - 128.0);
  const Eigen::Vector3d centre = mesh.vertices.cols() > 0 ? Eigen::Vector3d(mesh.vertices.rowwise().mean()) : by;
  switch (bytes[1] % 6) {
    case 0:
      mesh.vertices.colwise() += by * 2e-3;
      break;
    case 1:
      mesh.vertices = ((mesh.vertices.colwise() - centre) * (bytes[5] / 64.0)).colwise() + centre;
      break;
    case 2:
      mesh.triangles.conservativeResize(3, mesh.triangles.cols() * bytes[5] / 256);
      break;
    case 3:
      mesh.triangles.row(0).swap(mesh.triangles.row(1));
      break;
    case 4:
      if (mesh.vertices.cols() > 0) mesh.vertices.col(bytes[5] % mesh.vertices.cols()) += by * 1e-2;
      break;
    default:
      mesh = Chosen(files, bytes[5]);
  }
}

void Try(const std::map<std::string, Mesh>& files) {
  const BodySource source = WithDerived(
      [&files](const v1::Body& body) -> absl::StatusOr<Mesh> {
        const auto found = files.find(body.name());
        return found == files.end() ? absl::NotFoundError(body.name()) : absl::StatusOr<Mesh>(found->second);
      },
      Person());
  for (const v1::Body& body : Person().bodies()) {
    if (!body.has_derived()) continue;
    const auto mesh = source(body);
    if (mesh.ok() ? !Validate(*mesh).ok() : mesh.status().message().empty()) std::abort();
  }
  const auto model = Compile(Person(), source);
  if (model.ok() ? !(*model)->rest.allFinite() : model.status().message().empty()) std::abort();
}

}  // namespace
}  // namespace phrenic::imaging

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using phrenic::imaging::Chosen;
  constexpr std::size_t kChange = 6;
  auto files = phrenic::imaging::Files();
  if (size >= 2 && data[0] == 'f') {
    const auto mesh = phrenic::meshio::Parse("fuzz.obj", {reinterpret_cast<const char*>(data) + 2, size - 2}, 0.001);
    if (!mesh.ok()) return 0;
    Chosen(files, data[1]) = *mesh;
  } else {
    for (std::size_t at = 0; at + kChange <= size; at += kChange) phrenic::imaging::Change(data + at, files);
  }
  phrenic::imaging::Try(files);
  return 0;
}
