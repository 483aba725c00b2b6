// The file of a context of use: phrenic.v1.CredibilityContext as text.
#ifndef PHRENIC_CLIENT_CREDIBILITY_CONTEXT_FILE_H_
#define PHRENIC_CLIENT_CREDIBILITY_CONTEXT_FILE_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/credibility.pb.h"

namespace phrenic::client {

// Parses and validates the text; gives the studies the context's inputs and outputs where they have none of their own.
// INVALID_ARGUMENT names the file, and the line or the field: no title or question; a criterion without bounds or
// section; two numbers of one name; a study without inputs.
absl::StatusOr<v1::CredibilityContext> ParseCredibilityContext(const std::string& file, const std::string& text);

// Returns the numbers of the context's evidence: given, or read from JSON files beside `file` or at `files`, by name.
// NOT_FOUND and INVALID_ARGUMENT name the file.
absl::StatusOr<std::vector<v1::NumberRow>> ReadOwnEvidence(const v1::CredibilityContext& context,
                                                           const std::string& file,
                                                           const std::map<std::string, std::string>& files);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CREDIBILITY_CONTEXT_FILE_H_
