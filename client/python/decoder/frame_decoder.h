// Decodes the positions of frames (proto/README.md), as a C interface for other languages: the server's own decoder.
//
// One thread at a time may use a decoder. Errors are returned as text, which lives until the next call with the same
// decoder; null means success. Nothing throws.
#ifndef PHRENIC_CLIENT_PYTHON_DECODER_FRAME_DECODER_H_
#define PHRENIC_CLIENT_PYTHON_DECODER_FRAME_DECODER_H_

#include <cstdint>

#define PHRENIC_DECODER_EXPORT __attribute__((visibility("default")))

extern "C" {

struct PhrenicDecoder;

// Returns a decoder of the streamed vertices; phrenic_decoder_free frees it. `rest`: x y z per vertex at rest [m], as
// GetGeometry has them. `edges`: pairs of neighbouring vertices. Null if an edge has an index that is not below
// `vertices`, or memory is short.
PHRENIC_DECODER_EXPORT PhrenicDecoder* phrenic_decoder_make(const float* rest, std::int64_t vertices,
                                                            const std::uint32_t* edges, std::int64_t edge_count);
// Sets the shapes of CODEC_BASIS: `count` arrays of x y z per vertex [m], displacements from rest.
PHRENIC_DECODER_EXPORT const char* phrenic_decoder_set_basis(PhrenicDecoder* decoder, const float* shapes,
                                                             std::int64_t count);
// Decodes `bytes` of the codec with this number in phrenic.v1.Codec into `positions`, x y z per vertex [m].
PHRENIC_DECODER_EXPORT const char* phrenic_decoder_decode(PhrenicDecoder* decoder, std::int32_t codec,
                                                          const char* bytes, std::int64_t size, float* positions);
PHRENIC_DECODER_EXPORT void phrenic_decoder_free(PhrenicDecoder* decoder);
}

#endif  // PHRENIC_CLIENT_PYTHON_DECODER_FRAME_DECODER_H_
