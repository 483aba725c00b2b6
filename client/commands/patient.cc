// `phrenic patient`: a label volume becomes a thorax that breathes; `phrenic phantom`: a label volume of a known body.
#include "server/imaging/patient.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/commands/commands.h"
#include "client/files/patient_files.h"
#include "client/files/whole_file.h"
#include "client/print/table.h"
#include "client/terminal/progress.h"
#include "server/imaging/gzip.h"
#include "server/imaging/label_map.h"
#include "server/imaging/nifti.h"
#include "server/imaging/phantom.h"
#include "server/schema/id.h"
#include "server/schema/places.h"
#include "server/schema/schema.h"

namespace phrenic::client {
namespace {

absl::StatusOr<v1::Scene> ReadPattern() {
  const std::string path = Installed("scenes", PHRENIC_SCENES_DIR) + "/thorax.textproto";
  std::ifstream file(path);
  if (!file)
    return absl::NotFoundError(absl::StrCat("cannot read the scene ", path, ", which patients' scenes follow"));
  std::stringstream text;
  text << file.rdbuf();
  return schema::ParseScene(path, text.str());
}

absl::StatusOr<imaging::Patient> Make(const PatientOptions& options) {
  const absl::StatusOr<v1::LabelMap> map = imaging::ReadLabelMap(options.labels);
  if (!map.ok()) return map.status();
  const absl::StatusOr<v1::Scene> pattern = ReadPattern();
  if (!pattern.ok()) return pattern.status();
  Progress bar("making " + options.name, 1);
  bar.Say("reading");
  bar.Update(0);
  const absl::StatusOr<imaging::LabelVolume> volume = imaging::ReadNifti(options.volume);
  if (!volume.ok()) return volume.status();
  const imaging::PatientOptions made = {options.name, options.edge_length, {options.vertices, options.tendon_share}};
  return imaging::MakePatient(*volume, *map, *pattern, made, [&](double done, std::string_view doing) {
    bar.Say(std::string(doing));
    bar.Update(done);
    return true;
  });
}

void PrintDiaphragm(const v1::DerivedDiaphragm& diaphragm) {
  std::cout << absl::StrFormat(
      "diaphragm: %d vertices, %.0f cm2 a layer; of it between organs %.0f %%, under one organ %.0f %%, on bone %.0f "
      "%%, in a label of its own %.0f %%, extrapolated %.0f %%\n",
      diaphragm.vertices(), diaphragm.area_cm2(), 100 * diaphragm.between_organs(), 100 * diaphragm.beside_one_organ(),
      100 * diaphragm.on_bone(), 100 * diaphragm.labelled(), 100 * diaphragm.extrapolated());
  for (const v1::ExtrapolatedSector& sector : diaphragm.sectors()) {
    std::cout << absl::StrFormat("  extrapolated: %s, %.0f %% of it\n", sector.where(), 100 * sector.share());
  }
}

void Print(const v1::PatientReport& report) {
  Table surfaces({"surface", "vertices", "ml", "label ml"});
  for (const v1::PatientSurface& surface : report.surfaces()) {
    surfaces.Add({surface.body(), absl::StrCat(surface.vertices()), absl::StrFormat("%.1f", surface.volume_ml()),
                  absl::StrFormat("%.1f", surface.label_volume_ml())});
  }
  surfaces.Print(std::cout);
  Table ribs({"rib", "neck mm", "axis to midplane deg", "drop deg"});
  for (const v1::PatientRib& rib : report.ribs()) {
    ribs.Add({rib.body(), absl::StrFormat("%.1f", rib.neck_mm()), absl::StrFormat("%.0f", rib.axis_degrees()),
              absl::StrFormat("%.0f", rib.drop_degrees())});
  }
  ribs.Print(std::cout);
  PrintDiaphragm(report.diaphragm());
  for (const std::string& fallback : report.fallbacks()) std::cout << "fall-back: " << fallback << "\n";
}

// Becomes the server that plays the patient; comes back only where that cannot be.
int Serve(const PatientOptions& options) {
  std::error_code error;
  const std::string server =
      (std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "phrenicd").string();
  execl(server.c_str(), "phrenicd", "--data", options.out.c_str(), "--start", options.name.c_str(), "--web",
        options.web.c_str(), "--store", "none", nullptr);
  return Fail(absl::NotFoundError(absl::StrCat("cannot start ", server, ": build it, or leave out --serve")));
}

}  // namespace

int MakePatient(const Context& context, const PatientOptions& options) {
  if (absl::Status status = schema::CheckId("--name", options.name); !status.ok()) return Fail(status);
  const absl::StatusOr<imaging::Patient> patient = Make(options);
  if (!patient.ok()) return Fail(patient.status());
  if (absl::Status status = WritePatient(options.out, *patient); !status.ok()) return Fail(status);
  if (context.json()) {
    std::cout << Json(patient->report) << "\n";
  } else {
    Print(patient->report);
  }
  if (options.serve) return Serve(options);
  std::cerr << "wrote " << SceneFile(options.out, options.name) << "; now\n"
            << "  phrenic run " << SceneFile(options.out, options.name) << " --data " << options.out << "\n"
            << "  phrenicd --data " << options.out << " --start " << options.name << "\n";
  return kOk;
}

int MakePhantom(const Context&, const PhantomOptions& options) {
  const absl::StatusOr<imaging::PhantomBody> body = imaging::FindPhantomBody(options.body);
  if (!body.ok()) return Fail(body.status());
  const absl::StatusOr<v1::LabelMap> map = imaging::ReadLabelMap(options.labels);
  if (!map.ok()) return Fail(map.status());
  const absl::StatusOr<imaging::LabelVolume> volume =
      imaging::MakePhantom(*body, {options.voxel, options.noise, options.holes, options.seed}, *map);
  if (!volume.ok()) return Fail(volume.status());
  std::string bytes = imaging::WriteNifti(*volume);
  if (absl::EndsWith(options.out, ".gz")) bytes = imaging::Deflate(bytes);
  if (absl::Status status = WriteWhole(options.out, bytes); !status.ok()) return Fail(status);
  std::cout << absl::StrFormat("%s: %d x %d x %d voxels of %g mm\n", options.out, volume->size.x(), volume->size.y(),
                               volume->size.z(), options.voxel);
  return kOk;
}

}  // namespace phrenic::client
