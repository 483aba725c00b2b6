// Removes one part of a scene in three ways: from the scene, by making it empty, and by a live parameter.
#ifndef PHRENIC_SERVER_STUDY_COST_PARTS_H_
#define PHRENIC_SERVER_STUDY_COST_PARTS_H_

#include <optional>
#include <string>
#include <vector>

#include "phrenic/v1/parameters.pb.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::study {

// Returns the parts of a scene that may cost time in a step, each once, in the scene's order: "springs", "links",
// "muscles" (action lines and fibres), "ribs" (with the sternum, which follows them), ... Skinned bodies are not among
// them: they are evaluated per frame, not per step.
std::vector<std::string> PartsOf(const v1::Scene& scene);

// Returns the scene without the elements of the part. Without "ribs", driven bodies are at rest.
v1::Scene Without(v1::Scene scene, const std::string& part);

// Returns the model's scene with the part made empty, so that the compile step leaves it out: links that match no pair,
// springs of a region without edges, friction of rate 0. Returns nullopt for parts whose emptiness the compile step
// cannot detect (contact, motions).
std::optional<v1::Scene> LeftOut(const Model& model, const std::string& part);

// Switches the part off by a live parameter. Returns false if there is no parameter for it.
bool SwitchOff(const std::string& part, v1::Parameters& parameters);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_PARTS_H_
