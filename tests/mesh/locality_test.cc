#include "server/mesh/locality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace phrenic {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

// Returns the edges of a rows x columns grid whose vertices are numbered at random.
Edges ScatteredGrid(int rows, int columns) {
  std::vector<int> number(rows * columns);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(3));
  std::vector<Eigen::Vector2i> edges;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const int here = r * columns + c;
      if (c + 1 < columns) edges.emplace_back(number[here], number[here + 1]);
      if (r + 1 < rows) edges.emplace_back(number[here], number[here + columns]);
    }
  }
  Edges made(2, static_cast<Eigen::Index>(edges.size()));
  for (size_t e = 0; e < edges.size(); ++e) made.col(static_cast<Eigen::Index>(e)) = edges[e];
  return made;
}

TEST(CuthillMcKeeOrder, HoldsEachConnectedVertexOnce) {
  Edges edges(2, 3);
  edges << 5, 1, 7,  //
      1, 2, 8;
  EXPECT_THAT(CuthillMcKeeOrder(edges, 10), UnorderedElementsAre(1, 2, 5, 7, 8));
  EXPECT_THAT(CuthillMcKeeOrder(Edges(2, 0), 4), IsEmpty());
}

TEST(CuthillMcKeeOrder, FollowsAChain) {
  Edges edges(2, 3);
  edges << 3, 0, 2,  //
      0, 2, 1;
  EXPECT_THAT(CuthillMcKeeOrder(edges, 4), ElementsAre(3, 0, 2, 1));
}

TEST(CuthillMcKeeOrder, ReducesTheBandwidthOfAGrid) {
  const Edges edges = ScatteredGrid(40, 10);
  const std::vector<int> order = CuthillMcKeeOrder(edges, 400);
  std::vector<int> rank(400);
  for (int i = 0; i < 400; ++i) rank[order[i]] = i;
  int bandwidth = 0;
  for (const auto& edge : edges.colwise()) bandwidth = std::max(bandwidth, std::abs(rank[edge[0]] - rank[edge[1]]));
  EXPECT_LE(bandwidth, 11);  // the grid's width plus one
}

TEST(HilbertOrder, StepsBetweenAdjacentCells) {
  Points cells(3, 512);  // an 8 x 8 x 8 grid of unit cells
  for (int i = 0; i < 512; ++i) cells.col(i) << i % 8, i / 8 % 8, i / 64;
  const std::vector<int> order = HilbertOrder(cells);
  std::vector<int> all = order;
  std::sort(all.begin(), all.end());
  for (int i = 0; i < 512; ++i) EXPECT_EQ(all[i], i);
  for (int i = 1; i < 512; ++i) EXPECT_EQ((cells.col(order[i]) - cells.col(order[i - 1])).norm(), 1) << i;
}

TEST(HilbertOrder, KeepsTheOrderOfCoincidentPoints) {
  EXPECT_THAT(HilbertOrder(Points::Constant(3, 3, 0.5)), ElementsAre(0, 1, 2));
  EXPECT_THAT(HilbertOrder(Points(3, 0)), IsEmpty());
}

}  // namespace
}  // namespace phrenic
