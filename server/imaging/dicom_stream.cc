#include "server/imaging/dicom_stream.h"

#include <dcmtk/dcmdata/dcerror.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "server/imaging/gzip.h"

namespace phrenic::imaging {
namespace {

constexpr std::size_t kMostElements = 8'000'000;  // 100,000 frames have 5 million; one takes 300 bytes
constexpr std::ptrdiff_t kMostStack = 256 << 10;  // [bytes]; a nested sequence takes about 1000
constexpr double kMostSeconds = 30;               // of CPU; elements out of order take quadratic time
constexpr std::size_t kMostInflated = std::size_t{1} << 30;
constexpr std::size_t kDeflateRatio = 1032;  // zlib's manual
constexpr const char* kNoSegmentation = "; no program writes a segmentation like this, export it again";

// Makes streams that start at one place.
class DicomStreamFactory final : public DcmInputStreamFactory {
 public:
  DicomStreamFactory(DicomBytes source, std::size_t at) : source_(std::move(source)), at_(at) {}
  DcmInputStream* create() const override { return new DicomStream(source_, at_); }
  DcmInputStreamFactory* clone() const override { return new DicomStreamFactory(source_, at_); }
  DcmInputStreamFactoryType ident() const override { return DFT_DcmInputFileStreamFactory; }

 private:
  DicomBytes source_;
  std::size_t at_;
};

std::size_t AtMost(offile_off_t count, std::size_t left) {
  return count < 0 ? 0 : std::min(static_cast<std::size_t>(count), left);
}

}  // namespace

offile_off_t DicomProducer::read(void* to, offile_off_t count) {
  const std::size_t taken = AtMost(count, left());
  if (taken > 0) std::memcpy(to, source_.bytes.data() + at_, taken);
  at_ += taken;
  return static_cast<offile_off_t>(taken);
}

offile_off_t DicomProducer::skip(offile_off_t count) {
  const std::size_t taken = AtMost(count, left());
  at_ += taken;
  return static_cast<offile_off_t>(taken);
}

void DicomProducer::putback(offile_off_t count) {
  if (count < 0 || static_cast<std::size_t>(count) > at_) {
    Fail(EC_PutbackFailed);
  } else {
    at_ -= static_cast<std::size_t>(count);
  }
}

void DicomProducer::Replace(DicomBytes source) {
  source_ = std::move(source);
  at_ = 0;
}

DcmInputStreamFactory* DicomStream::newFactory() const {
  return new DicomStreamFactory(producer_.source(), producer_.at());
}

OFCondition DicomStream::installCompressionFilter(E_StreamCompression) {
  const std::string_view deflated = producer_.source().bytes.substr(producer_.at());
  const std::size_t most = std::min(kMostInflated, kDeflateRatio * deflated.size());
  absl::StatusOr<std::string> plain = InflateRaw("DICOM", deflated, most + 1);
  if (!plain.ok()) {
    Stop(std::string(plain.status().message()));
  } else if (plain->size() > most) {
    Stop(absl::StrCat("it inflates to more than ", kMostInflated >> 20, " MB; crop the segmentation to the thorax"));
  } else {
    auto owner = std::make_shared<const std::string>(*std::move(plain));
    producer_.Replace({*owner, owner});
  }
  return producer_.status();
}

void DicomStream::mark() {
  DcmInputStream::mark();
  const char* here = static_cast<const char*>(__builtin_frame_address(0));
  if (stack_ == nullptr) stack_ = here;
  ++elements_;
  if (std::abs(stack_ - here) > kMostStack) {
    Stop(absl::StrCat("its sequences are nested too deeply", kNoSegmentation));
  } else if (elements_ > kMostElements) {
    Stop(absl::StrCat("it has more than ", kMostElements, " elements; export fewer segments"));
  } else if (elements_ % 4096 == 0 && std::clock() - began_ > kMostSeconds * CLOCKS_PER_SEC) {
    Stop(absl::StrCat("its elements are so far out of order that sorting takes over ", kMostSeconds, " s",
                      kNoSegmentation));
  }
}

void DicomStream::Stop(std::string problem) {
  if (problem_.empty()) problem_ = std::move(problem);
  producer_.Fail(EC_CorruptedData);
}

}  // namespace phrenic::imaging
