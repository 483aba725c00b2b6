// What no breath may do: a sheet that crosses itself, ribs through the sheet, a dome that is hollow.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_FLAWS_H_
#define PHRENIC_SERVER_PHYSIOLOGY_FLAWS_H_

#include <array>
#include <utility>
#include <vector>

#include "server/mesh/triangle_tree.h"
#include "server/physiology/columns.h"
#include "server/physiology/parts.h"

namespace phrenic::physiology {

enum Flaw { kSelfCrossings, kCrossedLayers, kPiercingRibs, kPiercingLungs, kHollow, kFlaws };
// Of each flaw: a count, or the depth of the hollow [m]; kNone if the scene lacks what it is measured on.
using FlawValues = std::array<double, kFlaws>;

// Immutable, thread-safe.
class FlawFinder {
 public:
  // Keeps references.
  FlawFinder(const Model& model, const Parts& parts, const Columns& columns);

  FlawValues At(const State& state) const;

 private:
  // A surface at one moment.
  struct Surface {
    Points x;
    const TriangleTree* tree;
    TriangleTree::Boxes boxes;
    // True if a point lies behind the surface by more than `depth` [m].
    bool Hides(const Eigen::Vector3d& point, double depth) const;
  };
  static Surface Fitted(const TriangleTree& tree, Points x);
  void PairLayers();
  int CrossedLayers(const Points& sheet) const;
  // Counts points that are inside the layers by more than `depth` [m], or beyond the middle surface.
  int Through(const std::vector<Surface>& sheet, const ConstPoints& points, double depth) const;
  int PiercingLungs(const State& state, const std::vector<Surface>& sheet, const Points& ribs) const;
  std::vector<Surface> Sheet(const State& state) const;
  Points Ribs(const State& state) const;

  const Model& model_;
  const Parts& parts_;
  const Columns& columns_;
  bool closed_;                  // the sheet has two layers
  TriangleTree sheet_, muscle_;  // of Parts::sheet and Parts::muscle
  std::vector<TriangleTree> lungs_;
  std::vector<std::pair<int, int>> pairs_;  // vertices of opposite layers
};

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_FLAWS_H_
