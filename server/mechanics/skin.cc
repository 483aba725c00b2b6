#include "server/mechanics/skin.h"

#include <algorithm>

namespace phrenic {

SkinWeights::SkinWeights(const std::vector<SkinWeight>& sorted) {
  drivers.reserve(sorted.size());
  weights.reserve(sorted.size());
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto end = std::find_if(first, sorted.end(), [&](const SkinWeight& w) { return w.vertex != first->vertex; });
    Row row{.vertex = first->vertex, .first = static_cast<int>(drivers.size())};
    const auto take = [&](bool poses, int& count) {
      for (auto weight = first; weight != end; ++weight) {
        if ((weight->pose >= 0) != poses) continue;
        drivers.push_back(poses ? weight->pose : weight->simulated_vertex);
        weights.push_back(weight->weight);
        ++count;
      }
    };
    take(true, row.poses);
    take(false, row.simulated);
    follow_simulated = follow_simulated || row.simulated > 0;
    rows.push_back(row);
    first = end;
  }
}

}  // namespace phrenic
