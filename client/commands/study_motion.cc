// `phrenic study motion`: fits and judges the breaths of many people, in this process.
#include <filesystem>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/files/scene_lungs.h"
#include "client/files/whole_file.h"
#include "client/print/motion_fit.h"
#include "client/print/motion_page.h"
#include "client/print/output.h"
#include "client/terminal/progress.h"
#include "server/crypto/sha256.h"
#include "server/fit/kept_fit.h"
#include "server/fit/motion_study.h"
#include "server/schema/file_bytes.h"
#include "server/service/calls/status.h"

namespace phrenic::client {
namespace {

struct MotionStudyOptions {
  SceneOptions scene = {.scene = "thorax"};
  std::string cases, data_dir, page, keep;  // empty: none
  fit::FitOptions fit;
};

void AppendNumbers(const Eigen::Ref<const Points>& points, std::string& text) {
  const Points copy = points;
  text.append(reinterpret_cast<const char*>(copy.data()), sizeof(double) * static_cast<std::size_t>(copy.size()));
}

// Returns the file in which a person's fit is kept: its name tells what was fitted, how, with which lungs.
std::string KeptFile(const MotionStudyOptions& options, const fit::LungTemplates& lungs, const fit::StudyCase& person) {
  std::string text = absl::StrCat(PHRENIC_VERSION, " ", options.fit.numbers, " ", options.fit.split, "\n");
  for (const fit::LungTemplate& lung : lungs) AppendNumbers(lung.surface().vertices, text);
  AppendNumbers(person.landmarks.exhale, text);
  AppendNumbers(person.landmarks.motion, text);
  return absl::StrCat(options.keep, "/", person.name, "-", Sha256Hex(text).substr(0, 16), ".fit");
}

// Keeps fits as files, each with the hash of its bytes before them; `found` counts those that are there.
fit::KeptFits KeepIn(const MotionStudyOptions& options, const fit::LungTemplates& lungs, int& found) {
  if (options.keep.empty()) return {};
  const auto find = [&](const fit::StudyCase& person) -> std::optional<fit::MotionFit> {
    const std::optional<std::string> bytes = ReadBytes(KeptFile(options, lungs, person));
    constexpr size_t kHash = 64;
    if (!bytes || bytes->size() < kHash || Sha256Hex(bytes->substr(kHash)) != bytes->substr(0, kHash)) {
      return std::nullopt;
    }
    std::optional<fit::MotionFit> fit = fit::ReadKeptFit(std::string_view(*bytes).substr(kHash));
    found += fit ? 1 : 0;
    return fit;
  };
  const auto keep = [&](const fit::StudyCase& person, const fit::MotionFit& fit) {
    std::error_code error;
    std::filesystem::create_directories(options.keep, error);
    const std::string bytes = fit::KeepFit(fit);
    return WriteWhole(KeptFile(options, lungs, person), Sha256Hex(bytes) + bytes);
  };
  return {find, keep};
}

absl::StatusOr<fit::MotionStudy> RunMotionStudy(const Context& context, const MotionStudyOptions& options) {
  const auto cases = fit::ReadCases(options.cases);
  if (!cases.ok()) return cases.status();
  const absl::StatusOr<v1::SceneSource> scene = ReadScene(options.scene);
  if (!scene.ok()) return scene.status();
  const auto lungs = ReadSceneLungs(*scene, options.data_dir);
  if (!lungs.ok()) return lungs.status();
  Progress progress("fitting people", 1);
  int found = 0;
  const auto show = [&](double done, std::string_view stage) {
    progress.SetDetail(std::string(stage));
    progress.Update(done);
    return !context.interruption->happened();
  };
  auto study = fit::StudyMotion(lungs->templates, *cases, options.fit, show, KeepIn(options, lungs->templates, found));
  if (found > 0) std::cerr << "kept from before: " << found << " of " << cases->size() << " people\n";
  return study;
}

int MotionStudyCommand(const Context& context, const MotionStudyOptions& options) {
  const auto study = RunMotionStudy(context, options);
  if (!study.ok()) return Fail(context, service::ToGrpc(study.status()));
  if (context.json()) {
    PrintJson(StudyJson(*study));
  } else if (context.output == Output::kCsv) {
    PrintMotionStudyCsv(*study);
  } else {
    PrintMotionStudy(*study);
  }
  if (options.page.empty()) return kOk;
  if (const absl::Status status = WriteWhole(options.page, MotionPage(*study)); !status.ok()) return Fail(status);
  std::cerr << "wrote " << options.page << "\n";
  return kOk;
}

}  // namespace

CommandFunction SetUpStudyMotion(CLI::App& command) {
  const auto options = std::make_shared<MotionStudyOptions>();
  command.add_option("--cases", options->cases, "folder of landmark pairs, one file per person")->required();
  command.add_option("--scene", options->scene.scene, "the scene with the lungs")->capture_default_str();
  AddResolution(command, options->scene.resolution_mm);
  command.add_option("--modes", options->fit.numbers, "numbers that a breath is made of")->capture_default_str();
  command.add_option("--split", options->fit.split, "seed of the random half that is fitted")->capture_default_str();
  command.add_option("--page", options->page, "write the table and a plot per person to this .html file");
  command.add_option("--keep", options->keep,
                     "keep each finished person in this folder, and read finished ones from it");
  AddDataFolder(command, options->data_dir);
  return Bind(&MotionStudyCommand, options);
}

}  // namespace phrenic::client
