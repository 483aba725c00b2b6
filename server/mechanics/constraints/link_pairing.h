// The pairing of figure 3.4: which vertices of the two layers of a body are joined by rigid links.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_PAIRING_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_PAIRING_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Pairs of vertices of the body, 2 x n. Each vertex, in index order, takes the nearest vertex within the distance that
// is free, whose normal makes no acute angle with its own, and that lies above the plane as it does itself. At most one
// link a vertex. The result depends on the order of the vertices, which is the mesh's.
absl::StatusOr<Edges> PairLinks(const v1::LinkPairing& scene, int body, std::string_view path,
                                const ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_PAIRING_H_
