// A small thorax whose cage forces move: four ribs, a cylindrical wall, and a dome inserted on it.
#ifndef PHRENIC_TESTS_MECHANICS_BREATHING_FREE_CAGE_H_
#define PHRENIC_TESTS_MECHANICS_BREATHING_FREE_CAGE_H_

#include <cmath>
#include <numbers>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {

// Returns a rib as a strip from its head at the back to its end at the front, at a height [m].
inline std::string RibText(int number, bool right, double z) {
  std::string text = absl::StrFormat(
      "bodies { name: 'rib-%d-%s' layer: 'ribs' role: ROLE_DRIVEN anatomy { structure: STRUCTURE_RIB number: %d side: "
      "%s "
      "} polyhedron { ",
      number, right ? "right" : "left", number, right ? "SIDE_RIGHT" : "SIDE_LEFT");
  constexpr int kPoints = 9;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = std::numbers::pi * (0.08 + 0.84 * i / (kPoints - 1));  // from the back to the front
    const double x = (right ? -0.108 : 0.108) * std::sin(angle), y = 0.108 * std::cos(angle);
    for (const double up : {0.0, 0.004}) {
      absl::StrAppendFormat(&text, "vertices { x: %.9g y: %.9g z: %.9g } ", x, y,
                            z + up - 0.04 * std::sin(angle) - 0.02 * i / (kPoints - 1));
    }
  }
  for (int i = 0; i + 1 < kPoints; ++i) {
    absl::StrAppendFormat(&text, "triangles { a: %d b: %d c: %d } triangles { a: %d b: %d c: %d } ", 2 * i, 2 * i + 2,
                          2 * i + 1, 2 * i + 1, 2 * i + 2, 2 * i + 3);
  }
  return text + "} } ";
}

// Returns a polar grid of radius 0.1 m.
inline std::string WallText() {
  constexpr int kColumns = 32, kRows = 12;
  std::string text = "bodies { name: 'wall' role: ROLE_SEEN polyhedron { ";
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const double angle = 2 * std::numbers::pi * i / kColumns;
      absl::StrAppendFormat(&text, "vertices { x: %.12g y: %.12g z: %.12g } ", 0.1 * std::sin(angle),
                            -0.1 * std::cos(angle), -0.04 + 0.18 * j / (kRows - 1));
    }
  }
  for (int j = 0; j + 1 < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const int a = j * kColumns + i, b = j * kColumns + (i + 1) % kColumns;
      absl::StrAppendFormat(&text, "triangles { a: %d b: %d c: %d } triangles { a: %d b: %d c: %d } ", a, b,
                            b + kColumns, a, b + kColumns, a + kColumns);
    }
  }
  return text + "} } ";
}

// Returns the scene with the given forces on the dome "sheet" and its wall "wall", and parts of the cage.
inline std::string FreeCage(const std::string& forces, const std::string& parts = "") {
  std::string text = "name: 'free-cage' breath { waveform: WAVEFORM_RAISED_COSINE } ";
  for (const int number : {5, 7}) {
    for (const bool right : {true, false}) absl::StrAppend(&text, RibText(number, right, number == 5 ? 0.12 : 0.06));
  }
  absl::StrAppend(&text, WallText(),
                  "bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 0.3 ellipsoid { radii { x: 0.1 y: 0.1 z: 0.09 } "
                  "divisions: 6 upper_half: true } } "
                  "motions { ribs { bodies: 'ribs' free { pump_inertia: 0.01 bucket_inertia: 0.02 ",
                  parts,
                  "} "
                  "end_states { number: 5 pump_degrees: 9 bucket_degrees: 11 } "
                  "end_states { number: 7 pump_degrees: 7 bucket_degrees: 10 } } } "
                  "motions { skin { bodies: 'wall' drivers: 'ribs' } } "
                  "motions { insertion { body: 'sheet' region: 'rim' wall: 'wall' apex { z: -0.03 } } } ",
                  forces);
  return text;
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_MECHANICS_BREATHING_FREE_CAGE_H_
