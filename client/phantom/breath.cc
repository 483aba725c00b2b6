#include "client/phantom/breath.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/connection/errors.h"
#include "client/files/local_models.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/print/table.h"
#include "client/terminal/progress.h"
#include "google/protobuf/util/json_util.h"
#include "server/imaging/gzip.h"
#include "server/imaging/nifti.h"
#include "server/imaging/nifti_header.h"
#include "server/imaging/nifti_vectors.h"
#include "server/mechanics/step/step.h"
#include "server/mesh/units.h"
#include "server/meshio/formats.h"
#include "server/phantom/breathing_phantom.h"
#include "server/phantom/dicom/objects.h"
#include "server/phantom/hounsfield.h"
#include "server/service/calls/status.h"

namespace phrenic::client {
namespace {

using phantom::BreathingPhantom;
using phantom::PhantomPhase;

bool Wants(const BreathOptions& options, const char* kind) {
  return std::any_of(options.dicom.begin(), options.dicom.end(), [&](const std::string& each) {
    return each == kind || (each == "all" && std::string(kind) != "ct");
  });
}

// A run of a scene that is stopped at the phases of a breath.
struct BreathRun {
  std::shared_ptr<const Model> model;
  v1::Parameters parameters;
  std::vector<State> phases;
};

absl::Status Breathe(const Context& context, const BreathOptions& options, BreathRun& run) {
  State state = run.model->InitialState();
  Workspace work = run.model->MakeWorkspace();
  const double length = run.parameters.breath_length();
  Progress progress("breathing", options.start + length);
  for (int phase = 0; phase < options.phases; ++phase) {
    const double until = options.start + length * phase / options.phases;
    while (state.time < until - 1e-9) {
      if (context.interruption->happened()) return absl::CancelledError("the run was interrupted");
      absl::Status status = Step(*run.model, run.parameters, run.parameters.time_step(), state, work);
      if (!status.ok()) {
        return absl::Status(status.code(), absl::StrFormat("at %.3f s: %s", state.time, std::string(status.message())));
      }
      progress.Update(state.time);
    }
    run.phases.push_back(state);
  }
  return absl::OkStatus();
}

absl::StatusOr<BreathRun> RunBreath(const Context& context, const BreathOptions& options) {
  const absl::StatusOr<v1::SceneSource> source = ReadScene(options.scene);
  if (!source.ok()) return source.status();
  auto model = CompileLocally(context, *source, options.scene.scene, options.data_dir);
  if (!model.ok()) return model.status();
  BreathRun run{*std::move(model), {}, {}};
  absl::StatusOr<v1::Parameters> parameters = ChosenParameters(*run.model, options.preset, options.settings);
  if (!parameters.ok()) return parameters.status();
  run.parameters = *std::move(parameters);
  if (absl::Status status = Breathe(context, options, run); !status.ok()) return status;
  return run;
}

// Returns a NIfTI-1 file of CT numbers (int16).
std::string CtBytes(const PhantomPhase& rendered) {
  constexpr int kInt16 = 4;
  const imaging::LabelVolume& volume = rendered.labels;
  std::string bytes = imaging::NiftiHeaderBytes({{3, volume.size.x(), volume.size.y(), volume.size.z(), 1, 1, 1, 1},
                                                 volume.Spacing(),
                                                 volume.to_patient,
                                                 0,
                                                 kInt16,
                                                 16,
                                                 0});
  for (const std::int16_t number : rendered.ct) {
    const auto bits = static_cast<std::uint16_t>(number);
    bytes.push_back(static_cast<char>(bits & 0xFF));
    bytes.push_back(static_cast<char>(bits >> 8));
  }
  return bytes;
}

// Writes one phantom's files and describes them.
class Writer {
 public:
  Writer(const Context& context, const BreathOptions& options, const BreathRun& run, BreathingPhantom& phantom,
         std::string folder)
      : context_(context), options_(options), run_(run), phantom_(phantom), folder_(std::move(folder)) {
    std::string parameters;
    (void)google::protobuf::util::MessageToJsonString(run.parameters, &parameters);
    study_ = {
        absl::StrCat(run.model->scene.SerializeAsString(), "\n", parameters, "\n", options.phases, " ", options.start),
        absl::StrCat("Phrenic phantom: ", run.model->scene.name(), options.preset.empty() ? "" : ", ", options.preset),
        PHRENIC_VERSION};
  }

