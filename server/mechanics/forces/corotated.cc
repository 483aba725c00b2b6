#include "server/mechanics/forces/corotated.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace phrenic {
namespace {

// Scratch memory: the degenerate triangles, which are evaluated without SIMD. Usually empty.
struct FlatTriangles {
  std::vector<int> numbers;
};

constexpr double kFlattest = 1e-3;  // lower bound of the stretch by which tensions are divided

// The second derivative of the energy density is
//   dF:H:dF = 2 mu dF:dF + lambda (R:dF)^2 - sum over modes of softening (Q:dF)^2,
// where the modes Q are the infinitesimal rotations of the element: they cause no strain, only work against tension.
template <int N>
struct Modes {
  std::array<Gradient<N>, 3> q;
  std::array<double, 3> softening;  // [Pa]; 2 mu at rest, less under tension
};

// Returns the geometric stiffness [Pa] of a rotation mode: `tension` [Pa], 0 if compressive, over `stretch`.
double Geometric(double tension, double stretch) { return std::max(0.0, tension) / std::max(stretch, kFlattest); }

// Returns one rotation mode in the triangle's plane and two out of it, about the principal axes.
Modes<2> RotationModes(const Gradient<2>& r, const Eigen::Matrix2d& s, const Lame& lame, bool corotated) {
  Modes<2> modes;
  const Eigen::Vector3d normal = r.col(0).cross(r.col(1));
  const double trace = s.trace() - 2;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal;
  principal.computeDirect(s);
  modes.q[0].col(0) = r.col(1) * std::sqrt(0.5);
  modes.q[0].col(1) = -r.col(0) * std::sqrt(0.5);
  modes.softening[0] = 2 * lame.mu - Geometric(2 * (lame.mu + lame.lambda) * trace, s.trace());
  for (int i = 0; i < 2; ++i) {
    const double stretch = principal.eigenvalues()[i];
    const double tension = 2 * lame.mu * (stretch - 1) + lame.lambda * trace;
    modes.q[i + 1] = normal * principal.eigenvectors().col(i).transpose();
    modes.softening[i + 1] = 2 * lame.mu - Geometric(tension, stretch);
  }
  if (!corotated) modes.softening.fill(2 * lame.mu);
  return modes;
}

// Returns a rotation mode about each principal axis.
Modes<3> RotationModes(const Gradient<3>& r, const Eigen::Matrix3d& s, const Lame& lame, bool corotated) {
  Modes<3> modes;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(s);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = principal.eigenvectors().col(i);
    const double across = s.trace() - principal.eigenvalues()[i];  // sum of the other two stretches
    for (int k = 0; k < 3; ++k) modes.q[i].col(k) = std::sqrt(0.5) * r * axis.cross(Eigen::Vector3d::Unit(k));
    const double tension = 2 * lame.mu * (across - 2) + 2 * lame.lambda * (s.trace() - 3);
    modes.softening[i] = 2 * lame.mu - Geometric(tension, across);
  }
  if (!corotated) modes.softening.fill(2 * lame.mu);
  return modes;
}

template <int N>
Eigen::Matrix3d Block(const FiniteElement<N>& element, int a, int b, const Gradient<N>& r, const Modes<N>& modes,
                      const Lame& lame) {
  const Eigen::Matrix<double, N, 1> ga = element.gradient.col(a), gb = element.gradient.col(b);
  Eigen::Matrix3d block = 2 * lame.mu * ga.dot(gb) * Eigen::Matrix3d::Identity();
  block += lame.lambda * (r * ga) * (r * gb).transpose();
  for (int m = 0; m < 3; ++m) block -= modes.softening[m] * (modes.q[m] * ga) * (modes.q[m] * gb).transpose();
  return element.volume * block;
}

template <int N>
Eigen::Matrix<double, N, N> Symmetric(const Gradient<N>& r, const Gradient<N>& f) {
  const Eigen::Matrix<double, N, N> s = r.transpose() * f;
  return 0.5 * (s + s.transpose());
}

}  // namespace

Lame PlaneStress(double youngs_modulus, double poissons_ratio) {
  return {youngs_modulus / (2 * (1 + poissons_ratio)),
          youngs_modulus * poissons_ratio / (1 - poissons_ratio * poissons_ratio)};
}

Lame OfSolid(double youngs_modulus, double poissons_ratio) {
  return {youngs_modulus / (2 * (1 + poissons_ratio)),
          youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio))};
}

