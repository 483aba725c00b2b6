// Where what is served lies: beside an installed program, else in the source it was built from.
#ifndef PHRENIC_SERVER_SCHEMA_PLACES_H_
#define PHRENIC_SERVER_SCHEMA_PLACES_H_

#include <string>

namespace phrenic {

// PREFIX/share/phrenic/NAME where the program is PREFIX/bin/..., and that folder is there; else `otherwise`.
std::string Installed(const std::string& name, const std::string& otherwise);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_SCHEMA_PLACES_H_
