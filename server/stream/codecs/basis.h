// A sum of the shapes that both ends have, and what is left of each vertex that the sum leaves outside the bound.
#ifndef PHRENIC_SERVER_STREAM_CODECS_BASIS_H_
#define PHRENIC_SERVER_STREAM_CODECS_BASIS_H_

#include <Eigen/Cholesky>
#include <vector>

#include "server/stream/codec.h"
#include "server/stream/codecs/neighbour_predictor.h"

namespace phrenic::stream {

// x = rest + sum c_k s_k + step d, the c_k by least squares, d whole numbers: 0 where the sum alone keeps the bound, so
// that the bound holds whatever the shapes are. proto/README.md has the bytes.
class BasisCodec final : public Codec {
 public:
  explicit BasisCodec(const RestShape& shape);
  absl::StatusOr<std::string> Encode(const Floats& positions, double max_error) const override;
  absl::StatusOr<Floats> Decode(std::string_view bytes) const override;

 private:
  using Parts = std::vector<float>;  // c_k [1]
  using Doubles = Eigen::Matrix3Xd;  // [m]

  Parts FindParts(const Floats& positions) const;
  // rest + sum c_k s_k, term after term.
  Doubles Sum(const Parts& parts) const;

  const RestShape shape_;
  const NeighbourPredictor foretelling_;
  Eigen::LDLT<Eigen::MatrixXd> gram_;  // of the shapes
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_BASIS_H_
