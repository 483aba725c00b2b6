// The shell commands that reproduce evidence.
#ifndef PHRENIC_CLIENT_CREDIBILITY_COMMAND_TEXT_H_
#define PHRENIC_CLIENT_CREDIBILITY_COMMAND_TEXT_H_

#include <google/protobuf/message.h>

#include <string>

#include "phrenic/v1/parameters.pb.h"

namespace phrenic::client {

// Returns "phrenic study KIND SCENE --preset P --set elasticity=2 --vary elasticity:1:2 --measure 'volume:mean'
// --samples 64". `scene` is that of the command line, with --resolution if it has one. `study` is the message of the
// kind; fields that are not set are left out.
std::string StudyCommand(const std::string& kind, const std::string& scene, const std::string& preset,
                         const v1::Parameters& parameters, const google::protobuf::Message& study);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CREDIBILITY_COMMAND_TEXT_H_
