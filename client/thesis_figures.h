// What the thesis measured, for comparison (2008, Java, dual core 2.4 GHz).
#ifndef PHRENIC_CLIENT_THESIS_FIGURES_H_
#define PHRENIC_CLIENT_THESIS_FIGURES_H_

#include <string>

#include "phrenic/v1/report.pb.h"
#include "phrenic/v1/scene.pb.h"

namespace phrenic::client {

struct ThesisFigure {
  std::string what;  // "fig. 5.24, perfect model, 20909 vertices"
  double steps_per_second;
};

// The figure whose model comes nearest to the scene in vertices, with or without rigid links as the scene has them: of
// the thesis' patient where the scene's soft bodies come from surface files, else of its cube and "perfect" models.
ThesisFigure NearestThesisFigure(const v1::Scene& scene, const v1::CompileReport& report);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_THESIS_FIGURES_H_
