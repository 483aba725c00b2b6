// The inner surface of a free rib cage, along which a diaphragm slides: the radius R(turn, z; k) about a vertical axis,
// on a regular table of turns and heights, quadratic in the two coordinates of the cage, from which parts of it depart
// (cage_quadratic.h). The turn is an algebraic
// measure of the azimuth: with X = x and Y from the axis to the front, X/(|X| + |Y|) in the front right quarter, and so
// on around, so that no step needs a trigonometric function.
//
// The wall is a polar grid that is skinned to the cage's bones. It is placed at nine positions of the cage; at each,
// the radius is read where the table has its turns and heights, and a quadratic is fitted (cage_quadratic.h). The
// weight of a part at an entry is how far the wall there follows the part, of how far it follows the whole cage.
// Between the entries of the table R is bilinear.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_INNER_WALL_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_INNER_WALL_H_

#include <array>
#include <vector>

#include "server/mechanics/breathing/cage_quadratic.h"
#include "server/mechanics/breathing/wall_grid.h"
#include "server/mechanics/breathing/wall_kernel.h"

namespace phrenic {

// The gap of a point, g = r - R, positive outside, and its derivatives.
struct WallGap {
  double gap = 0;                                      // [m]
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // by the point [-]
  double by_pump = 0, by_bucket = 0;                   // [m]
};

// Immutable, thread-safe.
class InnerWall {
 public:
  // The grid of a part at each of CageFit::PositionsOf(part), with the part there and with it at 0 [m]. Without grids
  // the cage lacks the part.
  struct PartGrids {
    std::vector<Points> departed, shared;
  };
  using AllPartGrids = std::array<PartGrids, kCageParts>;
  // `rest` is the grid at rest, `moved` the same at each of CageFit::Positions() [m]. INVALID_ARGUMENT as
  // WallGrid::Find.
  static absl::StatusOr<InnerWall> Make(const Points& rest, const std::vector<Points>& moved,
                                        const AllPartGrids& parts = {});

  // Sets `table` for a position of the cage.
  void Evaluate(const CagePosition& k, const MovingParts& moving, WallTable& table) const {
    EvaluateWall(shape_, k, moving, table);
  }
  WallFrame frame() const { return {grid_.axis_y(), bottom_, height_}; }
  // Returns the gap of a point. Points below and above the table have the gap of its border.
  WallGap Gap(const WallTable& table, const Eigen::Vector3d& point) const;
  // Returns WallGap::gap alone.
  double GapAlone(const WallTable& table, const Eigen::Vector3d& point) const;
  // True if a point is closer to the axis than `margin` [m] inside of all that surrounds it: its gap is below -margin.
  bool IsFarInside(const WallTable& table, const Eigen::Vector3d& point, double margin) const;

  // A point that moves with the wall: a quadratic for x, y and z in the coordinates of the place.
  struct Follower {
    CageQuadratic shift[3];                      // [m]
    std::array<double, kCageParts> weight = {};  // of the parts
  };
  // Returns how a point near the wall at rest moves with it.
  Follower Follow(const Eigen::Vector3d& point) const;
  // Returns the change of the volume above a closed loop of points near the wall at rest, counter-clockwise seen from
  // above, up to the top of the wall, right (x < 0) and left of x = 0 [m^3]: cones from `apex` over the wall above the
  // loop and over its flat top.
  struct Volumes {
    CageFunction right, left;
  };
  Volumes VolumesAbove(const std::vector<Eigen::Vector3d>& loop, const Eigen::Vector3d& apex) const;

 private:
  explicit InnerWall(WallGrid grid) : grid_(grid) {}
  void Tabulate();
  void WeighParts();
  // Returns the volume above a loop at `feet`, right and left [m^3].
  Eigen::Vector2d VolumeOf(const Points& grid, const std::vector<GridCoordinates>& feet,
                           const std::vector<Eigen::Vector3d>& loop, const Eigen::Vector3d& apex) const;

  WallGrid grid_;
  Points rest_;                                 // [m]
  std::vector<Points> moved_;                   // [m]
  AllPartGrids parts_;                          // [m]
  std::array<Points, kCageParts> weight_ = {};  // of each vertex of the grid, in the first row; empty without the part
  double bottom_ = 0, height_ = 0;              // of the table [m]
  WallShape shape_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_INNER_WALL_H_
