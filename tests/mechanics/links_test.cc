// Rigid links that share vertices: chains, grids, what cannot hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "absl/strings/str_format.h"
#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/constraints/link_kernel.h"
#include "server/mechanics/linalg/sparse_ldlt.h"
#include "tests/compile_text.h"
#include "tests/mechanics/every_target.h"

namespace phrenic {
namespace {

struct Pair {
  int a, b;
};

std::string List(const std::vector<Pair>& pairs) {
  std::string text = "list {";
  for (const auto& [a, b] : pairs) text += absl::StrFormat(" links { a: %d b: %d }", a, b);
  return text + " }";
}

// A hanging net of columns x rows vertices, its upper corners fixed, links along all its edges.
std::string Net(int columns, int rows, const std::vector<Pair>& pairs, double friction = 0.5) {
  return absl::StrFormat(
             "name: 'net' bodies { name: 'net' role: ROLE_DEFORMABLE mass: %d fixed_vertices: [0, %d] "
             "grid { columns: %d rows: %d u { x: 0.1 } v { y: 0.1 } } } "
             "forces { gravity { bodies: 'net' acceleration { z: -9.81 } } } "
             "forces { friction { bodies: 'net' rate: %g } } constraints { rigid_links { body: 'net' ",
             columns * rows, columns - 1, columns, rows, friction) +
         List(pairs) + " } }";
}

std::vector<Pair> GridPairs(int columns, int rows) {
  std::vector<Pair> pairs;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      // The upper row is fixed at both ends: it could not sag if it were linked to its full width.
      if (c + 1 < columns && r > 0) pairs.push_back({r * columns + c, r * columns + c + 1});
      if (r + 1 < rows) pairs.push_back({r * columns + c, r * columns + c + columns});
    }
  }
  return pairs;
}

TEST(LinkedNet, HoldsAllItsLengthsWhileItFalls) {
  const auto model = CompileText(Net(12, 8, GridPairs(12, 8)));
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(Step(*model, model->parameters, 1e-3, state, work).ok());
    worst = std::max(worst, LargestResidual(*model, state).metres);
  }
  EXPECT_LT(worst, 1e-9 * 0.1);
}

TEST(LinkedNet, DoesNotDependOnTheOrderOfItsLinks) {
  std::vector<Pair> pairs = GridPairs(5, 4);
  const auto listed = CompileText(Net(5, 4, pairs));
  std::shuffle(pairs.begin(), pairs.end(), std::mt19937(3));
  for (size_t i = 0; i < pairs.size(); i += 2) std::swap(pairs[i].a, pairs[i].b);
  const auto shuffled = CompileText(Net(5, 4, pairs));
  EXPECT_LT((RunTo(*listed, 0.3, 1e-3).x - RunTo(*shuffled, 0.3, 1e-3).x).cwiseAbs().maxCoeff(), 1e-8);
}

// Of a falling chain the free end cracks like a whip: links there turn by a radian in one step.
TEST(LinkedChain, HoldsAllItsLengthsWhereItsEndCracksLikeAWhip) {
  constexpr int kLength = 100;
  std::string text = absl::StrFormat(
      "name: 'whip' bodies { name: 'whip' role: ROLE_DEFORMABLE mass: %d fixed_vertices: 0 polyhedron {", kLength);
  std::vector<Pair> pairs;
  for (int i = 0; i <= kLength; ++i) text += absl::StrFormat(" vertices { x: %g }", 0.01 * i);
  for (int i = 0; i < kLength; ++i) pairs.push_back({i, i + 1});
  const auto model = CompileText(text +
                                 " } } forces { gravity { bodies: 'whip' acceleration { z: -9.81 } } } constraints { "
                                 "rigid_links { body: 'whip' " +
                                 List(pairs) + " } }");
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  double worst = 0;
  for (int i = 0; i < 3000; ++i) {
    ASSERT_TRUE(Step(*model, model->parameters, 1e-3, state, work).ok());
    worst = std::max(worst, LargestResidual(*model, state).metres);
  }
  EXPECT_LT(worst, 1e-9 * 0.01);
}

