#include "server/study/subject.h"

#include "server/mechanics/compile/compile.h"
#include "server/mechanics/compile/presets.h"
#include "server/mechanics/stability/largest_step.h"
#include "server/schema/fields.h"
#include "server/schema/schema.h"

namespace phrenic::study {

std::vector<v1::Integrator> IntegratorsFor(const google::protobuf::RepeatedField<int>& wanted) {
  std::vector<v1::Integrator> integrators;
  for (const int kind : wanted) integrators.push_back(static_cast<v1::Integrator>(kind));
  if (!integrators.empty()) return integrators;
  const auto& kinds = *v1::Integrator_descriptor();
  for (int i = 0; i < kinds.value_count(); ++i) {
    const auto kind = static_cast<v1::Integrator>(kinds.value(i)->number());
    if (kind != v1::INTEGRATOR_UNSPECIFIED && kind != v1::INTEGRATOR_STATIC) integrators.push_back(kind);
  }
  return integrators;
}

std::string NameOf(v1::Integrator integrator) {
  return schema::ChoiceName(*v1::Integrator_descriptor()->FindValueByNumber(integrator));
}

Subject With(const Subject& subject, v1::Integrator integrator) {
  Subject other = subject;
  other.parameters.set_integrator(integrator);
  return other;
}

double PredictedStep(const Subject& subject) { return LargestStableStep(*subject.model, subject.parameters).seconds(); }

absl::StatusOr<Subject> MakeSubject(const v1::SceneSource& source, const std::string& preset,
                                    const v1::Parameters& parameters, const Compiler& compile) {
  const auto model = compile(source);
  if (!model.ok()) return model.status();
  Subject subject{.model = *model, .parameters = (*model)->parameters};
  const absl::StatusOr<v1::Parameters> preset_parameters = FindPreset((*model)->scene, preset);
  if (!preset_parameters.ok()) return preset_parameters.status();
  subject.parameters.MergeFrom(*preset_parameters);
  subject.parameters.MergeFrom(parameters);
  const bool named =
      parameters.has_time_step() || preset_parameters->has_time_step() || (*model)->scene.parameters().has_time_step();
  if (!named) subject.parameters.set_time_step(ChosenStep(StableStepOf(**model, subject.parameters)));
  if (absl::Status status = schema::Validate(subject.parameters); !status.ok()) return status;
  return subject;
}

absl::StatusOr<Subject> Recompile(const v1::CreateStudyRequest& request, const Subject& subject, const v1::Scene& scene,
                                  const Compiler& compile) {
  v1::SceneSource source = request.source();
  *source.mutable_scene() = scene;
  const auto model = compile(source);
  if (!model.ok()) return model.status();
  return Subject{.model = *model, .parameters = subject.parameters};
}

}  // namespace phrenic::study
