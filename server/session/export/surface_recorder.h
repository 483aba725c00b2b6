// What can be exported: record's motions, and the surface formats of meshio for one instant.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_SURFACE_RECORDER_H_
#define PHRENIC_SERVER_SESSION_EXPORT_SURFACE_RECORDER_H_

#include <vector>

#include "server/record/recorder.h"

namespace phrenic::session {

// The catalogue: a row a format of record/formats.cc, then one for each other format that meshio writes.
const std::vector<record::Format>& ExportFormats();

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_SURFACE_RECORDER_H_
