#include "server/meshio/ply_values.h"

#include <cstdint>
#include <limits>

#include "server/meshio/bytes.h"

namespace phrenic::meshio {
namespace {

class TextValues final : public PlyValues {
 public:
  explicit TextValues(const TextReader& reader) : reader_(reader) {}

  bool NextRow() override { return reader_.NextFilledLine(); }
  bool Take(PlyType /*type*/, double& number) override {
    const std::string_view word = reader_.Word();
    if (!ParseNumber(word, number)) number = std::numeric_limits<double>::quiet_NaN();
    return !word.empty();
  }
  bool AtEndOfRow() const override { return reader_.Rest().empty(); }
  bool AtEnd() override { return !reader_.NextFilledLine(); }
  absl::Status Error(const std::string& message) const override { return reader_.Error(message); }

 private:
  TextReader reader_;
};

class BinaryValues final : public PlyValues {
 public:
  explicit BinaryValues(const ByteReader& reader) : reader_(reader) {}

  bool NextRow() override { return reader_.left() > 0; }
  bool Take(PlyType type, double& number) override {
    switch (type) {
      case PlyType::kInt8:
        return TakeAs<std::int8_t>(number);
      case PlyType::kUint8:
        return TakeAs<std::uint8_t>(number);
      case PlyType::kInt16:
        return TakeAs<std::int16_t>(number);
      case PlyType::kUint16:
        return TakeAs<std::uint16_t>(number);
      case PlyType::kInt32:
        return TakeAs<std::int32_t>(number);
      case PlyType::kUint32:
        return TakeAs<std::uint32_t>(number);
      case PlyType::kFloat32:
        return TakeAs<float>(number);
      case PlyType::kFloat64:
        return TakeAs<double>(number);
    }
    return false;
  }
  bool AtEndOfRow() const override { return true; }
  bool AtEnd() override { return reader_.left() == 0; }
  absl::Status Error(const std::string& message) const override { return reader_.Error(message); }

 private:
  template <typename T>
  bool TakeAs(double& number) {
    T raw{};
    if (!reader_.Take(raw)) return false;
    number = static_cast<double>(raw);
    return true;
  }

  ByteReader reader_;
};

}  // namespace

std::unique_ptr<PlyValues> MakePlyValues(PlyEncoding encoding, std::string_view name, std::string_view bytes,
                                         const TextReader& reader) {
  if (encoding == PlyEncoding::kText) return std::make_unique<TextValues>(reader);
  const std::endian order = encoding == PlyEncoding::kBigEndian ? std::endian::big : std::endian::little;
  return std::make_unique<BinaryValues>(ByteReader(name, bytes, reader.next_line(), order));
}

}  // namespace phrenic::meshio
