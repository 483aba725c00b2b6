// A spring, as forces list them and solvers lay them out.
#ifndef PHRENIC_SERVER_MECHANICS_SPRING_H_
#define PHRENIC_SERVER_MECHANICS_SPRING_H_

namespace phrenic {

struct Spring {
  int a, b;            // simulated vertices
  double stiffness;    // [N/m], at elasticity 1
  double rest_length;  // [m]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SPRING_H_
