// Finite elements of constant strain, linear in the strain and free to turn: triangles in plane stress (N = 2) and
// tetrahedra (N = 3). With F = R S the deformation gradient (3 x N) of an element of rest volume V [m^3] and
// e = sym(R^T F) - I its strain (Biot's),
//   E = V (mu e:e + lambda/2 tr(e)^2) [J],  f_a = -V R (2 mu e + lambda tr(e) I) g_a [N],
// g_a the gradient of vertex a's shape function at rest [1/m]. The force is the exact gradient of the energy. With
// linear strain R stays what it is at rest. Muller and Gross 2004; the energy and its eigenmodes: Smith, de Goes and
// Kim 2019. K has its negative eigenvalues left out, mode by mode.
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
// Of a membrane in plane stress, of a solid.
Lame PlaneStress(double youngs_modulus, double poissons_ratio);
Lame OfSolid(double youngs_modulus, double poissons_ratio);

template <int N>
struct FiniteElement {
  Eigen::Matrix<int, N + 1, 1> vertices;
  Eigen::Matrix<double, N, N + 1> gradient;  // of the shape functions, by column [1/m]
  Gradient<N> axes;                          // of its coordinates at rest, in space
  double volume;                             // [m^3]
};

// The element over these vertices at rest; its volume is area x thickness, or 0 where it is degenerate.
FiniteElement<2> MakeTriangle(const ConstPoints& rest, const Eigen::Vector3i& vertices, double thickness);

// The same; its volume does not depend on the order of the vertices.
FiniteElement<3> MakeTetrahedron(const ConstPoints& rest, const Eigen::Vector4i& vertices);

// F = sum of x_a g_a^T.
template <int N>
Gradient<N> DeformationOf(const FiniteElement<N>& element, const ConstPoints& x) {
  Gradient<N> f = x.col(element.vertices[0]) * element.gradient.col(0).transpose();
  for (int a = 1; a <= N; ++a) f += x.col(element.vertices[a]) * element.gradient.col(a).transpose();
  return f;
}

// f_a -= V P g_a, P the first Piola-Kirchhoff stress [Pa].
template <int N>
void AddStress(const FiniteElement<N>& element, const Gradient<N>& stress, MutablePoints f) {
  for (int a = 0; a <= N; ++a) f.col(element.vertices[a]) -= element.volume * (stress * element.gradient.col(a));
}

// Laid out for the machine; nothing of tetrahedra.
std::vector<TriangleBatch> InBatches(const std::vector<FiniteElement<2>>& elements);
inline std::vector<TriangleBatch> InBatches(const std::vector<FiniteElement<3>>&) { return {}; }

// Stiffness is scaled by the live parameter elasticity.
template <int N>
class Corotated final : public Force {
 public:
  Corotated(std::string name, std::vector<FiniteElement<N>> elements, Lame lame, v1::Strain strain)
      : Force(std::move(name)),
        elements_(std::move(elements)),
        lame_(lame),
        turns_(strain != v1::STRAIN_LINEAR),
        batches_(turns_ ? InBatches(elements_) : std::vector<TriangleBatch>()) {}

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 private:
  using Square = Eigen::Matrix<double, N, N>;
  Gradient<N> Rotation(const FiniteElement<N>& element, const Gradient<N>& f) const {
    return turns_ ? NearestRotation(f) : element.axes;
  }

  void AddForceOf(const FiniteElement<N>& element, double elasticity, const ConstPoints& x, MutablePoints f) const;

  const std::vector<FiniteElement<N>> elements_;
  const Lame lame_;
  const bool turns_;
  const std::vector<TriangleBatch> batches_;  // the same, where they are triangles that turn: what a step reads
};

extern template class Corotated<2>;
extern template class Corotated<3>;

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_COROTATED_H_
