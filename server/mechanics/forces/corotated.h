// Corotational finite elements with constant strain: triangles in plane stress (N = 2) and tetrahedra (N = 3). With
// F = R S the deformation gradient (3 x N) of an element of rest volume V [m^3] and e = sym(R^T F) - I its Biot strain,
//   E = V (mu e:e + lambda/2 tr(e)^2) [J],  f_a = -V R (2 mu e + lambda tr(e) I) g_a [N],
// g_a the gradient of vertex a's shape function at rest [1/m], mu and lambda the Lame parameters [Pa]. The force is the
// exact gradient of the energy. With linear strain R is the rotation at rest. Muller and Gross 2004; energy and
// eigenmodes: Smith, de Goes and Kim 2019. The stiffness is projected to positive semi-definite: negative eigenvalues
// are clamped to 0, mode by mode.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_COROTATED_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_COROTATED_H_

#include <vector>

#include "phrenic/v1/scene.pb.h"
#include "server/mechanics/force.h"
#include "server/mechanics/forces/polar.h"
#include "server/mechanics/forces/triangle_kernel.h"

namespace phrenic {

struct Lame {
  double mu, lambda;  // [Pa]
};
// Return the Lame parameters of a membrane in plane stress and of a solid.
Lame PlaneStress(double youngs_modulus, double poissons_ratio);
Lame OfSolid(double youngs_modulus, double poissons_ratio);

template <int N>
struct FiniteElement {
  Eigen::Matrix<int, N + 1, 1> vertices;
  Eigen::Matrix<double, N, N + 1> gradient;  // of the shape functions, one column per vertex [1/m]
  Gradient<N> axes;                          // axes of the element's rest coordinates, 3 x N, orthonormal
  double volume;                             // [m^3]
};

// Returns the element of these vertices at rest. Its volume is area x thickness [m^3], 0 if it is degenerate.
FiniteElement<2> MakeTriangle(const ConstPoints& rest, const Eigen::Vector3i& vertices, double thickness);

// Returns the element of these vertices at rest. Its volume is positive for any order of the vertices, 0 if degenerate.
FiniteElement<3> MakeTetrahedron(const ConstPoints& rest, const Eigen::Vector4i& vertices);

// Returns the deformation gradient F = sum_a x_a g_a^T.
template <int N>
Gradient<N> DeformationOf(const FiniteElement<N>& element, const ConstPoints& x) {
  Gradient<N> f = x.col(element.vertices[0]) * element.gradient.col(0).transpose();
  for (int a = 1; a <= N; ++a) f += x.col(element.vertices[a]) * element.gradient.col(a).transpose();
  return f;
}

// Adds the element's forces f_a = -V P g_a [N], P the first Piola-Kirchhoff stress [Pa].
template <int N>
void AddStress(const FiniteElement<N>& element, const Gradient<N>& stress, MutablePoints f) {
  for (int a = 0; a <= N; ++a) f.col(element.vertices[a]) -= element.volume * (stress * element.gradient.col(a));
}

// Returns the triangles in batches for the SIMD kernel (triangle_kernel.h). There is none for tetrahedra.
std::vector<TriangleBatch> InBatches(const std::vector<FiniteElement<2>>& elements);
inline std::vector<TriangleBatch> InBatches(const std::vector<FiniteElement<3>>&) { return {}; }

// A batch of elements of one material. Stresses are scaled by the live parameter elasticity.
template <int N>
class Corotated final : public Force {
 public:
  Corotated(std::string name, std::vector<FiniteElement<N>> elements, Lame lame, v1::Strain strain)
      : Force(std::move(name)),
        elements_(std::move(elements)),
        lame_(lame),
        corotated_(strain != v1::STRAIN_LINEAR),
        batches_(corotated_ ? InBatches(elements_) : std::vector<TriangleBatch>()) {}

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 private:
  using Square = Eigen::Matrix<double, N, N>;
  Gradient<N> Rotation(const FiniteElement<N>& element, const Gradient<N>& f) const {
    return corotated_ ? NearestRotation(f) : element.axes;
  }

  void AddForceOf(const FiniteElement<N>& element, double elasticity, const ConstPoints& x, MutablePoints f) const;

  const std::vector<FiniteElement<N>> elements_;
  const Lame lame_;
  const bool corotated_;                      // false: linear strain
  const std::vector<TriangleBatch> batches_;  // copy of elements_ for AddForce; empty unless corotated triangles
};

extern template class Corotated<2>;
extern template class Corotated<3>;

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_COROTATED_H_
