// `phrenic lungs`: how lung tissue moves in a scene's breaths, in this process; its field as a file.
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/files/local_models.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/print/table.h"
#include "client/terminal/progress.h"
#include "server/imaging/gzip.h"
#include "server/imaging/nifti_vectors.h"
#include "server/mechanics/compile/presets.h"
#include "server/mechanics/motions/lung_modes.h"
#include "server/mesh/units.h"
#include "server/physiology/lung_breath.h"
#include "server/service/calls/status.h"
#include "server/vtk/image_data.h"
#include "server/vtk/unstructured_grid.h"

namespace phrenic::client {
namespace {

using physiology::LungReading;

struct LungsOptions {
  SceneOptions scene;
  std::vector<std::string> presets;  // empty: the scene's own parameters
  std::vector<std::string> settings;
  bool glued = false, weightless = false, unfilled = false, rootless = false, bound_margin = false;  // for comparison
  double edge_mm = LungElasticity().edge * kMillimetresAMetre, spacing_mm = 4;
  std::string data_dir, field;  // empty field: no file
};

// The readings of one breath.
struct LungsOfBreath {
  std::string preset;
  double air = 0;  // that the lungs gain, by the scene's pressures [m^3]; NaN without them
  std::vector<LungReading> lungs;
};

constexpr std::pair<physiology::LungRegion, const char*> kRegions[] = {
    {physiology::kLungBase, "base"}, {physiology::kLungMiddle, "middle"}, {physiology::kLungApex, "apex"},
    {physiology::kLungBack, "back"}, {physiology::kLungFront, "front"},
};

absl::Status CheckField(const LungsOptions& options) {
  if (options.field.empty()) return absl::OkStatus();
  if (options.presets.size() > 1) {
    return absl::InvalidArgumentError("--grid holds one breath: give one --preset with it");
  }
  for (const char* ending : {".vti", ".vtu", ".nii", ".nii.gz"}) {
    if (absl::EndsWith(options.field, ending)) return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("--grid ", options.field, ": the formats are .vti, .vtu, .nii and .nii.gz"));
}

absl::StatusOr<std::shared_ptr<const Model>> CompileLungs(const Context& context, const LungsOptions& options) {
  const absl::StatusOr<v1::SceneSource> source = ReadScene(options.scene);
  if (!source.ok()) return source.status();
  return CompileLocally(context, *source, options.scene.scene, options.data_dir);
}

absl::StatusOr<v1::Parameters> LungParameters(const Model& model, const std::string& preset,
                                              const v1::Parameters& settings) {
  const absl::StatusOr<v1::Parameters> found = FindPreset(model.scene, preset);
  if (!found.ok()) return found.status();
  v1::Parameters parameters = model.parameters;
  parameters.MergeFrom(*found);
  parameters.MergeFrom(settings);
  return parameters;
}

absl::StatusOr<physiology::Recording> Breathe(const Context& context, const physiology::Subject& subject,
                                              const std::string& preset, const v1::Parameters& parameters) {
  Progress progress("breathing " + (preset.empty() ? subject.model.scene.name() : preset));
  auto breath = physiology::Record(
      subject, preset, parameters, [&](double) { return !context.interruption->happened(); },
      physiology::FlawSearch::kNever);
  if (!breath.ok() || breath->problem.empty()) return breath;
  return absl::FailedPreconditionError(absl::StrCat(preset, ": ", breath->problem));
}

// The bricks of the lungs' tissue, with what moves their corners.
UnstructuredGrid BricksOf(const std::vector<LungMotion>& motions) {
  Eigen::Index nodes = 0, bricks = 0;
  for (const LungMotion& motion : motions) {
    nodes += motion.nodes.cols();
    bricks += static_cast<Eigen::Index>(motion.tissue.grid().bricks().size());
  }
  UnstructuredGrid grid = {Eigen::Matrix3Xd(3, nodes), Eigen::Matrix<int, 8, Eigen::Dynamic>(8, bricks), {}, {}};
  Eigen::MatrixXf displacement(3, nodes), ventilation(1, bricks), inside(1, bricks), lung(1, bricks);
  Eigen::Index node = 0, brick = 0;
  for (size_t i = 0; i < motions.size(); ++i) {
    const BrickGrid& of = motions[i].tissue.grid();
    grid.points.middleCols(node, of.nodes().cols()) = kMillimetresAMetre * of.nodes();
    displacement.middleCols(node, of.nodes().cols()) = (kMillimetresAMetre * motions[i].nodes).cast<float>();
    for (size_t b = 0; b < of.bricks().size(); ++b, ++brick) {
      grid.cells.col(brick) = of.bricks()[b].array() + static_cast<int>(node);
      const Eigen::Vector3d middle = of.nodes().col(of.bricks()[b][0]).array() + of.edge() / 2;
      ventilation(0, brick) = static_cast<float>(motions[i].tissue.GradientAt(motions[i].nodes, middle).trace());
      const BrickFractions& parts = of.fractions()[b];
      inside(0, brick) = std::accumulate(parts.begin(), parts.end(), 0.0F) / static_cast<float>(parts.size());
      lung(0, brick) = static_cast<float>(i + 1);
    }
    node += of.nodes().cols();
  }
  grid.point_arrays = {{"displacement", displacement}};
  grid.cell_arrays = {{"ventilation", ventilation}, {"inside", inside}, {"lung", lung}};
  return grid;
}

absl::Status WriteField(const std::vector<LungMotion>& motions, const LungsOptions& options) {
  if (absl::EndsWith(options.field, ".vtu")) {
    if (absl::Status status = WriteWhole(options.field, WriteVtu(BricksOf(motions))); !status.ok()) return status;
    std::cerr << "wrote " << options.field << "\n";
    return absl::OkStatus();
  }
  const absl::StatusOr<LungField> sampled = SampleLungs(motions, options.spacing_mm / kMillimetresAMetre);
  if (!sampled.ok()) return sampled.status();
  const LungField& field = *sampled;
  const Eigen::Vector3d origin = kMillimetresAMetre * field.origin;
  const Points displacement = kMillimetresAMetre * field.displacement;
  std::string bytes;
  if (absl::EndsWith(options.field, ".vti")) {
    const Eigen::Map<const Eigen::Matrix<std::uint8_t, 1, Eigen::Dynamic>> lung(
        field.lung.data(), static_cast<Eigen::Index>(field.lung.size()));
    bytes = WriteVti({field.size,
                      origin,
                      Eigen::Vector3d::Constant(options.spacing_mm),
                      {{"ventilation", field.ventilation.transpose().cast<float>()},
                       {"displacement", displacement.cast<float>()},
                       {"lung", lung.cast<float>()}}});
  } else {
    const Eigen::Affine3d to_patient = Eigen::Translation3d(origin) * Eigen::Scaling(options.spacing_mm);
    bytes = imaging::WriteNiftiVectors(field.size, to_patient, displacement);
    if (absl::EndsWith(options.field, ".gz")) bytes = imaging::Deflate(bytes);
  }
  if (absl::Status status = WriteWhole(options.field, bytes); !status.ok()) return status;
  std::cerr << "wrote " << options.field << "\n";
  return absl::OkStatus();
}

// The lungs of a person's scene, which boundary modes move: their breath is known without running it.
absl::StatusOr<std::vector<LungsOfBreath>> ReadModes(const Model& model, const v1::Parameters& settings,
                                                     const LungsOptions& options) {
  if (options.glued || options.weightless || options.unfilled || options.rootless || options.bound_margin) {
    return absl::FailedPreconditionError(
        "the motion of these lungs' walls is prescribed: --glued, --weightless, --unfilled, --rootless and "
        "--bound-margin change nothing");
  }
  std::vector<LungsOfBreath> breaths;
  const auto presets = options.presets.empty() ? std::vector<std::string>{""} : options.presets;
  for (const std::string& preset : presets) {
    const auto parameters = LungParameters(model, preset, settings);
    if (!parameters.ok()) return parameters.status();
    const auto motions = physiology::MotionsOfModes(model, *parameters);
    if (!motions.ok()) return motions.status();
    LungsOfBreath breath = {preset, std::nan(""), physiology::ReadingsOf(*motions)};
    const std::vector<LungModes::Inside>& insides = LungModes::Find(model)->insides();
    for (size_t i = 0; i < breath.lungs.size(); ++i) {
      breath.lungs[i].lung = model.bodies[static_cast<size_t>(insides[i].body)].name;
    }
    breaths.push_back(std::move(breath));
    if (options.field.empty()) continue;
    if (absl::Status status = WriteField(*motions, options); !status.ok()) return status;
  }
  return breaths;
}

absl::StatusOr<std::vector<LungsOfBreath>> ReadBreaths(const Context& context, const LungsOptions& options) {
  const absl::StatusOr<v1::Parameters> settings = ReadSettings(options.settings);
  if (!settings.ok()) return settings.status();
  const auto model = CompileLungs(context, options);
  if (!model.ok()) return model.status();
  if (LungModes::Find(**model) != nullptr) return ReadModes(**model, *settings, options);
  const auto subject = physiology::Subject::Of(**model);
  if (!subject.ok()) return subject.status();
  LungElasticity elasticity = physiology::DrivenLungs();
  elasticity.edge = options.edge_mm / kMillimetresAMetre;
  if (options.glued) elasticity.tangential = elasticity.contact;
  const physiology::LungCauses causes = {.weight = !options.weightless,
                                         .space = !options.unfilled,
                                         .root = !options.rootless,
                                         .margin = !options.bound_margin};
  const auto lungs = physiology::BreathingLungs::Make(**subject, elasticity, causes);
  if (!lungs.ok()) return lungs.status();
  std::vector<LungsOfBreath> breaths;
  const auto presets = options.presets.empty() ? std::vector<std::string>{""} : options.presets;
  for (const std::string& preset : presets) {
    const auto parameters = LungParameters(**model, preset, *settings);
    if (!parameters.ok()) return parameters.status();
    const auto breath = Breathe(context, **subject, preset, *parameters);
    if (!breath.ok()) return breath.status();
    const std::vector<LungMotion> motions = lungs->Motions(*breath);
    const std::vector<double>& volume = breath->of[physiology::kVolume];
    breaths.push_back({preset, volume[breath->peak_sample] - volume.front(), lungs->Readings(motions)});
    if (options.field.empty()) continue;
    if (absl::Status status = WriteField(motions, options); !status.ok()) return status;
  }
  return breaths;
}

// Prints the readings as a table: millimetres, millilitres, per cent of the volume at rest.
void PrintLungs(const Context& context, const std::vector<LungsOfBreath>& breaths) {
  Table table({"preset", "lung", "volume ml", "base mm", "middle mm", "apex mm", "back/front", "up %", "base %",
               "middle %", "apex %", "back %", "front %"});
  for (const LungsOfBreath& breath : breaths) {
    for (const LungReading& lung : breath.lungs) {
      std::vector<std::string> row = {breath.preset.empty() ? "-" : breath.preset, lung.lung,
                                      absl::StrFormat("%.0f", 1e6 * lung.volume)};
      for (int r = physiology::kLungBase; r <= physiology::kLungApex; ++r) {
        row.push_back(absl::StrFormat("%.1f", kMillimetresAMetre * lung.caudal[r]));
      }
      row.push_back(std::isnan(lung.back_over_front) ? "-" : absl::StrFormat("%.2f", lung.back_over_front));
      row.push_back(absl::StrFormat("%.0f", 100 * lung.upwards));
      for (const auto& [region, name] : kRegions) row.push_back(absl::StrFormat("%.1f", 100 * lung.gained[region]));
      table.Add(row);
    }
  }
  if (context.output == Output::kCsv) return table.PrintCsv(std::cout);
  table.Print(std::cout);
  std::cout << "\nmm: mean descent; %: volume gained, of that at rest. Thirds of the height, and of the depth.\n";
  for (const LungsOfBreath& breath : breaths) {
    double tissue = 0;
    for (const LungReading& lung : breath.lungs) tissue += lung.volume;
    std::cout << absl::StrFormat("%s: the tissue gains %.0f ml", breath.preset.empty() ? "breath" : breath.preset,
                                 1e6 * tissue);
    std::cout << (std::isnan(breath.air) ? "\n" : absl::StrFormat(", the lungs %.0f ml of air\n", 1e6 * breath.air));
  }
}

void PrintLungsJson(const std::vector<LungsOfBreath>& breaths) {
  nlohmann::json json = nlohmann::json::array();
  for (const LungsOfBreath& breath : breaths) {
    nlohmann::json lungs = nlohmann::json::array();
    for (const LungReading& lung : breath.lungs) {
      nlohmann::json caudal, gained;
      for (const auto& [region, name] : kRegions) {
        caudal[name] = kMillimetresAMetre * lung.caudal[region];
        gained[name] = lung.gained[region];
      }
      lungs.push_back({{"lung", lung.lung},
                       {"volume_ml", 1e6 * lung.volume},
                       {"descent_mm", caudal},
                       {"ventilation", gained},
                       {"back_over_front", lung.back_over_front},
                       {"upwards", lung.upwards}});
    }
    json.push_back({{"preset", breath.preset}, {"lungs", lungs}});
    if (!std::isnan(breath.air)) json.back()["air_ml"] = 1e6 * breath.air;
  }
  PrintJson(json);
}

int Lungs(const Context& context, const LungsOptions& options) {
  if (absl::Status status = CheckField(options); !status.ok()) return Fail(status);
  const auto breaths = ReadBreaths(context, options);
  if (!breaths.ok()) return Fail(context, service::ToGrpc(breaths.status()));
  context.json() ? PrintLungsJson(*breaths) : PrintLungs(context, *breaths);
  return kOk;
}

}  // namespace

CommandFunction SetUpLungs(CLI::App& command) {
  const auto options = std::make_shared<LungsOptions>();
  AddScene(command, options->scene);
  command
      .add_option("--preset", options->presets, "a preset of the scene; may be repeated (the scene's own parameters)")
      ->allow_extra_args(false);
  AddParameters(command, options->settings);
  command.add_option(
      "--grid", options->field,
      "write displacement [mm, LPS] and ventilation at the peak of the breath to this file: .vti, "
      ".vtu (the bricks of the tissue), or .nii and .nii.gz (displacement alone, as ITK and ANTs read it)");
  command.add_option("--spacing", options->spacing_mm, "distance of the field's points [mm]")
      ->check(NumberIn(0.5, 50))
      ->capture_default_str();
  command.add_option("--brick", options->edge_mm, "edge of the bricks of tissue [mm]")
      ->check(NumberIn(5, 50))
      ->capture_default_str();
  command.add_flag("--glued", options->glued,
                   "for comparison: glue the lungs to what surrounds them; by default they slide");
  command.add_flag("--weightless", options->weightless,
                   "for comparison: lungs without weight; by default weight makes dependent tissue softer");
  command.add_flag("--unfilled", options->unfilled,
                   "for comparison: lungs that only follow what touches them at rest; by default they also fill the "
                   "space that opens");
  command.add_flag(
      "--rootless", options->rootless,
      "for comparison: lungs that slide at their root too; by default bronchi and vessels bind it to the mediastinum");
  command.add_flag(
      "--bound-margin", options->bound_margin,
      "for comparison: bind the lungs' margin to the diaphragm; by default it slides into the recess that opens");
  AddDataFolder(command, options->data_dir);
  return Bind(&Lungs, options);
}

}  // namespace phrenic::client
