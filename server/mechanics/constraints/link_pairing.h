// Pairing of the vertices of a body's two layers for rigid links (thesis figure 3.4).
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_PAIRING_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_PAIRING_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Returns pairs of vertices of the body, 2 x n. Greedy in index order: each unpaired vertex above the plane is paired
// with the nearest unpaired vertex above the plane within the distance whose normal forms no acute angle with its own.
// A vertex has at most one link. The result depends on the mesh's vertex order. INVALID_ARGUMENT if the region or the
// plane is invalid.
absl::StatusOr<Edges> PairLinks(const v1::LinkPairing& scene, int body, std::string_view path,
                                const ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_PAIRING_H_