FiniteElement<2> MakeTriangle(const ConstPoints& rest, const Eigen::Vector3i& vertices, double thickness) {
  FiniteElement<2> element{vertices, {}, {}, 0};
  const Eigen::Vector3d b = rest.col(vertices[1]) - rest.col(vertices[0]);
  const Eigen::Vector3d c = rest.col(vertices[2]) - rest.col(vertices[0]);
  const double area = b.cross(c).norm() / 2;
  if (area <= 0) return element;
  element.axes.col(0) = b.normalized();
  element.axes.col(1) = b.cross(c).normalized().cross(element.axes.col(0));
  Eigen::Matrix2d sides;
  sides << element.axes.transpose() * b, element.axes.transpose() * c;
  element.gradient.rightCols<2>() = sides.inverse().transpose();
  element.gradient.col(0) = -element.gradient.col(1) - element.gradient.col(2);
  element.volume = area * thickness;
  return element;
}

FiniteElement<3> MakeTetrahedron(const ConstPoints& rest, const Eigen::Vector4i& vertices) {
  FiniteElement<3> element{vertices, {}, Eigen::Matrix3d::Identity(), 0};
  Eigen::Matrix3d sides;
  for (int a = 1; a < 4; ++a) sides.col(a - 1) = rest.col(vertices[a]) - rest.col(vertices[0]);
  element.volume = std::abs(sides.determinant()) / 6;
  if (element.volume <= 0) return element;
  element.gradient.rightCols<3>() = sides.inverse().transpose();
  element.gradient.col(0) = -element.gradient.rightCols<3>().rowwise().sum();
  return element;
}

std::vector<TriangleBatch> InBatches(const std::vector<FiniteElement<2>>& elements) {
  std::vector<TriangleBatch> batches((elements.size() + kBatch - 1) / kBatch);
  for (size_t t = 0; t < elements.size(); ++t) {
    TriangleBatch& batch = batches[t / kBatch];
    const size_t i = t % kBatch;
    const auto& g = elements[t].gradient;
    batch.b1[i] = g(0, 1), batch.b2[i] = g(1, 1), batch.c1[i] = g(0, 2), batch.c2[i] = g(1, 2);
    batch.volume[i] = elements[t].volume;
    const Eigen::Vector3i offset = 3 * elements[t].vertices;
    batch.a[i] = offset[0], batch.b[i] = offset[1], batch.c[i] = offset[2];
  }
  return batches;
}

template <int N>
void Corotated<N>::AddForceOf(const FiniteElement<N>& element, double elasticity, const ConstPoints& x,
                              MutablePoints f) const {
  const Gradient<N> gradient = DeformationOf(element, x);
  const Gradient<N> r = Rotation(element, gradient);
  const Square strain = Symmetric<N>(r, gradient) - Square::Identity();
  const Square stress = 2 * lame_.mu * strain + lame_.lambda * strain.trace() * Square::Identity();
  AddStress<N>(element, elasticity * r * stress, f);
}

template <int N>
void Corotated<N>::AddForce(const EvalContext& at, MutablePoints f) const {
  const double elasticity = at.parameters.elasticity();
  if (batches_.empty()) {
    for (const FiniteElement<N>& element : elements_) AddForceOf(element, elasticity, at.x, f);
    return;
  }
  std::vector<int>& flat = at.scratch.Get<FlatTriangles>().numbers;
  flat.clear();
  AddTriangles(batches_, elasticity * lame_.mu, elasticity * lame_.lambda, at.x.data(), f.data(), flat);
  for (const int t : flat) AddForceOf(elements_[t], elasticity, at.x, f);
}

template <int N>
void Corotated<N>::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const double elasticity = at.parameters.elasticity();
  for (const FiniteElement<N>& element : elements_) {
    const Gradient<N> gradient = DeformationOf(element, at.x);
    const Gradient<N> r = Rotation(element, gradient);
    const Modes<N> modes = RotationModes(r, Symmetric<N>(r, gradient), lame_, corotated_);
    for (int a = 0; a <= N; ++a) {
      for (int b = 0; b <= N; ++b) {
        sink.Add(element.vertices[a], element.vertices[b], elasticity * Block(element, a, b, r, modes, lame_));
      }
    }
  }
}

template <int N>
double Corotated<N>::Energy(const EvalContext& at) const {
  double energy = 0;
  for (const FiniteElement<N>& element : elements_) {
    const Gradient<N> gradient = DeformationOf(element, at.x);
    const Square strain = Symmetric<N>(Rotation(element, gradient), gradient) - Square::Identity();
    const double trace = strain.trace();
    energy += element.volume * (lame_.mu * strain.squaredNorm() + lame_.lambda / 2 * trace * trace);
  }
  return at.parameters.elasticity() * energy;
}

template class Corotated<2>;
template class Corotated<3>;

}  // namespace phrenic
