// The catalogue of what can be exported: record's motion formats, the page that plays a motion, and meshio's
// surface formats for one instant.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_EXPORT_CATALOGUE_H_
#define PHRENIC_SERVER_SESSION_EXPORT_EXPORT_CATALOGUE_H_

#include <vector>

#include "server/record/recorder.h"

namespace phrenic::session {

// Returns one row for each format of record/formats.cc, then the page, then one for each other format that meshio
// writes. Thread-safe. The list is made at the first call and lives as long as the process.
const std::vector<record::Format>& ExportFormats();

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_EXPORT_CATALOGUE_H_