  absl::Status WriteAll(double spacing_mm) {
    study_.key += absl::StrCat(" ", spacing_mm, " ", options_.texture);
    Progress progress("phases", static_cast<double>(phantom_.phases()));
    nlohmann::json phases = nlohmann::json::array();
    for (std::size_t phase = 0; phase < phantom_.phases(); ++phase) {
      const auto go_on = [this] {
        return context_.interruption->happened() ? absl::CancelledError("the phantom was interrupted")
                                                 : absl::OkStatus();
      };
      const absl::StatusOr<PhantomPhase> rendered = phantom_.Render(phase, go_on);
      if (!rendered.ok()) return rendered.status();
      absl::StatusOr<nlohmann::json> written = WritePhase(*rendered, static_cast<int>(phase));
      if (!written.ok()) return written.status();
      phases.push_back(*std::move(written));
      progress.Update(static_cast<double>(phase + 1));
    }
    return WriteReport(spacing_mm, std::move(phases));
  }

  const nlohmann::json& report() const { return report_; }

 private:
  absl::Status Write(const std::string& name, const std::string& bytes) const {
    return WriteWhole(folder_ + "/" + name, bytes);
  }

  absl::StatusOr<nlohmann::json> WritePhase(const PhantomPhase& rendered, int phase) const {
    nlohmann::json json = {{"time", rendered.time}, {"structures", VolumesOf(rendered)}};
    const auto add = [&](const char* kind, const std::string& ending, const std::string& bytes) {
      const std::string name = absl::StrFormat("%s-%02d%s", kind, phase, ending);
      json[kind] = name;
      return Write(name, bytes);
    };
    absl::Status status = add("labels", ".nii.gz", imaging::Deflate(imaging::WriteNifti(rendered.labels)));
    if (status.ok() && options_.ct) status = add("ct", ".nii.gz", imaging::Deflate(CtBytes(rendered)));
    if (status.ok() && rendered.field.size() > 0) {
      json["tissue_off_its_surface_mm"] = kMillimetresAMetre * phantom_.misfit();
      status = add("field", ".nii.gz",
                   imaging::Deflate(
                       imaging::WriteNiftiVectors(rendered.labels.size, rendered.labels.to_patient, rendered.field)));
    }
    if (status.ok() && Wants(options_, "seg")) {
      const auto bytes = phantom::WriteSegmentation(study_, phantom_.structures(), rendered, phase);
      if (!bytes.ok()) return bytes.status();
      status = add("seg", ".dcm", *bytes);
    }
    if (status.ok() && Wants(options_, "ct")) status = WriteSeries(rendered, phase);
    for (const char* kind : {"stl", "obj"}) {
      if (!status.ok() || !Wants(options_, kind)) continue;
      const absl::StatusOr<std::string> bytes = ModelOf(kind, rendered.time, phase);
      if (!bytes.ok()) return bytes.status();
      status = add(kind, ".dcm", *bytes);
    }
    if (!status.ok()) return status;
    return json;
  }

  nlohmann::json VolumesOf(const PhantomPhase& rendered) const {
    const double voxel_ml = 1e-3 * rendered.labels.Spacing().prod();
    nlohmann::json json = nlohmann::json::object();
    for (std::size_t s = 0; s < rendered.structures.size(); ++s) {
      const phantom::StructureVoxels& voxels = rendered.structures[s];
      json[phantom_.structures().all[s].name] = {
          {"surface_ml", 1e-3 * voxels.enclosed_mm3},
          {"voxels_ml", voxel_ml * static_cast<double>(voxels.inside)},
          {"of_these_in_smaller_structures_ml", voxel_ml * static_cast<double>(voxels.inside - voxels.labelled)}};
    }
    return json;
  }

