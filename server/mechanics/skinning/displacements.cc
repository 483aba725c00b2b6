#include "server/mechanics/skinning/displacements.h"

namespace phrenic {
namespace {

struct AllDisplacements {
  std::vector<Displacement> of_vertices;
};

}  // namespace

void SetDisplacements(const ConstPoints& x, const double* rest, std::vector<Displacement>& displacements) {
  displacements.resize(static_cast<size_t>(x.cols()));
  const double* now = x.data();
  for (Displacement& displacement : displacements) {
    for (int k = 0; k < 3; ++k) displacement.by[k] = *now++ - *rest++;
  }
}

const Displacement* DisplacementsOf(const EvalContext& at, const double* rest) {
  if (at.displacements != nullptr) return at.displacements;
  std::vector<Displacement>& displacements = at.scratch.Get<AllDisplacements>().of_vertices;
  SetDisplacements(at.x, rest, displacements);
  return displacements.data();
}

}  // namespace phrenic
