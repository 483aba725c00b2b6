// Reads the interior of a session's lungs beside its frames.
#ifndef PHRENIC_CLIENT_CONNECTION_TISSUE_PROBE_H_
#define PHRENIC_CLIENT_CONNECTION_TISSUE_PROBE_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/connection/context.h"
#include "phrenic/v1/frames.pb.h"
#include "phrenic/v1/tissue.grpc.pb.h"

namespace phrenic::client {

// What is read of the lungs; nothing by default.
struct TissueQuestion {
  bool regions = false;           // ventilation of each lung's base, middle, apex, back and front, and its volume
  std::vector<double> points_mm;  // x, y, z of each point at rest [mm, LPS]

  bool empty() const { return !regions && points_mm.empty(); }
};

// Returns OK if there are three coordinates a point.
absl::Status CheckQuestion(const TissueQuestion& question);

// Asks for the tissue, one call a frame. Not thread-safe. `phrenic watch` makes one.
class TissueProbe {
 public:
  TissueProbe(const Context& context, const std::string& session, TissueQuestion question);

  // Adds to a frame the measures "lung-right base ventilation" [1] and "lung-right gained" [m^3], and for each point a
  // probe "lung-right 60,30,250" and the measures of its ventilation and strain [1]. They are of the newest state, at
  // most a frame from that of `frame`. The errors of ReadTissue; INVALID_ARGUMENT names a point outside the lungs.
  grpc::Status AddTo(v1::Frame& frame);

 private:
  void AddLung(const v1::LungReading& lung, v1::Frame& frame) const;
  static void AddPoint(const v1::PointReading& reading, const v1::Vector& at, const std::string& name,
                       v1::Frame& frame);

  const TissueQuestion question_;
  const std::unique_ptr<v1::TissueService::Stub> stub_;
  v1::ReadTissueRequest request_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_TISSUE_PROBE_H_
