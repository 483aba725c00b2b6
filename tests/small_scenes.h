// Small scenes that compile and step fast.
#ifndef PHRENIC_TESTS_SMALL_SCENES_H_
#define PHRENIC_TESTS_SMALL_SCENES_H_

#include <string>

namespace phrenic {

// A falling triangle of springs with one fixed corner, beside a fixed post.
inline const char kTriangle[] = R"(
  name: "triangle" title: "Triangle"
  layers { name: "tissue" title: "Tissue" color: "#c8553d" opacity: 0.5 }
  bodies {
    name: "post" role: ROLE_AT_REST
    polyhedron { vertices { x: 2 } vertices { x: 3 } edges { a: 0 b: 1 } }
  }
  bodies {
    name: "sheet" layer: "tissue" role: ROLE_DEFORMABLE mass: 3 fixed_vertices: [0]
    polyhedron {
      vertices { } vertices { x: 1 } vertices { y: 1 }
      triangles { a: 0 b: 1 c: 2 }
    }
  }
  forces { name: "weave" springs { bodies: "sheet" stiffness: 20 } }
  forces { friction { bodies: "sheet" rate: 0.5 } }
  forces { gravity { bodies: "sheet" acceleration { z: -1 } } }
  probes { name: "corner" body: "sheet" vertex: 2 }
  parameters { time_step: 0.01 }
)";

// The same scene with the text `more` appended.
inline std::string Triangle(const std::string& more) { return std::string(kTriangle) + more; }

// The same scene with other parameters in place of its time step.
inline std::string Retimed(const std::string& parameters) {
  std::string text = kTriangle;
  const std::string old = "time_step: 0.01";
  return text.replace(text.find(old), old.size(), parameters);
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_SMALL_SCENES_H_
