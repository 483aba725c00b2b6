// Records the positions of an export's bodies, or its numbers, with a recorder.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_BODY_WRITER_H_
#define PHRENIC_SERVER_SESSION_EXPORT_BODY_WRITER_H_

#include <memory>

#include "server/record/recorder.h"
#include "server/session/export/export_plan.h"
#include "server/session/export/motion_writer.h"

namespace phrenic::session {

// Places plan.bodies, or computes the columns of a format of numbers, and passes them to the format's recorder.
class BodyWriter final : public MotionWriter {
 public:
  // `plan` outlives it. Requires: plan.format.make is set.
  BodyWriter(const ExportPlan& plan, record::Sink sink);

  absl::Status Begin(const Run& run) override;
  absl::Status AddFrame(const Run& run) override;
  absl::Status End(const std::function<absl::Status(double share)>& report) override { return recorder_->End(report); }
  std::int64_t vertices() const override { return positions_.cols(); }

 private:
  void PlaceBodies(const Run& run);

  const ExportPlan& plan_;
  const std::unique_ptr<record::Recorder> recorder_;
  Points positions_;  // of the vertices of plan.bodies, concatenated (3 x n) [m]
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_BODY_WRITER_H_