// Two masses a metre apart at rest, the outer ones of four in a row, are driven to three metres: two links of a metre
// and one between them cannot span it at the end.
TEST(ConflictingLinks, EndWithAFiniteStateAndSayWhatIsLeft) {
  const auto model = CompileText(
      "name: 'torn' bodies { name: 'row' role: ROLE_DEFORMABLE mass: 4 polyhedron { vertices {} vertices { x: 1 } "
      "vertices { x: 2 } vertices { x: 3 } } } "
      "motions { oscillation { body: 'row' vertices: 0 amplitude { x: -1 z: 0.2 } period: 1 } } "
      "motions { oscillation { body: 'row' vertices: 3 amplitude { x: 1 } period: 1 } } "
      "constraints { rigid_links { body: 'row' list { links { a: 0 b: 1 } links { a: 1 b: 2 } links { a: 2 b: 3 } } } "
      "}");
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  for (int i = 0; i < 250; ++i) ASSERT_TRUE(Step(*model, model->parameters, 1e-3, state, work).ok());
  EXPECT_TRUE(state.x.allFinite());
  EXPECT_TRUE(state.v.allFinite());
  const double span = (state.x.col(3) - state.x.col(0)).norm();
  EXPECT_GE(LargestResidual(*model, state).metres, (span - 3) / 3 - 1e-9) << "no way to share it out is better";
  EXPECT_LE(LargestResidual(*model, state).metres, span - 3 + 1e-9) << "one link at most bears it all";
  const std::string warning = ResidualWarning(*model, model->parameters, LargestResidual(*model, state));
  EXPECT_NE(warning.find("rigid-links:row does not hold"), std::string::npos) << warning;
}

TEST(LinkedChain, IsNotWarnedOfWhenItIsSwitchedOff) {
  const auto model = CompileText(Net(5, 4, GridPairs(5, 4)));
  State state = model->InitialState();
  state.x *= 2;
  v1::Parameters parameters = model->parameters;
  EXPECT_NE(ResidualWarning(*model, parameters, LargestResidual(*model, state)), "");
  parameters.set_apply_links(false);
  EXPECT_EQ(ResidualWarning(*model, parameters, LargestResidual(*model, state)), "");
}

TEST(LinkedChain, IsNotWarnedOfWhileItHolds) {
  const auto model = CompileText(Net(5, 4, GridPairs(5, 4)));
  const State state = RunTo(*model, 0.3, 1e-3);
  EXPECT_EQ(ResidualWarning(*model, model->parameters, LargestResidual(*model, state)), "");
}

// Implicit steps end too where links cannot hold, and leave as much.
TEST(ConflictingLinks, EndWithAFiniteStateOrAnHonestStopUnderImplicitIntegrators) {
  for (const char* integrator : {"LINEAR_IMPLICIT_EULER", "BDF2", "TR_BDF2", "STATIC"}) {
    const auto model = CompileText(
        std::string("name: 'torn' bodies { name: 'row' role: ROLE_DEFORMABLE mass: 4 polyhedron { vertices {} vertices "
                    "{ x: 1 } vertices { x: 2 } vertices { x: 3 } } } "
                    "motions { oscillation { body: 'row' vertices: [0] amplitude { x: -1 z: 0.2 } period: 1 } } "
                    "motions { oscillation { body: 'row' vertices: [3] amplitude { x: 1 } period: 1 } } "
                    "constraints { rigid_links { body: 'row' list { links { a: 0 b: 1 } links { a: 1 b: 2 } links { a: "
                    "2 b: 3 } } } } parameters { integrator: INTEGRATOR_") +
        integrator + " }");
    ASSERT_NE(model, nullptr);
    State state = model->InitialState();
    Workspace work = model->MakeWorkspace();
    absl::Status stepped;
    for (int i = 0; i < 250 && stepped.ok(); ++i) stepped = Step(*model, model->parameters, 1e-3, state, work);
    EXPECT_TRUE(stepped.ok() || !stepped.message().empty()) << integrator;
    EXPECT_TRUE(!stepped.ok() || (state.x.allFinite() && state.v.allFinite())) << integrator;
    std::fprintf(stderr, "%s %s\n", integrator, stepped.ToString().c_str());
  }
}

