// Inputs and outputs of a study as arguments of the command line.
#ifndef PHRENIC_CLIENT_CLI_STUDY_INPUTS_H_
#define PHRENIC_CLIENT_CLI_STUDY_INPUTS_H_

#include <CLI/CLI.hpp>
#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/uncertainty.pb.h"

namespace phrenic::client {

// Parses "NAME:LOW:HIGH" (uniform), "NAME:triangular:LOW:MODE:HIGH", "NAME:normal:MEAN:DEVIATION" or
// "NAME:lognormal:MEDIAN:FACTOR". INVALID_ARGUMENT quotes the text; the server checks the parameter and its range.
absl::StatusOr<v1::UncertainInput> ReadUncertainInput(const std::string& text);

// Parses "MEASURE:STATISTIC", or the name of a measure of a breath, which has no colon. INVALID_ARGUMENT lists the
// statistics.
absl::StatusOr<v1::StudiedOutput> ReadStudiedOutput(const std::string& text);

// Add --vary and --measure, which append to a study. Require: the lists outlive parsing.
void AddInputs(CLI::App& command, google::protobuf::RepeatedPtrField<v1::UncertainInput>* inputs);
void AddOutputs(CLI::App& command, google::protobuf::RepeatedPtrField<v1::StudiedOutput>* outputs);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_STUDY_INPUTS_H_
