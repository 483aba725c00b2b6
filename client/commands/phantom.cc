// `phrenic phantom`: writes a label volume of a synthetic body with known geometry, or the phases of a scene's breath.
#include "server/imaging/phantom.h"

#include <iostream>

#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/files/whole_file.h"
#include "client/phantom/breath.h"
#include "server/imaging/gzip.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/nifti.h"

namespace phrenic::client {
namespace {

struct PhantomOptions {
  std::string body = "adult", labels = "totalsegmentator", out;
  double voxel = 2;     // edge length [mm]
  double noise = 0.02;  // fraction of border voxels with a neighbour's label
  int holes = 40;
  unsigned seed = 1;
  BreathOptions breath;  // with a scene
};

absl::StatusOr<imaging::PhantomBody> BodyOf(const PhantomOptions& options) {
  if (options.breath.scene.physique.empty()) return imaging::FindPhantomBody(options.body);
  const absl::StatusOr<v1::Physique> physique = ReadPhysique(options.breath.scene.physique);
  if (!physique.ok()) return physique.status();
  return imaging::PhantomBodyOf(*physique);
}

int MakePhantom(const Context& context, const PhantomOptions& options) {
  if (!options.breath.scene.scene.empty()) return WriteBreath(context, options.breath, options.voxel, options.out);
  const absl::StatusOr<imaging::PhantomBody> body = BodyOf(options);
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

// Adds what needs a scene.
void AddBreath(CLI::App& command, CLI::Option* scene, BreathOptions& breath) {
  AddResolution(command, breath.scene.resolution_mm);
  AddPhysique(command, breath.scene.physique);
  AddPreset(command, breath.preset);
  AddParameters(command, breath.settings);
  command.add_option("--phases", breath.phases, "phases of one breath; 0 is the start")
      ->check(NumberIn(1, 100))
      ->capture_default_str()
      ->needs(scene);
  command.add_option("--start", breath.start, "time of phase 0 [s]; 0 is the scene at rest")
      ->check(NumberIn(0.0, 600.0))
      ->capture_default_str()
      ->needs(scene);
  command.add_flag("--ct", breath.ct, "also write volumes like a CT's [HU]")->needs(scene);
  command.add_option("--texture", breath.texture, "unevenness of the lungs' density, which moves with them, for --ct")
      ->check(NumberIn(0.0, 0.9))
      ->capture_default_str()
      ->needs(scene);
  command.add_flag("--field", breath.field, "also write the true displacement from phase 0 [mm, LPS], as ITK reads it")
      ->needs(scene);
  command.add_option("--dicom", breath.dicom, "also write DICOM: seg, ct (a series), stl, obj, or all but ct")
      ->delimiter(',')
      ->check(CLI::IsMember({"seg", "ct", "stl", "obj", "all"}).description(""))
      ->needs(scene);
  AddDataFolder(command, breath.data_dir);
}

}  // namespace

CommandFunction SetUpPhantom(CLI::App& command) {
  const auto options = std::make_shared<PhantomOptions>();
  BreathOptions& breath = options->breath;
  CLI::Option* scene = command.add_option("SCENE", breath.scene.scene,
                                          "the scene whose breath is written (without: a body in one volume)");
  command.add_option("--out", options->out, "file to write, .nii or .nii.gz; with a scene the folder")->required();
  command.add_option("--voxel,--spacing", options->voxel, "edge length of a voxel [mm]")
      ->check(NumberIn(1.0, 10.0))
      ->capture_default_str();
  AddBreath(command, scene, breath);
  CLI::Option* body = command.add_option("--body", options->body, "adult, small, tall, or flat (flat domes)");
  body->capture_default_str()->excludes(scene)->excludes(command.get_option("--physique"));
  AddLabels(command, options->labels);
  command.add_option("--noise", options->noise, "fraction of border voxels with a neighbour's label")
      ->check(NumberIn(0.0, 0.3))
      ->capture_default_str();
  command.add_option("--holes", options->holes, "number of balls of 3 mm without a label")
      ->check(NumberIn(0, 10000))
      ->capture_default_str();
  command.add_option("--seed", options->seed, "random seed of noise and holes")->capture_default_str();
  for (const char* name : {"--labels", "--noise", "--holes", "--seed"}) command.get_option(name)->excludes(scene);
  return Bind(&MakePhantom, options);
}

}  // namespace phrenic::client
