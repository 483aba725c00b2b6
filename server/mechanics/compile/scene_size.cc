#include "server/mechanics/compile/scene_size.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "server/mechanics/compile/shape_size.h"
#include "server/mechanics/field_error.h"
#include "server/schema/fields.h"
#include "server/schema/schema.h"

namespace phrenic {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using Texts = google::protobuf::RepeatedPtrField<std::string>;

constexpr int kMostEntries = 10'000;
constexpr std::size_t kLongestText = std::size_t{4} << 10, kLongestDescription = std::size_t{64} << 10;

// Bodies that a name selects, summed.
struct Selected {
  std::int64_t bodies = 0;
  MeshSize size;
  void Add(std::int64_t count, const MeshSize& more) {
    bodies = SaturatingSum(bodies, count);
    size.vertices = SaturatingSum(size.vertices, more.vertices);
    size.edges = SaturatingSum(size.edges, more.edges);
    size.triangles = SaturatingSum(size.triangles, more.triangles);
    size.tetrahedra = SaturatingSum(size.tetrahedra, more.tetrahedra);
  }
};

// The sizes behind the names that elements write (body_names.h).
class NamedSizes {
 public:
  NamedSizes(const v1::Scene& scene, const std::vector<MeshSize>& sizes) {
    for (int b = 0; b < scene.bodies_size(); ++b) {
      const v1::Body& body = scene.bodies(b);
      const MeshSize& size = sizes[static_cast<std::size_t>(b)];
      by_name_["body:" + body.name()].Add(1, size);
      if (!body.layer().empty()) by_name_["layer:" + body.layer()].Add(1, size);
      by_structure_[body.anatomy().structure()].Add(1, size);
    }
  }

  Selected Of(const std::string& name) const {
    if (name.starts_with("structure:")) {
      const auto* value = schema::FindChoice(*v1::Structure_descriptor(), std::string_view(name).substr(10));
      return value == nullptr ? Selected{} : Find(by_structure_, value->number());
    }
    if (name.starts_with("body:") || name.starts_with("layer:")) return Find(by_name_, name);
    const Selected layer = Find(by_name_, "layer:" + name);
    return layer.bodies > 0 ? layer : Find(by_name_, "body:" + name);
  }
  // A body that two names select counts twice.
  Selected Of(const Texts& names) const {
    Selected all;
    for (const std::string& name : names) {
      const Selected one = Of(name);
      all.Add(one.bodies, one.size);
    }
    return all;
  }

 private:
  template <typename Key>
  static Selected Find(const std::map<Key, Selected>& sizes, const Key& key) {
    const auto found = sizes.find(key);
    return found == sizes.end() ? Selected{} : found->second;
  }

