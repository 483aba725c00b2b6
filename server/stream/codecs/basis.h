// A linear combination of the basis' shapes, and residuals of the vertices that it leaves outside the bound.
#ifndef PHRENIC_SERVER_STREAM_CODECS_BASIS_H_
#define PHRENIC_SERVER_STREAM_CODECS_BASIS_H_

#include <Eigen/Cholesky>
#include <vector>

#include "server/stream/codecs/codec.h"
#include "server/stream/codecs/neighbour_predictor.h"

namespace phrenic::stream {

// x = rest + sum c_k s_k + step d, c_k by least squares, d integers: 0 where the sum meets the bound, so the bound
// holds for any shapes. proto/README.md specifies the bytes. A codec belongs to one basis: Encoder makes one per epoch
// and selection of bodies. Decode requires the same shapes.
class BasisCodec final : public Codec {
 public:
  // Factors the shapes' Gram matrix, with a small ridge, since shapes may be equal on selected bodies. Without shapes
  // all displacements are residuals.
  explicit BasisCodec(const RestShape& shape);
  absl::StatusOr<std::string> Encode(const Floats& positions, double max_error) const override;
  absl::StatusOr<Floats> Decode(std::string_view bytes) const override;

 private:
  using Parts = std::vector<float>;  // c_k [1]
  using Doubles = Eigen::Matrix3Xd;  // [m]

  // All 0 if the least squares have no finite solution.
  Parts FindCoefficients(const Floats& positions) const;
  // Returns rest + sum c_k s_k, summed in the order of k.
  Doubles Sum(const Parts& parts) const;

  const RestShape shape_;
  const NeighbourPredictor predictor_;
  Eigen::LDLT<Eigen::MatrixXd> gram_;  // of the shapes
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_BASIS_H_
