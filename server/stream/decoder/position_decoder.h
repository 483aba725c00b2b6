// Bytes of a frame to positions, for every codec of phrenic.v1.Codec (proto/README.md specifies the bytes). The server,
// the Python package (c_interface.h) and the viewer, by WebAssembly, use this one decoder.
#ifndef PHRENIC_SERVER_STREAM_DECODER_POSITION_DECODER_H_
#define PHRENIC_SERVER_STREAM_DECODER_POSITION_DECODER_H_

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "server/stream/decoder/neighbour_weights.h"
#include "server/stream/decoder/prediction.h"
#include "server/stream/decoder/residuals.h"
#include "server/stream/decoder/rest_mesh.h"

namespace phrenic::stream {

// Decodes frames of one rest shape; keeps its buffers between frames. One thread at a time may use it. All functions
// return null, or what is wrong with the bytes, as text that lives as long as the process.
class PositionDecoder {
 public:
  // Copies what it needs. Takes some milliseconds for 20,000 vertices, most of it for the weights, which the second one
  // is given. Requires: `weights` are those of a mesh with these rest positions.
  explicit PositionDecoder(const RestMesh& mesh);
  PositionDecoder(std::span<const float> rest, const NeighbourWeights& weights);

  std::size_t vertices() const { return rest_.size() / 3; }
  // Sets the shapes of CODEC_BASIS: `count` times the displacements x y z per vertex [m]. Requires: so many numbers.
  void SetBasis(std::vector<float> shapes, std::size_t count);

  // Each writes finite positions, x y z per vertex [m]. Requires: `to` has 3 x vertices. It is unspecified after
  // errors.
  const char* DecodePlanes(std::string_view bytes, std::span<float> to);
  const char* DecodePredicted(std::string_view bytes, std::span<float> to);
  const char* DecodeBasis(std::string_view bytes, std::span<float> to);
  // Of the codec with this number in phrenic.v1.Codec.
  const char* Decode(int codec, std::string_view bytes, std::span<float> to);

 private:
  // Both write steps_: residuals with the predictions added, and numbers as they are.
  const char* ReadPredicted(std::string_view bytes);
  const char* ReadSteps(std::string_view bytes);
  // Writes rest + sum c_k s_k, summed in the order of k in float64, to sum_. `coefficients`: float32.
  void AddShapes(std::string_view coefficients);

  const std::vector<float> rest_;
  const std::vector<int> order_;  // the vertex at each place
  const Prediction prediction_;
  std::vector<float> ordered_rest_;  // four numbers per place
  std::vector<float> shapes_;        // one after the other
  std::size_t shape_count_ = 0;
  std::vector<double> sum_;  // [m]
  std::vector<std::uint8_t> planes_;
  PaddedSteps steps_;
  ResidualReader residuals_;
  ZstdDecoder zstd_;
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_POSITION_DECODER_H_
