// Seen bodies that ride on carriers: x = x_rest + sum_c w_c u_c, u_c the displacement of carrier c's nearest point.
#ifndef PHRENIC_SERVER_MECHANICS_RIDE_H_
#define PHRENIC_SERVER_MECHANICS_RIDE_H_

#include <vector>

#include "server/mechanics/state.h"

namespace phrenic {

// One vertex's share of one carrier.
struct RideShare {
  int vertex = 0;            // of the riding body
  int pose = -1;             // the carrier: a pose, or ...
  int simulated_vertex = -1;  // ... a simulated vertex
  double weight = 0;         // shares of a vertex sum to 1
};

struct Ride {
  int body = 0;
  std::vector<RideShare> shares;  // sorted by vertex
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_RIDE_H_
