// A sheet whose every force is worked out range by range.
#ifndef PHRENIC_TESTS_MECHANICS_MIXED_SHEET_H_
#define PHRENIC_TESTS_MECHANICS_MIXED_SHEET_H_

namespace phrenic {

// More than two blocks of vertices, the last one no whole number of vectors; springs of two kinds and precisions, held
// at a side.
inline const char kMixedSheet[] = R"(
  name: "ranges"
  bodies { name: "sheet" role: ROLE_DEFORMABLE mass: 2 grid { columns: 40 rows: 30 u { x: 0.01 } v { y: 0.01 } }
           regions { name: "left" low {} high { x: 0.201 y: 1 z: 1 } } }
  bodies { name: "bone" role: ROLE_AT_REST polyhedron { vertices {} vertices { y: 0.3 } } }
  forces { springs { bodies: "sheet" region: "left" stiffness: 10 rest_length_ratio: 0.9 balanced_at_rest: true } }
  forces { springs { bodies: "sheet" exclude_region: "left" material { youngs_modulus: 5000 thickness: 0.003 }
           precision: PRECISION_SINGLE } }
  forces { friction { bodies: "sheet" rate: 3 } }
  forces { gravity { bodies: "sheet" acceleration { x: 1 z: -9.81 } } }
  forces { point_load { body: "sheet" vertices: [3, 700, 511] force { y: 2 } } }
  forces { attachment { bodies: "sheet" anchors: "bone" radius: 0.05 stiffness: 40 } }
  forces { action_line { bodies: "sheet" origin {} direction { z: -1 } radius: 0.3 force: 2 } }
)";

}  // namespace phrenic

#endif  // PHRENIC_TESTS_MECHANICS_MIXED_SHEET_H_
