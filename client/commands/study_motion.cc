// `phrenic study motion`: fits and judges the breaths of many people, in this process.
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/argument_kinds.h"
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
#include "server/study/batch/run_pool.h"

namespace phrenic::client {
namespace {

struct MotionStudyOptions {
  SceneOptions scene = {.scene = "thorax"};
  std::string cases, data_dir, page, keep;  // empty: none
  int threads = 0;                          // people at a time; 0: one per core
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

// Keeps fits as files, each with the hash of its bytes before them. Thread-safe.
fit::KeptFits KeepIn(const MotionStudyOptions& options, const fit::LungTemplates& lungs) {
  if (options.keep.empty()) return {};
  const auto find = [&](const fit::StudyCase& person) -> std::optional<fit::MotionFit> {
    const std::optional<std::string> bytes = ReadBytes(KeptFile(options, lungs, person));
    constexpr size_t kHash = 64;
    if (!bytes || bytes->size() < kHash || Sha256Hex(bytes->substr(kHash)) != bytes->substr(0, kHash)) {
      return std::nullopt;
    }
    return fit::ReadKeptFit(std::string_view(*bytes).substr(kHash));
  };
  const auto keep = [&](const fit::StudyCase& person, const fit::MotionFit& fit) {
    std::error_code error;
    std::filesystem::create_directories(options.keep, error);
    const std::string bytes = fit::KeepFit(fit);
    return WriteWhole(KeptFile(options, lungs, person), Sha256Hex(bytes) + bytes);
  };
  return {find, keep};
}

// Fits all people on the threads of batches (study/batch/run_pool.h) as soon as the first is asked for. What failed is
// left to the study, which says so.
class PeopleFits {
 public:
  PeopleFits(const Context& context, const MotionStudyOptions& options, const fit::LungTemplates& lungs,
             const std::vector<fit::StudyCase>& cases, Progress& progress)
      : context_(context),
        options_(options),
        lungs_(lungs),
        cases_(cases),
        kept_(KeepIn(options, lungs)),
        progress_(progress),
        fits_(cases.size()) {}

  // Returns the fit of one of the cases, once; nothing if it failed.
  std::optional<fit::MotionFit> Take(const fit::StudyCase& person) {
    if (!begun_) FitAll();
    return std::exchange(fits_[static_cast<size_t>(&person - cases_.data())], std::nullopt);
  }
  const fit::KeptFits& kept() const { return kept_; }
  // Returns how many were kept from before.
  int found() const { return found_; }

 private:
  struct Done {
    size_t person;
    bool found;
    fit::MotionFit fit;
  };

  absl::StatusOr<Done> FindOrFit(size_t person, const std::function<bool()>& ended) const {
    const fit::StudyCase& each = cases_[person];
    if (kept_.find) {
      if (auto fit = kept_.find(each)) return Done{person, true, *std::move(fit)};
    }
    auto fit = fit::FitMotion(lungs_, each.landmarks, options_.fit, [&](double, std::string_view) { return !ended(); });
    if (!fit.ok()) return fit.status();
    return Done{person, false, *std::move(fit)};
  }

  void FitAll() {
    begun_ = true;
    size_t done = 0;
    const study::MakeResult<Done> make = [this](size_t person, const std::function<bool()>& ended) {
      return FindOrFit(person, ended);
    };
    const auto take = [&](Done result) {
      const fit::StudyCase& person = cases_[result.person];
      if (!result.found && kept_.keep && !kept_.keep(person, result.fit).ok()) return false;
      found_ += result.found ? 1 : 0;
      fits_[result.person] = std::move(result.fit);
      progress_.SetDetail(person.name);
      progress_.Update(static_cast<double>(++done) / static_cast<double>(cases_.size()));
      return true;
    };
    study::RunOnThreads<Done>(cases_.size(), study::ThreadsFor(options_.threads, cases_.size()), make, take, [this] {
      return context_.interruption->happened();
    }).IgnoreError();
  }

  const Context& context_;
  const MotionStudyOptions& options_;
  const fit::LungTemplates& lungs_;
  const std::vector<fit::StudyCase>& cases_;
  const fit::KeptFits kept_;
  Progress& progress_;
  bool begun_ = false;
  int found_ = 0;
  std::vector<std::optional<fit::MotionFit>> fits_;
};

absl::StatusOr<fit::MotionStudy> RunMotionStudy(const Context& context, const MotionStudyOptions& options) {
  const auto cases = fit::ReadCases(options.cases);
  if (!cases.ok()) return cases.status();
  const absl::StatusOr<v1::SceneSource> scene = ReadScene(options.scene);
  if (!scene.ok()) return scene.status();
  const auto lungs = ReadSceneLungs(*scene, options.data_dir);
  if (!lungs.ok()) return lungs.status();
  Progress progress("fitting people", 1);
  PeopleFits fits(context, options, lungs->templates, *cases, progress);
  const auto go_on = [&](double, std::string_view) { return !context.interruption->happened(); };
  auto study =
      fit::StudyMotion(lungs->templates, *cases, options.fit, go_on,
                       {[&fits](const fit::StudyCase& person) { return fits.Take(person); }, fits.kept().keep});
  if (fits.found() > 0) std::cerr << "kept from before: " << fits.found() << " of " << cases->size() << " people\n";
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
  command.add_option("--threads", options->threads, "people at a time (one per core)")->check(NumberIn(1, 10'000));
  AddDataFolder(command, options->data_dir);
  return Bind(&MotionStudyCommand, options);
}

}  // namespace phrenic::client
