// The report of `phrenic inspect` as text.
#ifndef PHRENIC_CLIENT_PRINT_SURFACE_REPORT_H_
#define PHRENIC_CLIENT_PRINT_SURFACE_REPORT_H_

#include <ostream>

#include "phrenic/v1/inspect.pb.h"

namespace phrenic::client {

// Prints counts, measures, the ten largest components, suggested repairs and reasons for which a scene refuses the
// file. Lengths are in mm, areas in mm^2, volumes in ml, as in the report.
void PrintSurface(const v1::SurfaceReport& report, std::ostream& out);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_SURFACE_REPORT_H_
