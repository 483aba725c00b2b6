// Fills planar contours with voxels.
#ifndef PHRENIC_SERVER_IMAGING_CONTOURS_CONTOUR_FILL_H_
#define PHRENIC_SERVER_IMAGING_CONTOURS_CONTOUR_FILL_H_

#include <Eigen/Core>
#include <vector>

namespace phrenic::imaging {

using Contour = Eigen::Matrix2Xd;  // vertices of a closed polygon, one column each, in pixels

// The pixels of a row from `first` to `last`.
struct PixelRun {
  int row, first, last;
};

// Returns the pixels of a picture of this size (columns, rows) whose centres, at whole numbers, are inside an odd
// number of the polygons: holes are polygons in others, or joined to them by a line that is passed twice. In the order
// of rows.
std::vector<PixelRun> FillContours(const std::vector<const Contour*>& contours, const Eigen::Vector2i& size);

// The cost of filling is that of both together.
//
// Returns how many rows the edges of a polygon cross together, with one more for each edge.
double RowsCrossed(const Contour& contour);
// Returns how many pixels the box around a polygon has: runs of polygons have at most the sum of theirs.
double BoxPixels(const Contour& contour);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_CONTOURS_CONTOUR_FILL_H_