// A load along two links takes their end a kilometre away in one step, from where they bring it back: no divergence.
TEST(LinkedChain, BringsBackInOneStepWhatALoadTakesAway) {
  const auto model = CompileText(
      "name: 'chain' bodies { name: 'chain' role: ROLE_DEFORMABLE mass: 3 fixed_vertices: 0 polyhedron { vertices {} "
      "vertices { x: 1 } vertices { x: 2 } } } forces { point_load { body: 'chain' vertices: 2 force { x: 1e9 } } } "
      "constraints { rigid_links { body: 'chain' list { links { a: 0 b: 1 } links { a: 1 b: 2 } } } }");
  ASSERT_NE(model, nullptr);
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  const absl::Status stepped = Step(*model, model->parameters, 1e-3, state, work);
  EXPECT_TRUE(stepped.ok()) << stepped;
  EXPECT_LT((state.x - model->rest).norm(), 1e-6);
}

// 13 links, the last packet not full: most are off by a little, one has turned round within the step. Ends that follow
// each other as vertices do, and as they do not.
TEST(LinkPackets, AreRestoredAsLinkByLinkOnEveryInstructionSet) {
  const auto model = CompileText(
      "name: 'pairs' bodies { name: 'pairs' role: ROLE_DEFORMABLE mass: 3 fixed_vertices: [4, 8, 9] grid { columns: 2 "
      "rows: 13 u { x: 0.1 } v { y: 0.1 } } }");
  ASSERT_NE(model, nullptr);
  State start = model->InitialState();
  const Points before = start.x;
  start.x += 0.003 * Points::Random(3, start.x.cols());
  start.x.col(6).swap(start.x.col(7));
  const auto restore = [&before](const Link& link, State& state) {
    Restore(link, before.col(link.b) - before.col(link.a), 0.01, state.x, state.v);
  };
  for (const int from : {0, 1}) {
    std::vector<Link> links;
    for (int i = 0; i < 26; i += 2) links.push_back(MakeLink(*model, i + from, i + 1 - from));
    const std::vector<LinkPacket> packets = PackLinks(links, 0, false);
    State plain = start, first;
    for (const Link& link : links) restore(link, plain);
    OnEveryTarget([&] {
      State here = start;
      LinkVectors directions[2];
      FindDirections(packets, before.data(), directions);
      const Restored restored = RestorePackets(packets, directions, 0.01, here.x.data(), here.v.data());
      EXPECT_EQ(restored.missed, 1U << 3);
      EXPECT_NEAR(restored.displacement, (here.x - start.x).cwiseAbs().maxCoeff(), 1e-15);
      EXPECT_NEAR(restored.displacement, 0.01 * (here.v - start.v).cwiseAbs().maxCoeff(), 1e-15);
      restore(links[3], here);
      EXPECT_LT((here.x - plain.x).norm(), 1e-15);
      EXPECT_LT((here.v - plain.v).norm(), 1e-12);
      if (first.x.size() == 0) first = here;
      EXPECT_EQ(here.x, first.x);
      EXPECT_EQ(here.v, first.v);
    });
  }
}

