// The springs' fast layouts against the plain loop over them: the same forces but for the order of the sums, or within
// the error that single precision states, and the same bits on every instruction set that this machine has, the
// portable path among them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "server/mechanics/forces/spring_rows.h"
#include "tests/bench/plain_springs.h"
#include "tests/mechanics/every_target.h"

namespace phrenic {
namespace {

struct Network {
  Points x;
  std::vector<Spring> springs;

  Points Plain(double scale) const {
    Points f = Points::Zero(3, x.cols());
    AddPlainSprings(springs, scale, x, f);
    return f;
  }
  Points Ours(const SpringRows& rows, double scale) const {
    Points f = Points::Zero(3, x.cols());
    rows.AddForce(scale, x, Scratch(), f);
    return f;
  }
  SpringRows Rows(Precision precision = Precision::kDouble) const {
    return {springs, static_cast<int>(x.cols()), precision};
  }
  // The largest sum over a vertex' springs of k l: what rounding is measured by.
  double Size() const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.cols());
    for (const Spring& spring : springs) {
      const double pull = spring.stiffness * (x.col(spring.a) - x.col(spring.b)).norm();
      sum[spring.a] += pull, sum[spring.b] += pull;
    }
    return sum.maxCoeff();
  }
  // The error that spring_rows.h states for single precision, of each vertex [N].
  Eigen::VectorXd SingleError() const {
    const double away = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.cols());
    for (const Spring& spring : springs) {
      const double length = (x.col(spring.a) - x.col(spring.b)).norm();
      const double error = std::ldexp(spring.stiffness * (away + length) * (1 + spring.rest_length / length), -19);
      sum[spring.a] += error, sum[spring.b] += error;
    }
    return sum;
  }
};

const Precision kPrecisions[] = {Precision::kDouble, Precision::kSingle};

// Springs between vertices drawn from all: rows of very different lengths, some empty, a pair joined twice.
Network Random(int vertices, int springs) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-0.1, 0.1), stiffness(1, 100), length(0.01, 0.2);
  std::uniform_int_distribution<int> vertex(0, vertices - 1);
  Network made{Points::NullaryExpr(3, vertices, [&] { return place(random); }), {}};
  while (static_cast<int>(made.springs.size()) < springs) {
    const int a = vertex(random), b = vertex(random) / (1 + vertex(random) % 3);
    if (a != b) made.springs.push_back({a, b, stiffness(random), length(random)});
  }
  if (springs > 0) made.springs.push_back(made.springs.front());
  return made;
}

// A closed chain through the vertices in random order.
Network ScatteredRing(int vertices) {
  Network made = Random(vertices, 0);
  made.springs.clear();
  std::vector<int> order(vertices);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  for (int i = 0; i < vertices; ++i) made.springs.push_back({order[i], order[(i + 1) % vertices], 30, 0.05});
  return made;
}

// Two sheets, one vertex of the first and one of the second by turns, so that each pair of rows is of neighbours that
// follow each other; with the springs from one sheet to the other that some `joints` are.
Network DoubleSheet(int side, int joints) {
  Network made = Random(2 * side * side, 2 * side * side);
  std::vector<Spring> drawn;
  drawn.swap(made.springs);
  const auto join = [&](int sheet, int a, int b) {
    const Spring& like = drawn[made.springs.size() % drawn.size()];
    made.springs.push_back({2 * a + sheet, 2 * b + sheet, like.stiffness, like.rest_length});
  };
  for (int i = 0; i < 2 * side * side; ++i) {
    const int sheet = i % 2, at = i / 2;
    if (at % side + 1 < side) join(sheet, at + 1, at);
    if (at / side + 1 < side) join(sheet, at, at + side);
    if (at % side + 1 < side && at / side + 1 < side) join(sheet, at, at + side + 1);
  }
  for (int i = 0; i < joints; ++i) made.springs.push_back({2 * i, 2 * i + 1, 20, 0.01});
  return made;
}

std::vector<Network> Several() {
  std::vector<Network> networks;
  for (const int vertices : {2, 3, 7, 8, 9, 16, 17, 64, 1000}) networks.push_back(Random(vertices, 4 * vertices));
  for (const int side : {2, 3, 4, 16, 25}) networks.push_back(DoubleSheet(side, 0));
  networks.push_back(DoubleSheet(25, 40));
  return networks;
}

TEST(SpringRows, GiveWhatThePlainLoopGives) {
  for (const Network& network : Several()) {
    const SpringRows rows = network.Rows();
    const Points plain = network.Plain(1.7);
    OnEveryTarget([&] {
      EXPECT_LT((network.Ours(rows, 1.7) - plain).cwiseAbs().maxCoeff(), 1e-13 * 1.7 * network.Size())
          << network.x.cols();
    });
  }
}

