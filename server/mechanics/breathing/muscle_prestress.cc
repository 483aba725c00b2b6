#include "server/mechanics/breathing/muscle_prestress.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

constexpr int kPrestressIterations = 450;
constexpr int kPowers = 30;               // products of the power iteration
constexpr float kPowerSafety = 1.1F;      // of its result
constexpr float kTensionSettled = 2e-5F;  // of the greatest tension: an iteration that changes less is the last
constexpr double kLeastAlong = 0.15, kLeastAcross = 0.1;  // of the tensions to begin with
constexpr double kGreatestAcross = 0.7;                   // of the greatest tension along
constexpr float kContactStep = 0.5F;

using Four = Eigen::Vector4f;  // x, y, z and any number: one load
using Fours = std::vector<Four, Eigen::aligned_allocator<Four>>;

// Along and across the fibres of a triangle.
struct Pair {
  float along = 0, across = 0;
};

// One triangle's part of the problem: the force on corner i is -(along tension p_i f + across tension q_i c), scaled by
// the root of the vertex' area. One line of the cache.
struct alignas(64) Row {
  float f[3] = {}, c[3] = {};  // area times the directions
  float p[3] = {}, q[3] = {};  // 0 for vertices that do not move
  int vertices[3] = {};
  float share = 0;  // of the area of all triangles

  // The fourth number of these is any.
  Four F() const { return Eigen::Map<const Four>(f); }
  Four C() const { return Eigen::Map<const Four>(c); }
};

float Product(const Four& a, const Four& b) { return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]); }

Four ToFour(const Eigen::Vector3d& v) { return Eigen::Vector4d(v[0], v[1], v[2], 0).cast<float>(); }

class PrestressSearch {
 public:
  PrestressSearch(const RestingLoad& resting, double greatest, const std::vector<MuscleTriangle>& triangles);

  int Run(const StopCheck& stop);
  const std::vector<Pair>& tensions() const { return last_; }
  float Pressure(size_t vertex) const { return contact_[vertex]; }

 private:
  // Adds the scaled forces of these tensions to `residual`.
  void AddForces(const std::vector<Pair>& tensions, Fours& residual) const;
  // Returns the product of a row's columns with a residual.
  static Pair Columns(const Row& row, const Fours& residual);
  float LargestEigenvalue() const;
  void FindResidual();
  float MoveTensions(float momentum);
  void MoveContacts();

  std::vector<Row> rows_;
  Fours load_, normal_;        // scaled; normals times the root of the area
  std::vector<float> root_;    // of the area around each vertex [m]
  std::vector<int> contacts_;  // vertices that rest on a surface
  std::vector<Pair> start_, least_, greatest_;
  std::vector<Pair> last_, ahead_;  // FISTA's iterate, and the point from which it goes on
  std::vector<float> contact_;      // [Pa]
  Fours residual_;
  float step_ = 0;   // along the gradient
  float scale_ = 0;  // the greatest tension [N/m]
};

PrestressSearch::PrestressSearch(const RestingLoad& resting, double greatest,
                                 const std::vector<MuscleTriangle>& triangles) {
  const Eigen::Index n = resting.area.size();
  contact_.assign(n, 0);
  scale_ = static_cast<float>(greatest);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double area = std::max(resting.area[i], 1e-12);
    const bool free = resting.free[i];
    root_.push_back(static_cast<float>(std::sqrt(area)));
    load_.push_back(free ? ToFour(resting.load.col(i) / std::sqrt(area)) : Four(Four::Zero()));
    normal_.push_back(ToFour(resting.normals.col(i) * std::sqrt(area)));
    if (free && resting.normals.col(i).squaredNorm() > 0) contacts_.push_back(static_cast<int>(i));
  }
  for (const MuscleTriangle& triangle : triangles) {
    Row& row = rows_.emplace_back();
    for (int k = 0; k < 3; ++k) {
      row.f[k] = static_cast<float>(triangle.area * triangle.f[k]);
      row.c[k] = static_cast<float>(triangle.area * triangle.c[k]);
    }
    for (int i = 0; i < 3; ++i) {
      row.vertices[i] = triangle.vertices[i] - resting.first;
      if (!resting.free[row.vertices[i]]) continue;
      row.p[i] = static_cast<float>(triangle.along[i]) / root_[row.vertices[i]];
      row.q[i] = static_cast<float>(triangle.across[i]) / root_[row.vertices[i]];
    }
    const double along = triangle.resting_along, across = triangle.resting_across;
    start_.push_back({static_cast<float>(along), static_cast<float>(across)});
    least_.push_back({static_cast<float>(kLeastAlong * along), static_cast<float>(kLeastAcross * across)});
    greatest_.push_back({static_cast<float>(std::max(along, greatest)),
                         static_cast<float>(std::max(across, kGreatestAcross * greatest))});
  }
  double area = 0;
  for (const MuscleTriangle& triangle : triangles) area += triangle.area;
  for (size_t t = 0; t < rows_.size(); ++t) rows_[t].share = static_cast<float>(triangles[t].area / area);
  last_ = ahead_ = start_;
  residual_.resize(n);
}