  std::map<std::string, Selected> by_name_;
  std::map<int, Selected> by_structure_;
};

std::int64_t Links(bool listed, const v1::LinkList& list, const MeshSize& body) {
  return listed ? list.links_size() : body.edges;
}

std::int64_t CrossLayerPairs(const v1::CrossLayer& scene, const NamedSizes& sizes) {
  const std::int64_t others = std::max<std::int64_t>(1, sizes.Of(scene.other_bodies()).bodies);
  return SaturatingProduct(SaturatingProduct(sizes.Of(scene.bodies()).size.vertices, scene.neighbours()), others);
}

std::int64_t ElementsOf(const v1::Force& scene, const NamedSizes& sizes) {
  switch (scene.kind_case()) {
    case v1::Force::kSprings:
      return sizes.Of(scene.springs().bodies()).size.edges;
    case v1::Force::kFriction:
      return sizes.Of(scene.friction().bodies()).size.vertices;
    case v1::Force::kActionLine:
      return sizes.Of(scene.action_line().bodies()).size.vertices;
    case v1::Force::kAttachment:
      return SaturatingProduct(2, sizes.Of(scene.attachment().bodies()).size.vertices);
    case v1::Force::kGravity:
      return sizes.Of(scene.gravity().bodies()).size.vertices;
    case v1::Force::kContact:
      return SaturatingSum(sizes.Of(scene.contact().bodies()).size.vertices,
                           sizes.Of(scene.contact().surfaces()).size.triangles);
    case v1::Force::kCables:
      return Links(scene.cables().has_list(), scene.cables().list(), sizes.Of(scene.cables().body()).size);
    case v1::Force::kMembrane:
      return sizes.Of(scene.membrane().bodies()).size.triangles;
    case v1::Force::kSolid:
      return SaturatingProduct(3, sizes.Of(scene.solid().bodies()).size.tetrahedra);  // of some 700 bytes each
    case v1::Force::kFibres:
      return SaturatingProduct(4, sizes.Of(scene.fibres().bodies()).size.triangles);
    case v1::Force::kMuscle:
      return SaturatingProduct(4, sizes.Of(scene.muscle().body()).size.triangles);
    case v1::Force::kWallContact:
      return sizes.Of(scene.wall_contact().bodies()).size.vertices;
    case v1::Force::kChestWall:
      return 2;
    case v1::Force::kThoraxPressures:
      return SaturatingProduct(3, sizes.Of(scene.thorax_pressures().body()).size.triangles);
    case v1::Force::kBending:
      return SaturatingProduct(3, sizes.Of(scene.bending().bodies()).size.triangles);  // of some 500 bytes each
    case v1::Force::kCrossLayer:
      return CrossLayerPairs(scene.cross_layer(), sizes);
    case v1::Force::kTargetSpring:
      return SaturatingSum(sizes.Of(scene.target_spring().bodies()).size.vertices,
                           sizes.Of(scene.target_spring().surface()).size.triangles);
    case v1::Force::kPointLoad:
      return sizes.Of(scene.point_load().body()).size.vertices;
    case v1::Force::kPressure:
      return sizes.Of(scene.pressure().surface().bodies()).size.triangles;
    case v1::Force::kLungs:
      return SaturatingSum(sizes.Of(scene.lungs().floor().bodies()).size.triangles,
                           sizes.Of(scene.lungs().walls().bodies()).size.triangles);
    case v1::Force::KIND_NOT_SET:
      break;
  }
  return 0;
}

std::int64_t ElementsOf(const v1::Constraint& scene, const NamedSizes& sizes) {
  switch (scene.kind_case()) {
    case v1::Constraint::kRigidLinks:
      return scene.rigid_links().has_list() ? scene.rigid_links().list().links_size()
                                            : sizes.Of(scene.rigid_links().body()).size.vertices;
    case v1::Constraint::kLengthLimits:
      return Links(scene.length_limits().has_list(), scene.length_limits().list(),
                   sizes.Of(scene.length_limits().body()).size);
    case v1::Constraint::KIND_NOT_SET:
      break;
  }
  return 0;
}

std::int64_t ElementsOf(const v1::Motion& scene, const NamedSizes& sizes) {
  switch (scene.kind_case()) {
    case v1::Motion::kRibs:
      return sizes.Of(scene.ribs().bodies()).bodies;
    case v1::Motion::kSternum:
      return SaturatingSum(sizes.Of(scene.sternum().bodies()).bodies, sizes.Of(scene.sternum().ribs()).bodies);
    case v1::Motion::kOscillation:
      return scene.oscillation().vertices_size();
    case v1::Motion::kSkin:
      return SaturatingSum(SaturatingProduct(4, sizes.Of(scene.skin().bodies()).size.vertices),
                           sizes.Of(scene.skin().drivers()).size.triangles);
    case v1::Motion::kInsertion:
      return SaturatingSum(sizes.Of(scene.insertion().body()).size.vertices,
                           SaturatingProduct(9, sizes.Of(scene.insertion().wall()).size.vertices));
    case v1::Motion::kLungModes:
      return SaturatingProduct(12, SaturatingSum(sizes.Of(scene.lung_modes().lungs()).size.vertices,
                                                 sizes.Of(scene.lung_modes().inside()).size.vertices));
    case v1::Motion::KIND_NOT_SET:
      break;
  }
  return 0;
}

std::int64_t ElementsOf(const v1::Measure& scene, const NamedSizes& sizes) {
  switch (scene.kind_case()) {
    case v1::Measure::kVolume:
      return sizes.Of(scene.volume().surface().bodies()).size.triangles;
    case v1::Measure::kFlow:
      return sizes.Of(scene.flow().surface().bodies()).size.triangles;
    case v1::Measure::kKineticEnergy:
      return sizes.Of(scene.kinetic_energy().bodies()).size.vertices;
    case v1::Measure::kHighest:
      return sizes.Of(scene.highest().body()).size.vertices;
    case v1::Measure::kElasticEnergy:
    case v1::Measure::kForceOutput:
    case v1::Measure::KIND_NOT_SET:
      break;
  }
  return 1;
}

absl::Status TooLarge(std::string_view field, std::int64_t count, const char* counted, std::int64_t most,
                      const char* setting) {
  const bool unknown = count == std::numeric_limits<std::int64_t>::max();
  return absl::ResourceExhaustedError(absl::StrCat(std::string(field), ": with it the scene has ",
                                                   unknown ? std::string("far more") : absl::StrCat(count), " ",
                                                   counted, unknown ? " than the " : ", and no more than ", most,
                                                   unknown ? " that" : "", " are allowed (", setting, ")"));
}

// Adds up what has been counted so far.
class Counter {
 public:
  explicit Counter(const SizeLimits& limits) : limits_(limits) {}

