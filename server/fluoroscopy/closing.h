// Closes small gaps of surfaces, so that rays leave as often as they enter.
#ifndef PHRENIC_SERVER_FLUOROSCOPY_CLOSING_H_
#define PHRENIC_SERVER_FLUOROSCOPY_CLOSING_H_

#include <optional>

#include "server/mesh/mesh.h"

namespace phrenic::fluoroscopy {

// Returns the triangles of a surface, and those that close its small gaps: each edge then has as many triangles in one
// direction as in the other. A gap gets a fan from one of its vertices. Vertices at the same place count as one.
// nullopt for a surface without an inside: without triangles, or whose open edges are longer than half the root of its
// area. The page does the same in web/src/fluoroscopy/closing.ts.
std::optional<Triangles> ClosedTriangles(const Points& vertices, const Triangles& triangles);

}  // namespace phrenic::fluoroscopy

#endif  // PHRENIC_SERVER_FLUOROSCOPY_CLOSING_H_
