// Live parameters that change nothing in a scene.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_IDLE_PARAMETERS_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_IDLE_PARAMETERS_H_

#include "phrenic/v1/report.pb.h"
#include "phrenic/v1/scene.pb.h"

namespace phrenic {

// Reports the live parameters without effect in this scene, which viewers hide.
void ReportIdleParameters(const v1::Scene& scene, v1::CompileReport& report);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_IDLE_PARAMETERS_H_
