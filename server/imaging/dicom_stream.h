// A stream of DCMTK's over bytes in memory. DcmInputBufferStream allocates every value with the length that a file
// declares, and limits neither depth nor number of elements; this one does.
#ifndef PHRENIC_SERVER_IMAGING_DICOM_STREAM_H_
#define PHRENIC_SERVER_IMAGING_DICOM_STREAM_H_

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcistrma.h>

#include <cstddef>
#include <ctime>
#include <memory>
#include <string>
#include <string_view>

namespace phrenic::imaging {

// Bytes of a file, or inflated ones and their owner.
struct DicomBytes {
  std::string_view bytes;
  std::shared_ptr<const std::string> owner;
};

// Reads from memory.
class DicomProducer final : public DcmProducer {
 public:
  explicit DicomProducer(DicomBytes source, std::size_t at = 0) : source_(std::move(source)), at_(at) {}

  OFBool good() const override { return status_.good(); }
  OFCondition status() const override { return status_; }
  OFBool eos() override { return at_ == source_.bytes.size() || status_.bad(); }
  offile_off_t avail() override { return static_cast<offile_off_t>(left()); }
  offile_off_t read(void* to, offile_off_t count) override;
  offile_off_t skip(offile_off_t count) override;
  void putback(offile_off_t count) override;

  const DicomBytes& source() const { return source_; }
  std::size_t at() const { return at_; }
  std::size_t left() const { return source_.bytes.size() - at_; }
  // Continues at the start of other bytes.
  void Replace(DicomBytes source);
  // Lets the parser stop.
  void Fail(const OFCondition& status) { status_ = status; }

 private:
  DicomBytes source_;
  std::size_t at_;
  OFCondition status_ = EC_Normal;
};

// Not thread-safe.
class DicomStream final : public DcmInputStream {
 public:
  explicit DicomStream(DicomBytes source, std::size_t at = 0)
      : DcmInputStream(&producer_), producer_(std::move(source), at), began_(std::clock()) {}

  // Returns a factory of streams that start here. DCMTK skips a long value, which fails if its bytes are missing,
  // and loads it by such a stream.
  DcmInputStreamFactory* newFactory() const override;
  // Inflates the rest (deflated transfer syntaxes).
  OFCondition installCompressionFilter(E_StreamCompression filter) override;
  // DCMTK calls this before it reads the tag of an element or item. Fails the stream if a bound is exceeded.
  void mark() override;

  // Returns which bound the file exceeds, with the remedy; empty if none.
  const std::string& problem() const { return problem_; }

 private:
  void Stop(std::string problem);

  DicomProducer producer_;
  std::clock_t began_;
  const char* stack_ = nullptr;  // where the stack was at the first mark
  std::size_t elements_ = 0;
  std::string problem_;
};

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_DICOM_STREAM_H_
