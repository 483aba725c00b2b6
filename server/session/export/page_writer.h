// Writes a motion as one HTML file that plays it without a server.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_PAGE_WRITER_H_
#define PHRENIC_SERVER_SESSION_EXPORT_PAGE_WRITER_H_

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/offline.pb.h"
#include "server/record/recorder.h"
#include "server/session/export/motion_writer.h"
#include "server/stream/encoder.h"

namespace phrenic::session {

// A page is at most this large [bytes] if its frames can be encoded within 1 mm.
inline constexpr std::size_t kPageBytes = 4'900'000;

// Returns the template of a page: the viewer's offline.html. NOT_FOUND if the viewer is not built. Thread-safe.
absl::StatusOr<std::string> ReadPageTemplate(const std::string& path);

// Holds the frames in memory, encoded as viewers get them (CODEC_PREDICTED) within 0.1, 0.2, 0.5 and 1 mm, and writes
// the page at the end with the finest that gives at most kPageBytes; with those of 1 mm if none does. The page contains
// a v1::OfflineMotion; equal runs give equal bytes. RESOURCE_EXHAUSTED if the frames within 1 mm have more than 64 MiB;
// INTERNAL if a number is not finite.
class PageWriter final : public MotionWriter {
 public:
  // `bodies` are numbers in the model, ascending; the page numbers them from 0. `page` is the template.
  PageWriter(std::shared_ptr<const Model> model, const std::vector<int>& bodies, std::string page, record::Sink sink);

  absl::Status Begin(const Run& run) override;
  absl::Status AddFrame(const Run& run) override;
  absl::Status End(const std::function<absl::Status(double share)>& report) override;
  std::int64_t vertices() const override { return layout_.vertices(); }

 private:
  static constexpr std::array<int, 4> kBoundLevels = {6, 7, 8, 9};  // 0.1, 0.2, 0.5, 1 mm
  using Frames = google::protobuf::RepeatedPtrField<v1::Frame>;

  // Adds the bodies of the page.
  void AddBodies();
  // Returns the page with the frames of one bound, of which it takes the memory.
  std::string MakePage(Frames& frames);

  const std::shared_ptr<const Model> model_;
  const stream::Layout layout_;
  stream::Encoder encoder_;
  const std::string page_;
  const record::Sink sink_;
  v1::OfflineMotion motion_;                        // without frames
  const std::vector<int> bodies_;                   // of the page, by number in the model
  std::vector<int> streamed_;                       // those with positions in frames
  std::vector<int> numbers_;                        // in the page, by number in the model; -1: not in the page
  std::array<Frames, kBoundLevels.size()> frames_;  // by error bound
  std::size_t coarsest_bytes_ = 0;                  // of the frames with the largest bound
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_PAGE_WRITER_H_
