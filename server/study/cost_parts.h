// A scene with one part of it left out, in three ways: never named, named but of nothing, and switched off live.
#ifndef PHRENIC_SERVER_STUDY_COST_PARTS_H_
#define PHRENIC_SERVER_STUDY_COST_PARTS_H_

#include <optional>
#include <string>
#include <vector>

#include "phrenic/v1/parameters.pb.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::study {

// The parts that the scene names and that may cost something in a step, in its order, each once: "springs", "links",
// "muscles" (action lines and fibres), "ribs" (with the sternum, which follows them), ... Rides are none: they are
// worked out with frames.
std::vector<std::string> PartsOf(const v1::Scene& scene);

// The scene without the part: as if it had never been named. Without ribs, driven bodies are at rest.
v1::Scene Without(v1::Scene scene, const std::string& part);

// The model's scene with the part still named, but so that there is nothing for it to do and the compile step leaves it
// out: links that fit no pair, springs of a region without edges, friction of rate 0. Nothing for parts of which the
// compile step cannot know that (contact, motions).
std::optional<v1::Scene> LeftOut(const Model& model, const std::string& part);

// Switches the part off by a live parameter; false where there is none for it.
bool SwitchOff(const std::string& part, v1::Parameters& parameters);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_PARTS_H_