// Also far from where coordinates begin.
TEST(SpringRows, InSinglePrecisionKeepWithinTheErrorTheyState) {
  for (Network& network : Several()) {
    for (const double shift : {0, 1000}) {
      network.x.array() += shift;
      const SpringRows rows = network.Rows(Precision::kSingle);
      const Points plain = network.Plain(1.7);
      const Eigen::VectorXd error = 1.7 * network.SingleError();
      OnEveryTarget([&] {
        const Points off = (network.Ours(rows, 1.7) - plain).cwiseAbs();
        EXPECT_LE((off.colwise().maxCoeff().transpose() - error).maxCoeff(), 0) << network.x.cols() << ", " << shift;
      });
    }
  }
}

TEST(SpringRows, GiveTheSameBitsOnEveryInstructionSet) {
  for (const Network& network : Several()) {
    for (const Precision precision : kPrecisions) {
      const SpringRows rows = network.Rows(precision);
      const Points here = network.Ours(rows, 0.3);
      OnEveryTarget([&] { EXPECT_EQ(network.Ours(rows, 0.3), here) << network.x.cols(); });
    }
  }
}

TEST(SpringRows, ThatAreReorderedGiveTheSame) {
  const Network network = ScatteredRing(30000);
  const Points plain = network.Plain(1);
  EXPECT_LT((network.Ours(network.Rows(), 1) - plain).cwiseAbs().maxCoeff(), 1e-13 * network.Size());
  const Points off = (network.Ours(network.Rows(Precision::kSingle), 1) - plain).cwiseAbs();
  EXPECT_LE((off.colwise().maxCoeff().transpose() - network.SingleError()).maxCoeff(), 0);
}

// A sheet's blocks, whose vertices all have springs, and a few springs among many vertices that have none.
TEST(SpringRows, LeaveVerticesWithoutSpringsAlone) {
  for (const int springs : {40, 20000}) {
    Network network = Random(2000, springs);
    std::erase_if(network.springs, [](const Spring& spring) { return spring.a % 5 == 0 || spring.b % 5 == 0; });
    for (const Precision precision : kPrecisions) {
      const SpringRows rows = network.Rows(precision);
      OnEveryTarget([&] {
        const Points f = network.Ours(rows, 1);
        for (int i = 0; i < 2000; i += 5) EXPECT_EQ(f.col(i).norm(), 0) << i;
        EXPECT_GT(f.norm(), 0);
      });
    }
  }
}

TEST(SpringRows, PullAtNothingWhereEndsCoincide) {
  Network network = Random(20, 60);
  network.x.rightCols(10).colwise() = Eigen::Vector3d(0.1, 0.2, 0.3);
  const SpringRows rows = network.Rows();
  const Points plain = network.Plain(1);
  OnEveryTarget([&] { EXPECT_LT((network.Ours(rows, 1) - plain).cwiseAbs().maxCoeff(), 1e-13 * network.Size()); });
}

TEST(SpringRows, AddTheLoadToTheVerticesThatHaveSprings) {
  Network network = Random(10, 30);
  network.x.conservativeResize(3, 11);  // and one that has none
  network.x.col(10).setZero();
  for (const Precision precision : kPrecisions) {
    SpringRows rows = network.Rows(precision);
    const Points load = Points::Random(3, 11);
    const Points before = network.Ours(rows, 2);
    rows.SetLoad(load);
    OnEveryTarget([&] {
      const Points difference = network.Ours(rows, 2) - before;
      const double rounding = precision == Precision::kSingle ? 1e-5 : 1e-12;
      EXPECT_LT((difference - 2 * load).leftCols(10).cwiseAbs().maxCoeff(), rounding);
      EXPECT_EQ(difference.col(10).norm(), 0);
    });
  }
}

TEST(SpringRows, ShowWhatIsNoNumber) {
  Network network = Random(20, 60);
  network.x(1, network.springs.front().a) = std::numeric_limits<double>::quiet_NaN();
  for (const Precision precision : kPrecisions) {
    const SpringRows rows = network.Rows(precision);
    OnEveryTarget([&] {
      const Points f = network.Ours(rows, 1);
      EXPECT_TRUE(f.col(network.springs.front().a).hasNaN());
      EXPECT_TRUE(f.col(network.springs.front().b).hasNaN());
    });
  }
}

}  // namespace
}  // namespace phrenic
