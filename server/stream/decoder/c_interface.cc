#include "server/stream/decoder/c_interface.h"

#include <algorithm>
#include <exception>
#include <memory>

#include "server/stream/decoder/position_decoder.h"

struct PhrenicDecoder {
  phrenic::stream::PositionDecoder positions;
};

namespace {

constexpr std::ptrdiff_t kMostVertices = 1 << 24, kMostEdges = 1 << 26;

bool AreBelow(const std::uint32_t* indices, std::ptrdiff_t count, std::ptrdiff_t limit) {
  return std::all_of(indices, indices + count,
                     [limit](std::uint32_t index) { return index < static_cast<std::uint32_t>(limit); });
}

std::string_view TextOf(const char* bytes, std::ptrdiff_t size) { return {bytes, static_cast<std::size_t>(size)}; }

// Returns what `call` returns, or `failed` if it throws: only allocations do.
template <class Call, class Result>
Result WithoutExceptions(const Call& call, Result failed) {
#ifdef __cpp_exceptions
  try {
    return call();
  } catch (const std::exception&) {
    return failed;
  }
#else
  static_cast<void>(failed);
  return call();
#endif
}

constexpr const char* kShort = "memory is short";

}  // namespace

PhrenicDecoder* phrenic_decoder_make(const float* rest, std::ptrdiff_t vertices, const std::uint32_t* edges,
                                     std::ptrdiff_t edge_count) {
  if (vertices < 0 || vertices > kMostVertices || edge_count < 0 || edge_count > kMostEdges) return nullptr;
  if (!AreBelow(edges, 2 * edge_count, vertices)) return nullptr;
  const phrenic::stream::RestMesh mesh = {
      .rest = {rest, static_cast<std::size_t>(3 * vertices)},
      .edges = {reinterpret_cast<const int*>(edges), static_cast<std::size_t>(2 * edge_count)}};
  return WithoutExceptions([&] { return new PhrenicDecoder{phrenic::stream::PositionDecoder(mesh)}; },
                           static_cast<PhrenicDecoder*>(nullptr));
}

const char* phrenic_decoder_set_basis(PhrenicDecoder* decoder, const float* shapes, std::ptrdiff_t count) {
  return WithoutExceptions(
      [&]() -> const char* {
        const std::size_t numbers = 3 * decoder->positions.vertices() * static_cast<std::size_t>(count);
        decoder->positions.SetBasis({shapes, shapes + numbers}, static_cast<std::size_t>(count));
        return nullptr;
      },
      kShort);
}

const char* phrenic_decoder_decode(PhrenicDecoder* decoder, std::int32_t codec, const char* bytes, std::ptrdiff_t size,
                                   float* positions) {
  return WithoutExceptions(
      [&] {
        const std::span<float> to(positions, 3 * decoder->positions.vertices());
        return decoder->positions.Decode(codec, TextOf(bytes, size), to);
      },
      kShort);
}

void phrenic_decoder_free(PhrenicDecoder* decoder) { delete decoder; }

double phrenic_decompressed_size(const char* bytes, std::ptrdiff_t size) {
  const auto stated = phrenic::stream::ZstdDecoder::StatedSize(TextOf(bytes, size));
  return stated.has_value() ? static_cast<double>(*stated) : -1;
}

const char* phrenic_decompress(const char* bytes, std::ptrdiff_t size, char* to, std::ptrdiff_t to_size) {
  return WithoutExceptions(
      [&] {
        const auto zstd = std::make_unique<phrenic::stream::ZstdDecoder>();
        return zstd->Decompress(TextOf(bytes, size),
                                {reinterpret_cast<std::uint8_t*>(to), static_cast<std::size_t>(to_size)});
      },
      kShort);
}