void PrestressSearch::AddForces(const std::vector<Pair>& tensions, Fours& residual) const {
  for (size_t t = 0; t < rows_.size(); ++t) {
    const Row& row = rows_[t];
    const Four f = tensions[t].along * row.F(), c = tensions[t].across * row.C();
    for (int i = 0; i < 3; ++i) residual[row.vertices[i]] -= row.p[i] * f + row.q[i] * c;
  }
}

Pair PrestressSearch::Columns(const Row& row, const Fours& residual) {
  Four f = Four::Zero(), c = f;
  for (int i = 0; i < 3; ++i) {
    const Four& r = residual[row.vertices[i]];
    f += row.p[i] * r, c += row.q[i] * r;
  }
  return {-Product(row.F(), f), -Product(row.C(), c)};
}

float PrestressSearch::LargestEigenvalue() const {
  std::vector<Pair> vector(rows_.size(), Pair{1, 1});
  Fours product(residual_.size());
  float largest = 0;
  for (int power = 0; power < kPowers; ++power) {
    double squares = 0;
    for (const Pair& v : vector)
      squares += static_cast<double>(v.along) * v.along + static_cast<double>(v.across) * v.across;
    if (squares == 0) return 0;
    const auto inverse = static_cast<float>(1 / std::sqrt(squares));
    for (Pair& v : vector) v.along *= inverse, v.across *= inverse;
    std::fill(product.begin(), product.end(), Four(Four::Zero()));
    AddForces(vector, product);
    double sum = 0;
    for (size_t t = 0; t < rows_.size(); ++t) {
      const Pair next = Columns(rows_[t], product);
      sum += static_cast<double>(next.along) * vector[t].along + static_cast<double>(next.across) * vector[t].across;
      vector[t] = next;
    }
    largest = static_cast<float>(sum);
  }
  return kPowerSafety * largest;
}

void PrestressSearch::FindResidual() {
  residual_ = load_;
  for (const int i : contacts_) residual_[i] -= contact_[i] * normal_[i];
  AddForces(ahead_, residual_);
}

// Returns the largest change [N/m].
float PrestressSearch::MoveTensions(float momentum) {
  float change = 0;
  const auto move = [&](float gradient, float least, float greatest, float& last, float& ahead) {
    const float moved = std::clamp(ahead - gradient * step_, least, greatest);
    change = std::max(change, std::abs(moved - last));
    ahead = moved + momentum * (moved - last);
    last = moved;
  };
  for (size_t t = 0; t < rows_.size(); ++t) {
    const Pair gradient = Columns(rows_[t], residual_), start = start_[t], least = least_[t], greatest = greatest_[t];
    Pair &last = last_[t], &ahead = ahead_[t];
    const float share = rows_[t].share;
    move(gradient.along + share * (ahead.along - start.along), least.along, greatest.along, last.along, ahead.along);
    move(gradient.across + share * (ahead.across - start.across), least.across, greatest.across, last.across,
         ahead.across);
  }
  return change;
}

void PrestressSearch::MoveContacts() {
  for (const int i : contacts_) {
    const float along = Product(residual_[i], normal_[i]) / (root_[i] * root_[i]);
    contact_[i] = std::max(0.0F, contact_[i] + kContactStep * along);
  }
}

int PrestressSearch::Run(const StopCheck& stop) {
  const float largest = LargestEigenvalue();
  if (!(largest > 0)) return 0;
  step_ = 1 / largest;
  float weight = 1;
  for (int iteration = 1; iteration <= kPrestressIterations; ++iteration) {
    FindResidual();
    const float next = (1 + std::sqrt(1 + 4 * weight * weight)) / 2;
    const float change = MoveTensions((weight - 1) / next);
    weight = next;
    MoveContacts();
    if (change <= kTensionSettled * scale_ || stop.Stopped()) return iteration;
  }
  return kPrestressIterations;
}

}  // namespace

PrestressReport ChoosePrestress(const RestingLoad& resting, double greatest, const StopCheck& stop,
                                std::vector<MuscleTriangle>& triangles) {
  PrestressSearch search(resting, greatest, triangles);
  PrestressReport report{.iterations = search.Run(stop), .along = 0, .across = 0, .contact = {}};
  double area = 0;
  for (size_t t = 0; t < triangles.size(); ++t) {
    MuscleTriangle& triangle = triangles[t];
    triangle.resting_along = search.tensions()[t].along;
    triangle.resting_across = search.tensions()[t].across;
    if (triangle.tissue != Tissue::kMuscle) continue;
    area += triangle.area;
    report.along += triangle.area * triangle.resting_along;
    report.across += triangle.area * triangle.resting_across;
  }
  if (area > 0) report.along /= area, report.across /= area;
  report.contact.resize(resting.area.size());
  for (Eigen::Index i = 0; i < report.contact.size(); ++i) report.contact[i] = search.Pressure(static_cast<size_t>(i));
  return report;
}

}  // namespace phrenic
