#include "server/session/export/page_writer.h"

#include <fstream>
#include <sstream>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "server/stream/codecs/zstd.h"
#include "server/stream/geometry.h"

namespace phrenic::session {
namespace {

constexpr std::string_view kMotionPlace = "__PHRENIC_MOTION__";
constexpr std::size_t kMostFrameBytes = std::size_t{64} << 20;

}  // namespace

absl::StatusOr<std::string> ReadPageTemplate(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream page;
  page << file.rdbuf();
  std::string html = page.str();
  if (file && html.find(kMotionPlace) != std::string::npos) return html;
  return absl::NotFoundError(
      absl::StrCat("format: html needs the built viewer's ", path, ": build it (npm run build in web/)"));
}

PageWriter::PageWriter(std::shared_ptr<const Model> model, const std::vector<int>& bodies, std::string page,
                       record::Sink sink)
    : model_(std::move(model)),
      layout_(*model_),
      encoder_(model_, layout_),
      page_(std::move(page)),
      sink_(std::move(sink)),
      bodies_(bodies),
      numbers_(model_->bodies.size(), -1) {}

absl::Status PageWriter::Begin(const Run& run) {
  motion_.set_scene(model_->scene.name());
  motion_.set_scene_title(model_->scene.title());
  *motion_.mutable_parameters() = run.parameters();
  *motion_.mutable_scene_parameters() = model_->parameters;
  *motion_.mutable_presets() = model_->scene.presets();
  *motion_.mutable_report() = model_->report;
  motion_.mutable_report()->clear_compile_seconds();
  motion_.mutable_report()->clear_stages();
  AddBodies();
  return absl::OkStatus();
}

void PageWriter::AddBodies() {
  motion_.mutable_bodies()->Reserve(static_cast<int>(bodies_.size()));
  int first_vertex = 0;
  for (const int body : bodies_) {
    v1::GetGeometryResponse& geometry = *motion_.add_bodies();
    geometry = stream::MakeGeometry(*model_, layout_, body);
    geometry.set_body_index(motion_.bodies_size() - 1);
    geometry.set_body_count(static_cast<int>(bodies_.size()));
    numbers_[static_cast<std::size_t>(body)] = geometry.body_index();
    if (geometry.placement() != v1::PLACEMENT_STREAMED) continue;
    geometry.set_first_vertex(first_vertex);
    first_vertex += static_cast<int>(model_->bodies[static_cast<std::size_t>(body)].mesh.vertices.cols());
    streamed_.push_back(body);
  }
}

absl::Status PageWriter::AddFrame(const Run& run) {
  const stream::Snapshot snapshot = {.sequence = frames_[0].size() + 1,
                                     .state = run.state(),
                                     .parameters = run.parameters(),
                                     .made = absl::UnixEpoch()};
  for (std::size_t i = 0; i < kBoundLevels.size(); ++i) {
    const stream::Bytes bytes = encoder_.Encode(
        snapshot, {.codec = v1::CODEC_PREDICTED, .bound_level = kBoundLevels[i], .chosen = true, .bodies = streamed_});
    v1::WatchFramesResponse response;
    if (bytes == nullptr || !response.ParseFromString(*bytes)) {
      return absl::InternalError(absl::StrCat("the frame at ", run.state().time, " s has numbers that are not finite"));
    }
    for (int& body : *response.mutable_frame()->mutable_bodies()) body = numbers_[static_cast<std::size_t>(body)];
    frames_[i].Add(std::move(*response.mutable_frame()));
    if (i + 1 == kBoundLevels.size()) coarsest_bytes_ += bytes->size();
  }
  if (coarsest_bytes_ <= kMostFrameBytes) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      "seconds: the page would have more than 64 MiB; record fewer seconds or fewer frames a second");
}

absl::Status PageWriter::End(const std::function<absl::Status(double share)>& report) {
  std::string page;
  for (std::size_t i = 0; i < frames_.size() && (i == 0 || page.size() > kPageBytes); ++i) {
    page = MakePage(frames_[i]);
    absl::Status go_on = report(static_cast<double>(i + 1) / static_cast<double>(frames_.size()));
    if (!go_on.ok()) return go_on;
  }
  return sink_(page);
}

std::string PageWriter::MakePage(Frames& frames) {
  motion_.mutable_frames()->Swap(&frames);
  frames.Clear();
  const std::string compressed = stream::CompressSmall(motion_.SerializeAsString());
  const std::size_t at = page_.find(kMotionPlace);
  return absl::StrCat(page_.substr(0, at), absl::Base64Escape(compressed), page_.substr(at + kMotionPlace.size()));
}

}  // namespace phrenic::session
