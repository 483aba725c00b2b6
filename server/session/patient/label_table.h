// What a label volume shows: its labels, what they mean, and what of a thorax is missing.
#ifndef PHRENIC_SERVER_SESSION_PATIENT_LABEL_TABLE_H_
#define PHRENIC_SERVER_SESSION_PATIENT_LABEL_TABLE_H_

#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/patients.pb.h"
#include "server/imaging/labels/label_input.h"

namespace phrenic::session {

// Returns the table of a volume, with its proposed meanings. All fields are set but the format. INVALID_ARGUMENT for a
// volume of more than 1,000 labels, which are grey values. `names` has what labels can be named
// (imaging::WithCommonNames). Pure function, thread-safe.
absl::StatusOr<v1::InspectLabelsResponse> DescribeLabels(const imaging::LabelInput& input, const v1::LabelMap& names);

// Prepares a volume for imaging::MakePatient with the meanings that a caller gives by number, in `labels`: removes its
// names, so that numbers count, and gives labels of one meaning one number, which is the only one that is returned.
// INVALID_ARGUMENT "labels[3]: ..." for a number that is named twice, a name that is empty or has other characters than
// letters, digits, "_", "-" and spaces, and for a meaning without anatomy or organ. Thread-safe.
absl::StatusOr<v1::LabelMap> ApplyLabels(const google::protobuf::RepeatedPtrField<v1::LabelMeaning>& labels,
                                         imaging::LabelVolume& volume);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PATIENT_LABEL_TABLE_H_
