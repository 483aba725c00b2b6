// `phrenic phantom`: writes a label volume of a synthetic body with known geometry.
#include "server/imaging/phantom.h"

#include <iostream>

#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/files/whole_file.h"
#include "server/imaging/gzip.h"
#include "server/imaging/label_map.h"
#include "server/imaging/nifti.h"

namespace phrenic::client {
namespace {

struct PhantomOptions {
  std::string body = "adult", labels = "totalsegmentator", out;
  double voxel = 2;     // edge length [mm]
  double noise = 0.02;  // fraction of border voxels with a neighbour's label
  int holes = 40;
  unsigned seed = 1;
};

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

}  // namespace

CommandFunction SetUpPhantom(CLI::App& command) {
  const auto options = std::make_shared<PhantomOptions>();
  command.add_option("--body", options->body, "adult, small, tall, or flat (flat domes)")->capture_default_str();
  AddLabels(command, options->labels);
  command.add_option("--out", options->out, "file to write, .nii or .nii.gz")->required();
  command.add_option("--voxel", options->voxel, "edge length of a voxel [mm]")
      ->check(NumberIn(1.0, 10.0))
      ->capture_default_str();
  command.add_option("--noise", options->noise, "fraction of border voxels with a neighbour's label")
      ->check(NumberIn(0.0, 0.3))
      ->capture_default_str();
  command.add_option("--holes", options->holes, "number of balls of 3 mm without a label")
      ->check(NumberIn(0, 10000))
      ->capture_default_str();
  command.add_option("--seed", options->seed, "random seed of noise and holes")->capture_default_str();
  return Bind(&MakePhantom, options);
}

}  // namespace phrenic::client