  absl::Status AddVertices(std::string_view field, std::int64_t count) {
    size_.vertices = SaturatingSum(size_.vertices, count);
    if (size_.vertices <= limits_.vertices) return absl::OkStatus();
    return TooLarge(field, size_.vertices, "vertices", limits_.vertices, "--max-vertices");
  }
  absl::Status AddElements(std::string_view field, std::int64_t count) {
    size_.elements = SaturatingSum(size_.elements, count);
    if (size_.elements <= limits_.elements) return absl::OkStatus();
    return TooLarge(field, size_.elements, "elements", limits_.elements, "--max-elements");
  }
  template <typename List>
  absl::Status AddList(const char* name, const List& list, const NamedSizes& sizes) {
    for (int i = 0; i < list.size(); ++i) {
      absl::Status added = AddElements(absl::StrCat(name, "[", i, "]"), ElementsOf(list[i], sizes));
      if (!added.ok()) return added;
    }
    return absl::OkStatus();
  }
  const SceneSize& size() const { return size_; }

 private:
  const SizeLimits limits_;
  SceneSize size_;
};

// Returns ".grid", the field of the body's shape.
std::string ShapeOf(const v1::Body& body) {
  const auto* field = v1::Body::descriptor()->FindFieldByNumber(body.shape_case());
  return field == nullptr ? "" : "." + field->name();
}

absl::Status CheckText(const FieldDescriptor& field, const std::string& text) {
  const std::size_t most = field.name() == "description" ? kLongestDescription : kLongestText;
  if (text.size() <= most) return absl::OkStatus();
  return FieldError(field.name(), absl::StrCat("has ", text.size(), " bytes, and no more than ", most, " are allowed"));
}

// Checks every text of a message and of those in it.
absl::Status CheckTexts(const Message& message) {
  const auto& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> set;
  reflection.ListFields(message, &set);
  for (const FieldDescriptor* field : set) {
    const int count = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      absl::Status checked;
      if (field->cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
        std::string scratch;
        checked =
            CheckText(*field, field->is_repeated() ? reflection.GetRepeatedStringReference(message, field, i, &scratch)
                                                   : reflection.GetStringReference(message, field, &scratch));
      } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
        checked = CheckTexts(field->is_repeated() ? reflection.GetRepeatedMessage(message, field, i)
                                                  : reflection.GetMessage(message, field));
      } else {
        break;
      }
      if (!checked.ok()) return checked;
    }
  }
  return absl::OkStatus();
}

// Checks the lengths of the scene's own lists: bodies, layers, forces ...
absl::Status CheckLists(const v1::Scene& scene) {
  for (int i = 0; i < v1::Scene::descriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *v1::Scene::descriptor()->field(i);
    if (!field.is_repeated() || scene.GetReflection()->FieldSize(scene, &field) <= kMostEntries) continue;
    return FieldError(field.name(), absl::StrCat("are ", scene.GetReflection()->FieldSize(scene, &field),
                                                 ", and no more than ", kMostEntries, " are allowed"));
  }
  return absl::OkStatus();
}

}  // namespace

MeshSize SizeOf(const Mesh& mesh) {
  const std::int64_t triangles = mesh.triangles.cols(), tetrahedra = mesh.tetrahedra.cols();
  const std::int64_t edges = mesh.edges.cols() > 0 ? mesh.edges.cols() : triangles + triangles / 2;
  return {mesh.vertices.cols(), edges, triangles, tetrahedra};
}

absl::StatusOr<SceneSize> CountSize(const v1::Scene& scene, const std::vector<MeshSize>& bodies,
                                    const SizeLimits& limits) {
  Counter counter(limits);
  for (int b = 0; b < scene.bodies_size(); ++b) {
    const MeshSize& size = bodies[static_cast<std::size_t>(b)];
    const std::string field = absl::StrCat("bodies[", b, "]", ShapeOf(scene.bodies(b)));
    if (absl::Status added = counter.AddVertices(field, size.vertices); !added.ok()) return added;
    // The mesh itself, and for each region a pass over it: a quarter of the cost of elements.
    const std::int64_t regions = SaturatingProduct(size.vertices, scene.bodies(b).regions_size());
    const std::int64_t mesh = SaturatingSum(size.triangles, SaturatingSum(size.tetrahedra, regions));
    if (absl::Status added = counter.AddElements(field, mesh / 4); !added.ok()) return added;
  }
  const NamedSizes sizes(scene, bodies);
  if (absl::Status added = counter.AddList("motions", scene.motions(), sizes); !added.ok()) return added;
  if (absl::Status added = counter.AddList("forces", scene.forces(), sizes); !added.ok()) return added;
  if (absl::Status added = counter.AddList("constraints", scene.constraints(), sizes); !added.ok()) return added;
  if (absl::Status added = counter.AddList("measures", scene.measures(), sizes); !added.ok()) return added;
  return counter.size();
}

absl::StatusOr<SceneSize> EstimateSize(const v1::Scene& scene, const SizeSource& source, const SizeLimits& limits) {
  if (absl::Status lists = CheckLists(scene); !lists.ok()) return lists;
  if (absl::Status texts = CheckTexts(scene); !texts.ok()) return texts;
  v1::Scene complete = scene;
  schema::FillDefaults(&complete);
  std::vector<MeshSize> sizes;
  for (const v1::Body& body : complete.bodies()) sizes.push_back(SizeOfShape(body, source));
  return CountSize(complete, sizes, limits);
}

}  // namespace phrenic
