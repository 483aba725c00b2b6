#include "server/schema/repetition.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>

#include "absl/strings/str_cat.h"
#include "server/schema/fields.h"
#include "server/schema/placeholders.h"

namespace phrenic::schema {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

constexpr std::int64_t kMostRepetitions = 200;
constexpr std::size_t kMostBytes = 16 << 20;  // of all repetitions of a scene

// Where the texts and fields of an element are, for problems.
class Path {
 public:
  explicit Path(std::vector<PathStep> steps) : steps_(std::move(steps)) {}
  Path Then(const Message& owner, const char* field, int index = -1) const {
    return Then(*owner.GetDescriptor()->FindFieldByName(field), index);
  }
  Path Then(const FieldDescriptor& field, int index = -1) const {
    Path longer = *this;
    longer.steps_.push_back({&field, index});
    return longer;
  }
  Problem With(std::string what) const { return {steps_, std::move(what)}; }

 private:
  std::vector<PathStep> steps_;
};

bool ByValuesAlone(const v1::ForEach& each) { return !each.has_numbers() && each.sides().empty(); }

std::int64_t CountOf(const v1::ForEach& each) {
  if (ByValuesAlone(each)) return each.values_size();
  const std::int64_t numbers = each.has_numbers() ? each.numbers().last() - each.numbers().first() + 1 : 1;
  return numbers * std::max(1, each.sides_size());
}

std::optional<Problem> FindProblemIn(const v1::ForEach& each, const Path& path) {
  if (each.has_numbers() && each.numbers().first() > each.numbers().last()) {
    return path.Then(each, "numbers")
        .With(absl::StrCat("first, ", each.numbers().first(), ", is above last, ", each.numbers().last()));
  }
  const auto none = std::find(each.sides().begin(), each.sides().end(), v1::SIDE_UNSPECIFIED);
  if (none != each.sides().end()) {
    return path.Then(each, "sides", static_cast<int>(none - each.sides().begin()))
        .With("must be SIDE_RIGHT or SIDE_LEFT");
  }
  const std::int64_t count = CountOf(each);
  if (count == 0) return path.With("is empty: set numbers, sides or values");
  if (count > kMostRepetitions) {
    return path.With(absl::StrCat("makes ", count, " of one element; at most ", kMostRepetitions, " are allowed"));
  }
  if (each.values_size() > 0 && each.values_size() != count) {
    return path.Then(each, "values")
        .With(absl::StrCat("are ", each.values_size(), " for ", count, " repetitions: give one for each"));
  }
  return std::nullopt;
}

// One per number and side, or one per value. Requires: FindProblemIn finds nothing.
std::vector<Repetition> RepetitionsOf(const v1::ForEach& each) {
  std::vector<Repetition> all;
  const std::vector<int> sides = each.sides().empty() ? std::vector<int>{v1::SIDE_UNSPECIFIED}
                                                      : std::vector<int>(each.sides().begin(), each.sides().end());
  for (const int side : sides) {
    if (!each.has_numbers()) all.push_back({.side = static_cast<v1::Side>(side)});
    for (int n = each.numbers().first(); each.has_numbers() && n <= each.numbers().last(); ++n) {
      all.push_back({.number = n, .side = static_cast<v1::Side>(side)});
    }
  }
  if (ByValuesAlone(each)) all.resize(static_cast<std::size_t>(each.values_size()));
  for (int i = 0; i < each.values_size(); ++i) all[static_cast<std::size_t>(i)].value = &each.values(i);
  return all;
}

// Number and side of a body's anatomy.
std::optional<Problem> SetAnatomy(const Repetition& repetition, const Path& path, v1::Body& body) {
  if (!body.has_anatomy()) return std::nullopt;
  v1::Anatomy& anatomy = *body.mutable_anatomy();
  const Path place = path.Then(body, "anatomy");
  if (repetition.number) {
    if (anatomy.number() != 0) return place.Then(anatomy, "number").With("comes from for_each: leave it out");
    const FieldDescriptor& field = *v1::Anatomy::descriptor()->FindFieldByName("number");
    if (auto what = NumberProblem(*repetition.number, QuantityOf(field))) return place.Then(field).With(*what);
    anatomy.set_number(*repetition.number);
  }
  if (repetition.side != v1::SIDE_UNSPECIFIED) {
    if (anatomy.side() != v1::SIDE_UNSPECIFIED) {
      return place.Then(anatomy, "side").With("comes from for_each: leave it out");
    }
    anatomy.set_side(repetition.side);
  }
  return std::nullopt;
}

// Repeats the elements of one list of a scene.
class ListRepeater {
 public:
  ListRepeater(v1::Scene* scene, const FieldDescriptor& list, std::size_t& bytes_left)
      : scene_(*scene), list_(list), bytes_left_(bytes_left) {}