  absl::Status WriteSeries(const PhantomPhase& rendered, int phase) const {
    const std::string folder = absl::StrFormat("%s/ct-%02d", folder_, phase);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    for (int k = 0; k < rendered.labels.size.z(); ++k) {
      const absl::StatusOr<std::string> bytes = phantom::WriteCtSlice(study_, rendered, phase, k);
      if (!bytes.ok()) return bytes.status();
      absl::Status status = WriteWhole(absl::StrFormat("%s/%04d.dcm", folder, k + 1), *bytes);
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  // Returns the surfaces of a phase as an encapsulated document: an OBJ has a group for each structure.
  absl::StatusOr<std::string> ModelOf(const std::string& kind, double time, int phase) const {
    std::string model = "# Phrenic, LPS, mm\n";
    Mesh all;
    for (const phantom::Structure& structure : phantom_.structures().all) {
      const Mesh surface = phantom_.SurfaceOf(structure, static_cast<std::size_t>(phase));
      const Eigen::Index vertices = all.vertices.cols(), triangles = all.triangles.cols();
      all.vertices.conservativeResize(3, vertices + surface.vertices.cols());
      all.vertices.rightCols(surface.vertices.cols()) = kMillimetresAMetre * surface.vertices;
      all.triangles.conservativeResize(3, triangles + surface.triangles.cols());
      all.triangles.rightCols(surface.triangles.cols()) = surface.triangles.array() + static_cast<int>(vertices);
      if (kind == "stl") continue;
      absl::StrAppend(&model, "g ", structure.name, "\n");
      for (const auto& x : all.vertices.rightCols(surface.vertices.cols()).colwise()) {
        absl::StrAppendFormat(&model, "v %.4f %.4f %.4f\n", x[0], x[1], x[2]);
      }
      for (const auto& t : all.triangles.rightCols(surface.triangles.cols()).colwise()) {
        absl::StrAppendFormat(&model, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
      }
    }
    if (kind == "obj") return phantom::WriteModel(study_, phantom::ModelFormat::kObj, model, time, phase);
    const absl::StatusOr<std::string> stl = meshio::WriteStl(all);
    if (!stl.ok()) return stl.status();
    return phantom::WriteModel(study_, phantom::ModelFormat::kStl, *stl, time, phase);
  }

  absl::Status WriteReport(double spacing_mm, nlohmann::json phases) {
    nlohmann::json labels = nlohmann::json::object(), hounsfield = nlohmann::json::object();
    for (const phantom::Structure& structure : phantom_.structures().all) {
      labels[structure.name] = structure.number;
      hounsfield[structure.name] = structure.tissue == fluoroscopy::Tissue::kLung
                                       ? std::round(phantom::LungHounsfield(1))
                                       : std::round(phantom::HounsfieldOf(structure.tissue));
    }
    report_ = {{"scene", run_.model->scene.name()},
               {"preset", options_.preset},
               {"breath_length", run_.parameters.breath_length()},
               {"spacing_mm", spacing_mm},
               {"labels", labels},
               {"left_out_because_open", phantom_.structures().open},
               {"moved_with_their_surfaces_without_tissue", phantom_.without_tissue()},
               {"phases", std::move(phases)}};
    if (options_.ct) {
      report_["hounsfield_at_rest"] = hounsfield;
      report_["texture"] = options_.texture;
    }
    if (options_.field) {
      report_["field"] =
          "mm, NIfTI intent 1007, components in LPS as ITK and ANTs read it: x + u(x) is where the tissue that is at x "
          "in phase 0 is in this phase; 0 outside the labels of phase 0, where it is not defined";
    }
    return Write("report.json", report_.dump(1) + "\n");
  }

  const Context& context_;
  const BreathOptions& options_;
  const BreathRun& run_;
  BreathingPhantom& phantom_;
  std::string folder_;
  phantom::DicomStudy study_;
  nlohmann::json report_;
};

// Prints for each phase the time and the volumes of lungs and diaphragm.
void PrintPhases(const nlohmann::json& report) {
  std::vector<std::string> lungs;
  for (const auto& [name, number] : report["labels"].items()) {
    if (name.find("lung") != std::string::npos) lungs.push_back(name);
  }
  std::vector<std::string> head = {"phase", "time s"};
  for (const std::string& lung : lungs) head.push_back(lung + " ml");
  Table table(head);
  int phase = 0;
  for (const nlohmann::json& each : report["phases"]) {
    std::vector<std::string> row = {absl::StrCat(phase++), absl::StrFormat("%.3f", each["time"].get<double>())};
    for (const std::string& lung : lungs) {
      row.push_back(absl::StrFormat("%.0f", each["structures"][lung]["surface_ml"].get<double>()));
    }
    table.Add(row);
  }
  table.Print(std::cout);
}

absl::Status MakeBreath(const Context& context, const BreathOptions& options, double spacing_mm,
                        const std::string& out) {
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (!std::filesystem::is_directory(out, error)) {
    return absl::InvalidArgumentError(
        absl::StrCat("--out ", out, ": with a scene it is a folder, which cannot be made"));
  }
  const absl::StatusOr<BreathRun> run = RunBreath(context, options);
  if (!run.ok()) return run.status();
  absl::StatusOr<BreathingPhantom> phantom = BreathingPhantom::Make(
      *run->model, run->phases, {spacing_mm, options.ct || Wants(options, "ct"), options.field, options.texture});
  if (!phantom.ok()) return phantom.status();
  Writer writer(context, options, *run, *phantom, out);
  if (absl::Status status = writer.WriteAll(spacing_mm); !status.ok()) return status;
  if (context.json()) {
    PrintJson(writer.report());
  } else {
    PrintPhases(writer.report());
    std::cout << absl::StrFormat("%s: %d phases, %d structures, report.json\n", out, options.phases,
                                 phantom->structures().all.size());
  }
  return absl::OkStatus();
}

}  // namespace

int WriteBreath(const Context& context, const BreathOptions& options, double spacing_mm, const std::string& out) {
  const absl::Status status = MakeBreath(context, options, spacing_mm, out);
  return status.ok() ? kOk : Fail(context, service::ToGrpc(status));
}

}  // namespace phrenic::client