// Limits of length: some hold already, and one link has turned.
TEST(LinkKernel, RestoresEndsThatAreApartAsItDoesTheOthers) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> value(-1, 1);
  const int n = 40;
  const auto points = [&](double size) {
    return Points(Points::NullaryExpr(3, n, [&] { return size * value(random); }));
  };
  const Points before = points(0.1), v = points(1);
  Points x = before + points(0.02);
  x.col(6) = before.col(6);
  x.col(7) = before.col(6) - 2 * (before.col(7) - before.col(6));  // has turned, and is too long
  std::vector<Link> links;
  for (int i = 0; i + 1 < n; i += 2) {
    const double length = (before.col(i + 1) - before.col(i)).norm();
    links.push_back(
        {.a = i, .b = i + 1, .length = length, .inverse_a = 1.5 + value(random), .inverse_b = 2, .sign = 1});
  }
  const std::vector<LinkPacket> packets = PackLinks(links, 0, false), apart = PackSweptLinks(links, 0);
  ASSERT_EQ(apart.size(), packets.size());
  Points first_x;
  OnEveryTarget([&] {
    Points here_x = x, here_v = v;
    std::vector<SweptEnd> ends(n);
    LinkVectors directions[3], of_ends[3];
    const auto fetch = [&](const Points& from) {
      for (int i = 0; i < n; ++i) {
        Eigen::Vector3d::Map(ends[i].x) = from.col(i), Eigen::Vector3d::Map(ends[i].v) = v.col(i);
      }
    };
    FindDirections(packets, before.data(), directions);
    fetch(before);
    FindDirections(apart, ends.data(), of_ends);
    fetch(x);
    const Restored restored = RestorePackets(packets, directions, 0.01, here_x.data(), here_v.data());
    EXPECT_EQ(restored.missed, 1U << 3);
    EXPECT_EQ(RestorePackets(apart, of_ends, 0.01, ends.data()), restored.missed);
    EXPECT_NE(here_x, x);
    for (int i = 0; i < n; ++i) {
      EXPECT_EQ(Eigen::Vector3d::Map(ends[i].x), here_x.col(i)) << i;
      EXPECT_EQ(Eigen::Vector3d::Map(ends[i].v), here_v.col(i)) << i;
    }
    if (first_x.size() == 0) first_x = here_x;
    EXPECT_EQ(here_x, first_x);
  });
}

TEST(SparseLdlt, SolvesWhatADenseSolverDoesAndLeavesRedundantRowsOut) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> value(-1, 1);
  const int n = 30;
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) factor(i, (7 * i + 5 * k) % n) = 1 + value(random);
  }
  factor.row(n - 1) = factor.row(3) - 2 * factor.row(8);  // redundant
  const Eigen::MatrixXd matrix = factor * factor.transpose();
  std::vector<std::pair<int, int>> below;
  std::vector<double> values;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) {
      if (matrix(i, j) == 0) continue;
      below.emplace_back(i, j);
      values.push_back(matrix(i, j));
    }
  }
  const SparseLdlt ldlt(n, below);
  SparseLdlt::Factors factors;
  EXPECT_EQ(ldlt.Factorise(matrix.diagonal(), values, factors), 1) << "rows left out";
  const Eigen::VectorXd right = matrix * Eigen::VectorXd::NullaryExpr(n, [&] { return value(random); });
  Eigen::VectorXd x = right;
  ldlt.Solve(factors, x);
  EXPECT_LT((matrix * x - right).norm(), 1e-8 * right.norm());
  EXPECT_EQ(x[n - 1], 0);
  Points three(3, n);
  for (int axis = 0; axis < 3; ++axis) three.row(axis) = (axis + 1) * right.transpose();
  ldlt.Solve(factors, three);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT((three.row(axis).transpose() - (axis + 1) * x).norm(), 1e-12 * x.norm()) << "axis " << axis;
  }
}

TEST(OrderedLdlt, SolvesWhatADenseSolverDoesAndRefusesWhatIsNotPositiveDefinite) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> value(-1, 1);
  const int n = 40;
  Eigen::MatrixXd dense = 4 * Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i < n; ++i) {
    const int j = (11 * i + 3) % n;
    if (i != j) dense(i, j) = dense(j, i) = value(random);
  }
  const Eigen::VectorXd right = Eigen::VectorXd::NullaryExpr(n, [&] { return value(random); });
  Eigen::SparseMatrix<double> matrix = dense.sparseView();
  OrderedLdlt factor;
  ASSERT_TRUE(factor.Factorise(matrix));
  Eigen::VectorXd x;
  factor.Solve(right, x);
  EXPECT_LT((x - dense.ldlt().solve(right)).norm(), 1e-14 * n);
  for (const double bad : {-1.0, 0.0, std::nan("")}) {
    matrix.coeffRef(7, 7) = bad;
    EXPECT_FALSE(factor.Factorise(matrix)) << bad;
  }
}

}  // namespace
}  // namespace phrenic
