// `phrenic study motion`: fits and judges the breaths of many people, in this process.
#include <iostream>

#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/files/scene_lungs.h"
#include "client/files/whole_file.h"
#include "client/print/motion_fit.h"
#include "client/print/motion_page.h"
#include "client/print/output.h"
#include "client/terminal/progress.h"
#include "server/fit/motion_study.h"
#include "server/service/calls/status.h"

namespace phrenic::client {
namespace {

struct MotionStudyOptions {
  SceneOptions scene = {.scene = "thorax"};
  std::string cases, data_dir, page;  // empty page: none
  fit::FitOptions fit;
};

absl::StatusOr<fit::MotionStudy> RunMotionStudy(const Context& context, const MotionStudyOptions& options) {
  const auto cases = fit::ReadCases(options.cases);
  if (!cases.ok()) return cases.status();
  const absl::StatusOr<v1::SceneSource> scene = ReadScene(options.scene);
  if (!scene.ok()) return scene.status();
  const auto lungs = ReadSceneLungs(*scene, options.data_dir);
  if (!lungs.ok()) return lungs.status();
  Progress progress("fitting people", 1);
  return fit::StudyMotion(lungs->templates, *cases, options.fit, [&](double done, std::string_view stage) {
    progress.SetDetail(std::string(stage));
    progress.Update(done);
    return !context.interruption->happened();
  });
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
  AddDataFolder(command, options->data_dir);
  return Bind(&MotionStudyCommand, options);
}

}  // namespace phrenic::client
