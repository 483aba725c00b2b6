// What a surface file holds, as people read it.
#ifndef PHRENIC_CLIENT_PRINT_SURFACE_REPORT_H_
#define PHRENIC_CLIENT_PRINT_SURFACE_REPORT_H_

#include <ostream>

#include "phrenic/v1/inspect.pb.h"

namespace phrenic::client {

// Counts and measures, the ten largest components, and in words what should be repaired and would be refused.
void PrintSurface(const v1::SurfaceReport& report, std::ostream& out);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_SURFACE_REPORT_H_
