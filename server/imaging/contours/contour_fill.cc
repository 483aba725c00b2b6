#include "server/imaging/contours/contour_fill.h"

#include <algorithm>
#include <cmath>

namespace phrenic::imaging {

double RowsCrossed(const Contour& contour) {
  double rows = static_cast<double>(contour.cols());
  for (Eigen::Index i = 0; i < contour.cols(); ++i) {
    rows += std::abs(contour(1, (i + 1) % contour.cols()) - contour(1, i));
  }
  return rows;
}

double BoxPixels(const Contour& contour) {
  const Eigen::Vector2d sizes = contour.rowwise().maxCoeff() - contour.rowwise().minCoeff();
  return (sizes.array().ceil() + 1).prod();
}

std::vector<PixelRun> FillContours(const std::vector<const Contour*>& contours, const Eigen::Vector2i& size) {
  int low = size.y(), high = -1;  // rows that edges may cross
  for (const Contour* contour : contours) {
    low = std::max(0, std::min(low, static_cast<int>(std::ceil(contour->row(1).minCoeff()))));
    high = std::min(size.y() - 1, std::max(high, static_cast<int>(std::ceil(contour->row(1).maxCoeff())) - 1));
  }
  if (low > high) return {};
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(high - low + 1));
  for (const Contour* contour : contours) {
    for (Eigen::Index i = 0; i < contour->cols(); ++i) {
      Eigen::Vector2d a = contour->col(i), b = contour->col((i + 1) % contour->cols());
      if (a.y() > b.y()) std::swap(a, b);
      // A row on a vertex counts the edge above it alone.
      const int from = std::max(0, static_cast<int>(std::ceil(a.y())));
      const int to = std::min(size.y() - 1, static_cast<int>(std::ceil(b.y())) - 1);
      for (int row = from; row <= to; ++row) {
        crossings[row - low].push_back(a.x() + (b.x() - a.x()) * (row - a.y()) / (b.y() - a.y()));
      }
    }
  }
  std::vector<PixelRun> runs;
  for (int row = low; row <= high; ++row) {
    std::vector<double>& along = crossings[row - low];
    std::sort(along.begin(), along.end());
    for (std::size_t c = 0; c + 1 < along.size(); c += 2) {
      const int first = std::max(0, static_cast<int>(std::ceil(along[c])));
      const int last = std::min(size.x() - 1, static_cast<int>(std::floor(along[c + 1])));
      if (first <= last) runs.push_back({row, first, last});
    }
  }
  return runs;
}

}  // namespace phrenic::imaging
