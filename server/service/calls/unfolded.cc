#include "server/service/calls/unfolded.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/message.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace phrenic::service {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

constexpr int kDeepest = 100;              // levels that protobuf parses
constexpr std::size_t kAllocation = 24;    // a pointer, and what malloc adds
constexpr std::size_t kUnknownField = 32;  // in an UnknownFieldSet
constexpr std::size_t kNumber = 8;         // the largest element of a list of numbers

class Count {
 public:
  explicit Count(std::size_t enough) : enough_(enough) {}
  std::size_t bytes() const { return bytes_; }

  // Counts up to the end of the input or of the group, or to what ends the count. `type` null: of an unknown group.
  // Returns false if the count has ended.
  bool Add(CodedInputStream& in, const Descriptor* type, int depth) {
    while (const std::uint32_t tag = in.ReadTag()) {
      if (WireFormatLite::GetTagWireType(tag) == WireFormatLite::WIRETYPE_END_GROUP) return type == nullptr;
      const int number = WireFormatLite::GetTagFieldNumber(tag);
      const FieldDescriptor* field = type == nullptr ? nullptr : type->FindFieldByNumber(number);
      if (!AddField(in, tag, field, depth) || bytes_ > enough_) return false;
    }
    return type != nullptr;
  }

 private:
  bool AddField(CodedInputStream& in, std::uint32_t tag, const FieldDescriptor* field, int depth) {
    std::uint32_t length = 0;
    switch (WireFormatLite::GetTagWireType(tag)) {
      case WireFormatLite::WIRETYPE_LENGTH_DELIMITED:
        return in.ReadVarint32(&length) && AddDelimited(in, length, field, depth);
      case WireFormatLite::WIRETYPE_START_GROUP:
        bytes_ += kUnknownField + kAllocation;
        return depth < kDeepest && Add(in, nullptr, depth + 1);
      default:
        bytes_ += field == nullptr ? kUnknownField : field->is_repeated() ? kNumber : 0;
        return WireFormatLite::SkipField(&in, tag);
    }
  }

  bool AddDelimited(CodedInputStream& in, std::uint32_t length, const FieldDescriptor* field, int depth) {
    if (field != nullptr && field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      return AddMessage(in, length, *field->message_type(), depth);
    }
    bytes_ += field == nullptr ? kUnknownField + sizeof(std::string) + length : SizeOf(*field, length);
    return in.Skip(static_cast<int>(length));
  }

  bool AddMessage(CodedInputStream& in, std::uint32_t length, const Descriptor& type, int depth) {
    bytes_ += SizeOf(type) + kAllocation;
    if (depth >= kDeepest || bytes_ > enough_) return false;
    const auto limit = in.PushLimit(static_cast<int>(length));
    const bool whole = Add(in, &type, depth + 1) && in.BytesUntilLimit() == 0;
    in.PopLimit(limit);
    return whole;
  }

  // Of a text, or of a list of numbers.
  static std::size_t SizeOf(const FieldDescriptor& field, std::size_t length) {
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_STRING:
        return sizeof(std::string) + kAllocation + length;
      case FieldDescriptor::CPPTYPE_INT32:
      case FieldDescriptor::CPPTYPE_UINT32:
      case FieldDescriptor::CPPTYPE_ENUM:
        return length * sizeof(std::int32_t);
      case FieldDescriptor::CPPTYPE_INT64:
      case FieldDescriptor::CPPTYPE_UINT64:
        return length * sizeof(std::int64_t);
      default:
        return length;  // as wide on the wire
    }
  }

  std::size_t SizeOf(const Descriptor& type) {
    std::size_t& size = sizes_[&type];
    if (size == 0) {
      const auto* prototype = google::protobuf::MessageFactory::generated_factory()->GetPrototype(&type);
      size = prototype == nullptr ? kUnknownField : prototype->SpaceUsedLong();
    }
    return size;
  }

  const std::size_t enough_;
  std::size_t bytes_ = 0;
  std::unordered_map<const Descriptor*, std::size_t> sizes_;  // of empty messages
};

}  // namespace

std::size_t UnfoldedBytes(const grpc::ByteBuffer& bytes, const Descriptor& type, std::size_t enough) {
  grpc::ByteBuffer shared = bytes;  // shares the slices; the reader needs a non-const buffer
  grpc::ProtoBufferReader reader(&shared);
  CodedInputStream in(&reader);
  Count count(enough);
  count.Add(in, &type, 1);
  return count.bytes();
}

}  // namespace phrenic::service
