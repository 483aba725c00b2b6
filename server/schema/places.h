// Finds data files: beside an installed program, or in the source tree that it was built from.
#ifndef PHRENIC_SERVER_SCHEMA_PLACES_H_
#define PHRENIC_SERVER_SCHEMA_PLACES_H_

#include <string>

namespace phrenic {

// Returns PREFIX/share/phrenic/NAME if the program is PREFIX/bin/... and that folder exists; otherwise `otherwise`.
std::string Installed(const std::string& name, const std::string& otherwise);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_SCHEMA_PLACES_H_
