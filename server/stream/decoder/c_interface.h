// The decoder of frames (proto/README.md) as a C interface for other languages: Python by a shared library, browsers by
// WebAssembly.
//
// One thread at a time may use a decoder. Errors are returned as text that lives as long as the process; null means
// success. Nothing throws. Where memory is short WebAssembly traps, and its instance must not be used again.
#ifndef PHRENIC_SERVER_STREAM_DECODER_C_INTERFACE_H_
#define PHRENIC_SERVER_STREAM_DECODER_C_INTERFACE_H_

#include <cstddef>
#include <cstdint>

#define PHRENIC_DECODER_EXPORT __attribute__((visibility("default"), used))

extern "C" {

struct PhrenicDecoder;

// Returns a decoder of the streamed vertices; phrenic_decoder_free frees it. `rest`: x y z per vertex at rest [m], as
// GetGeometry has them. `edges`: pairs of neighbouring vertices, of which some may repeat. Null if an edge has an index
// that is not below `vertices`, there are more than 2^24 vertices or 2^26 edges, or memory is short.
PHRENIC_DECODER_EXPORT PhrenicDecoder* phrenic_decoder_make(const float* rest, std::ptrdiff_t vertices,
                                                            const std::uint32_t* edges, std::ptrdiff_t edge_count);
// Sets the shapes of CODEC_BASIS: `count` arrays of x y z per vertex [m], displacements from rest.
PHRENIC_DECODER_EXPORT const char* phrenic_decoder_set_basis(PhrenicDecoder* decoder, const float* shapes,
                                                             std::ptrdiff_t count);
// Decodes `bytes` of the codec with this number in phrenic.v1.Codec into `positions`, x y z per vertex [m].
PHRENIC_DECODER_EXPORT const char* phrenic_decoder_decode(PhrenicDecoder* decoder, std::int32_t codec,
                                                          const char* bytes, std::ptrdiff_t size, float* positions);
PHRENIC_DECODER_EXPORT void phrenic_decoder_free(PhrenicDecoder* decoder);

// Returns the decompressed size that a Zstandard frame states; -1 if it states none, or the bytes are no frame.
PHRENIC_DECODER_EXPORT double phrenic_decompressed_size(const char* bytes, std::ptrdiff_t size);
// Decompresses a Zstandard frame of exactly `to_size` bytes.
PHRENIC_DECODER_EXPORT const char* phrenic_decompress(const char* bytes, std::ptrdiff_t size, char* to,
                                                      std::ptrdiff_t to_size);
}

#endif  // PHRENIC_SERVER_STREAM_DECODER_C_INTERFACE_H_
