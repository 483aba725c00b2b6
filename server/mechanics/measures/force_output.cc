#include "server/mechanics/measures/force_output.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace phrenic {
namespace {

class OutputMeasure final : public Measure {
 public:
  OutputMeasure(std::string name, const Force& force, size_t output)
      : Measure(std::move(name), force.outputs()[output].unit), force_(force), output_(output) {}
  double Value(const EvalContext& at) const override { return force_.Read(output_, at); }

 private:
  const Force& force_;  // of the same model
  size_t output_;
};

std::string NamesOf(std::span<const Force::Output> outputs) {
  return absl::StrJoin(outputs, ", ",
                       [](std::string* out, const Force::Output& output) { absl::StrAppend(out, output.name); });
}

}  // namespace

absl::StatusOr<const Force*> FindForce(const std::string& name, std::string_view path, const ModelBuilder& builder) {
  std::vector<std::string> names;
  for (const auto& force : builder.model.forces) {
    if (force->name() == name) return force.get();
    names.push_back(force->name());
  }
  // The default name of an element begins with its kind: an older name of the kind stands for the present one.
  if (const auto* kind = v1::Force::descriptor()->FindFieldByName(name.substr(0, name.find(':')))) {
    const std::string& present = kind->options().GetExtension(v1::alias_of);
    if (!present.empty()) return FindForce(present + name.substr(kind->name().size()), path, builder);
  }
  return FieldError(path, absl::StrCat("there is no force \"", name, "\"",
                                       names.empty() ? "; there is none" : "; there are ", absl::StrJoin(names, ", ")));
}

absl::StatusOr<std::unique_ptr<Measure>> MakeForceOutput(const v1::ForceOutput& scene, const std::string& name,
                                                         std::string_view path, ModelBuilder& builder) {
  const auto force = FindForce(scene.force(), absl::StrCat(std::string(path), ".force"), builder);
  if (!force.ok()) return force.status();
  const std::span<const Force::Output> outputs = (*force)->outputs();
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (scene.output() != outputs[i].name) continue;
    builder.ReportElement("measure", name, 1, "force", absl::StrCat(outputs[i].name, " of ", (*force)->name()));
    return std::make_unique<OutputMeasure>(name, **force, i);
  }
  return FieldError(absl::StrCat(std::string(path), ".output"),
                    absl::StrCat("force \"", scene.force(), "\" has no output \"", scene.output(), "\"",
                                 outputs.empty() ? "; it has none" : "; it has ", NamesOf(outputs)));
}

}  // namespace phrenic
