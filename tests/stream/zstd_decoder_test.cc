// The decoder of Zstandard against libzstd's compressor; tests/fuzz/zstd.cc compares it with libzstd's decoder.
#include "server/stream/decoder/zstd_decoder.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace phrenic::stream {
namespace {

std::string Compressed(const std::string& text, int level) {
  std::string frame(ZSTD_compressBound(text.size()), '\0');
  frame.resize(ZSTD_compress(frame.data(), frame.size(), text.data(), text.size(), level));
  return frame;
}

// Runs, skewed and even bytes, repeats near and far, in blocks of every kind.
std::vector<std::string> Texts() {
  std::mt19937 random(5);
  std::vector<std::string> texts = {"", "a", std::string(300'000, 'x')};
  for (const unsigned values : {2U, 9U, 256U}) {
    std::string even, skewed, repeats;
    for (int i = 0; i < 150'000; ++i) {
      even += static_cast<char>(random() % values);
      skewed += static_cast<char>(std::min({random() % values, random() % values, random() % values}));
      repeats += i > 70'000 && random() % 50 > 0 ? repeats[i - 70'000] : even.back();
    }
    texts.insert(texts.end(), {even, even.substr(0, 700), skewed, skewed.substr(0, 60), repeats});
  }
  return texts;
}

TEST(ZstdDecoder, GivesBackWhatLibzstdCompressed) {
  const auto decoder = std::make_unique<ZstdDecoder>();
  for (const std::string& text : Texts()) {
    for (const int level : {-5, 1, 3, 12}) {
      std::vector<std::uint8_t> bytes(text.size());
      const std::string frame = Compressed(text, level);
      EXPECT_EQ(ZstdDecoder::StatedSize(frame), text.size());
      EXPECT_STREQ(decoder->Decompress(frame, bytes), nullptr) << text.size() << " bytes, level " << level;
      EXPECT_EQ(std::string(bytes.begin(), bytes.end()), text) << text.size() << " bytes, level " << level;
    }
  }
}

TEST(ZstdDecoder, RefusesOtherSizesCutsAndMore) {
  const auto decoder = std::make_unique<ZstdDecoder>();
  const std::string text = Texts()[6].substr(0, 400), frame = Compressed(text, 3);
  for (const std::size_t size : {std::size_t{0}, text.size() - 1, text.size() + 1}) {
    std::vector<std::uint8_t> bytes(size);
    EXPECT_STREQ(decoder->Decompress(frame, bytes), "zstd: the frame has another size than it should");
  }
  std::vector<std::uint8_t> bytes(text.size());
  for (std::size_t i = 0; i < frame.size(); ++i)
    EXPECT_NE(decoder->Decompress(frame.substr(0, i), bytes), nullptr) << i;
  EXPECT_NE(decoder->Decompress(frame + '\0', bytes), nullptr);
  EXPECT_EQ(decoder->Decompress(frame, bytes), nullptr);
}

}  // namespace
}  // namespace phrenic::stream
