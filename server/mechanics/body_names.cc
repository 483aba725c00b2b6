#include "server/mechanics/body_names.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/mechanics/field_error.h"
#include "server/schema/fields.h"

namespace phrenic {
namespace {

template <typename Predicate>
std::vector<int> BodiesWhere(const Model& model, Predicate predicate) {
  std::vector<int> found;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (predicate(model.bodies[b])) found.push_back(b);
  }
  return found;
}

std::vector<int> BodiesOfLayer(const Model& model, std::string_view layer) {
  return BodiesWhere(model, [layer](const BodyModel& body) { return body.layer == layer; });
}

std::vector<int> BodiesCalled(const Model& model, std::string_view name) {
  return BodiesWhere(model, [name](const BodyModel& body) { return body.name == name; });
}

// "rib" is STRUCTURE_RIB.
absl::StatusOr<std::vector<int>> BodiesOfStructure(const Model& model, std::string_view structure,
                                                   std::string_view path) {
  const auto* value = schema::FindChoice(*v1::Structure_descriptor(), structure);
  if (value == nullptr) {
    return FieldError(path, absl::StrCat("there is no structure \"", std::string(structure), "\"; there are ",
                                         schema::ChoiceNames(*v1::Structure_descriptor())));
  }
  std::vector<int> found =
      BodiesWhere(model, [value](const BodyModel& body) { return body.anatomy.structure() == value->number(); });
  if (!found.empty()) return found;
  return FieldError(path,
                    absl::StrCat("no body is of structure \"", std::string(structure), "\": give one that anatomy"));
}

// Why no body has the name.
absl::Status NoBody(const Model& model, const std::string& name, std::string_view path) {
  const auto& layers = model.scene.layers();
  const std::string_view layer = name.starts_with("layer:") ? std::string_view(name).substr(6) : name;
  const bool declared =
      std::any_of(layers.begin(), layers.end(), [layer](const v1::Layer& each) { return each.name() == layer; });
  if (declared) {
    return FieldError(path, absl::StrCat("no body is in layer \"", std::string(layer), "\": put one in it"));
  }
  return FieldError(path, absl::StrCat("there is no body or layer \"", name, "\"; there are ", KnownBodyNames(model)));
}

// A body and a layer of this name, and the body is not in the layer.
absl::Status Ambiguous(const std::string& name, std::string_view path) {
  return FieldError(path, absl::StrCat("there are a body \"", name, "\" and a layer \"", name,
                                       "\" that does not hold it; write \"body:", name, "\" or \"layer:", name, "\""));
}

}  // namespace

std::string KnownBodyNames(const Model& model) {
  std::vector<std::string> names;
  for (const BodyModel& body : model.bodies) {
    const std::string& name = body.layer.empty() ? body.name : body.layer;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return absl::StrJoin(names, ", ");
}

absl::StatusOr<std::vector<int>> BodiesNamed(const Model& model, const std::string& name, std::string_view path) {
  const std::vector<int> body = BodiesCalled(model, name), layer = BodiesOfLayer(model, name);
  if (!body.empty() && !layer.empty() && model.bodies[body.front()].layer != name) return Ambiguous(name, path);
  if (!layer.empty()) return layer;
  if (!body.empty()) return body;
  const std::string_view rest = std::string_view(name).substr(name.find(':') + 1);
  if (name.starts_with("structure:")) return BodiesOfStructure(model, rest, path);
  std::vector<int> found;
  if (name.starts_with("body:")) found = BodiesCalled(model, rest);
  if (name.starts_with("layer:")) found = BodiesOfLayer(model, rest);
  if (found.empty()) return NoBody(model, name, path);
  return found;
}

}  // namespace phrenic