  std::optional<Problem> Run() {
    const Reflection& reflection = *scene_.GetReflection();
    const FieldDescriptor& each = *list_.message_type()->FindFieldByName("for_each");
    if (!Repeats(each)) return std::nullopt;
    for (int i = 0; i < reflection.FieldSize(scene_, &list_); ++i) {
      const Message& element = reflection.GetRepeatedMessage(scene_, &list_, i);
      const bool repeats = element.GetReflection()->HasField(element, &each);
      if (auto problem = repeats ? Repeat(element, each, i) : Keep(element, i)) return problem;
    }
    if (auto problem = FindTwins()) return problem;
    reflection.ClearField(&scene_, &list_);
    for (auto& element : made_) reflection.AddAllocatedMessage(&scene_, &list_, element.release());
    return std::nullopt;
  }

 private:
  // True if an element has the field `for_each`.
  bool Repeats(const FieldDescriptor& each) const {
    const Reflection& reflection = *scene_.GetReflection();
    for (int i = 0; i < reflection.FieldSize(scene_, &list_); ++i) {
      const Message& element = reflection.GetRepeatedMessage(scene_, &list_, i);
      if (element.GetReflection()->HasField(element, &each)) return true;
    }
    return false;
  }

  Path PathOf(int index) const { return Path({{&list_, index}}); }

  std::optional<Problem> Keep(const Message& element, int index) {
    made_.emplace_back(element.New())->CopyFrom(element);
    sources_.push_back(index);
    return std::nullopt;
  }

  std::optional<Problem> Repeat(const Message& element, const FieldDescriptor& field, int index) {
    const Path path = PathOf(index).Then(field);
    const auto& each = static_cast<const v1::ForEach&>(element.GetReflection()->GetMessage(element, &field));
    if (auto problem = FindProblemIn(each, path)) return problem;
    const std::unique_ptr<Message> pattern(element.New());
    pattern->CopyFrom(element);
    pattern->GetReflection()->ClearField(pattern.get(), &field);
    Placeholders placeholders(bytes_left_);
    for (const Repetition& repetition : RepetitionsOf(each)) {
      made_.emplace_back(pattern->New())->CopyFrom(*pattern);
      sources_.push_back(index);
      std::vector<PathStep> steps = {{&list_, index}};
      if (auto problem = placeholders.Fill(repetition, made_.back().get(), steps)) return problem;
      if (auto* body = dynamic_cast<v1::Body*>(made_.back().get())) {
        if (auto problem = SetAnatomy(repetition, PathOf(index), *body)) return problem;
      }
    }
    if (const std::string what = placeholders.Unused(each); !what.empty()) return path.With(what);
    return std::nullopt;
  }

  // Two bodies of one name.
  std::optional<Problem> FindTwins() const {
    if (list_.message_type() != v1::Body::descriptor()) return std::nullopt;
    std::map<std::string, int> sources;
    for (std::size_t i = 0; i < made_.size(); ++i) {
      const auto& body = static_cast<const v1::Body&>(*made_[i]);
      const auto [found, added] = sources.emplace(body.name(), sources_[i]);
      if (added) continue;
      const Path path = PathOf(sources_[i]).Then(body, "name");
      if (found->second == sources_[i]) {
        return path.With(absl::StrCat("its for_each makes two bodies named \"", body.name(),
                                      "\": write {number}, {side} or {value} in the name"));
      }
      return path.With(absl::StrCat("there are two bodies named \"", body.name(), "\", the other is of bodies[",
                                    found->second, "]: give one of them another name"));
    }
    return std::nullopt;
  }

  v1::Scene& scene_;
  const FieldDescriptor& list_;
  std::size_t& bytes_left_;
  std::vector<std::unique_ptr<Message>> made_;
  std::vector<int> sources_;  // of each of made_: the index in the list as it was
};

bool HasForEach(const FieldDescriptor& list) {
  if (!list.is_repeated() || list.message_type() == nullptr) return false;
  const FieldDescriptor* each = list.message_type()->FindFieldByName("for_each");
  return each != nullptr && each->message_type() == v1::ForEach::descriptor();
}

void GivePhysique(v1::Scene& scene) {
  if (!scene.has_physique()) return;
  for (v1::Body& body : *scene.mutable_bodies()) {
    if (!body.has_generated() || body.generated().has_physique()) continue;
    *body.mutable_generated()->mutable_physique() = scene.physique();
  }
}

}  // namespace

std::optional<Problem> Repeat(v1::Scene* scene) {
  GivePhysique(*scene);
  std::size_t bytes_left = kMostBytes;
  for (int i = 0; i < v1::Scene::descriptor()->field_count(); ++i) {
    const FieldDescriptor& list = *v1::Scene::descriptor()->field(i);
    if (!HasForEach(list)) continue;
    if (auto problem = ListRepeater(scene, list, bytes_left).Run()) return problem;
  }
  return std::nullopt;
}

}  // namespace phrenic::schema
