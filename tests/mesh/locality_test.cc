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

// A rows x columns grid whose vertices have been given numbers at random.
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

TEST(LocalOrder, TakesEachVertexThatIsJoinedOnce) {
  Edges edges(2, 3);
  edges << 5, 1, 7,  //
      1, 2, 8;
  EXPECT_THAT(LocalOrder(edges, 10), UnorderedElementsAre(1, 2, 5, 7, 8));
  EXPECT_THAT(LocalOrder(Edges(2, 0), 4), IsEmpty());
}

TEST(LocalOrder, UnrollsAChain) {
  Edges edges(2, 3);
  edges << 3, 0, 2,  //
      0, 2, 1;
  EXPECT_THAT(LocalOrder(edges, 4), ElementsAre(3, 0, 2, 1));
}

TEST(LocalOrder, BringsTheEdgesOfAGridTogether) {
  const Edges edges = ScatteredGrid(40, 10);
  const std::vector<int> order = LocalOrder(edges, 400);
  std::vector<int> place(400);
  for (int i = 0; i < 400; ++i) place[order[i]] = i;
  int furthest = 0;
  for (const auto& edge : edges.colwise()) furthest = std::max(furthest, std::abs(place[edge[0]] - place[edge[1]]));
  EXPECT_LE(furthest, 11);  // the narrower side, and one
}

TEST(CurveOrder, GoesFromCellToNextCell) {
  Points cells(3, 512);  // 8 x 8 x 8, each an edge from its neighbours
  for (int i = 0; i < 512; ++i) cells.col(i) << i % 8, i / 8 % 8, i / 64;
  const std::vector<int> order = CurveOrder(cells);
  std::vector<int> all = order;
  std::sort(all.begin(), all.end());
  for (int i = 0; i < 512; ++i) EXPECT_EQ(all[i], i);
  for (int i = 1; i < 512; ++i) EXPECT_EQ((cells.col(order[i]) - cells.col(order[i - 1])).norm(), 1) << i;
}

TEST(CurveOrder, TakesPointsOfOnePlaceByTheirIndex) {
  EXPECT_THAT(CurveOrder(Points::Constant(3, 3, 0.5)), ElementsAre(0, 1, 2));
  EXPECT_THAT(CurveOrder(Points(3, 0)), IsEmpty());
}

}  // namespace
}  // namespace phrenic
