// What a label volume shows: its labels, what they mean, and what of a thorax is missing.
#ifndef PHRENIC_SERVER_SESSION_PATIENT_LABEL_TABLE_H_
#define PHRENIC_SERVER_SESSION_PATIENT_LABEL_TABLE_H_

#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/patients.pb.h"
#include "server/imaging/label_volume.h"

namespace phrenic::session {

// Returns the label map with meanings that segmentations of other programs have: "lung_left", "lung_right", "ribs" (all
// of them in one label) and "diaphragm", of number 0. Pure function, thread-safe.
v1::LabelMap LabelChoices(const v1::LabelMap& map);

// Returns the meanings of the volume's labels. If the volume names its labels, names count and numbers do not
// (imaging::Resolve): no meaning for a name that is unknown. Otherwise numbers of `map` count. `remarks` gets a
// sentence if the volume has names and none is known. Pure function, thread-safe.
v1::LabelMap ProposeLabels(const imaging::LabelVolume& volume, const v1::LabelMap& map,
                           std::vector<std::string>& remarks);

// Returns the table of a volume, with its proposed meanings. All fields are set but the format. INVALID_ARGUMENT for a
// volume of more than 1,000 labels, which are grey values. Pure function, thread-safe.
absl::StatusOr<v1::InspectLabelsResponse> DescribeLabels(const imaging::LabelVolume& volume, const v1::LabelMap& map);

// Prepares a volume for imaging::MakePatient with the meanings that a caller gives by number, in `labels`: removes its
// names, so that numbers count, and gives labels of one meaning one number, which is the only one that is returned.
// INVALID_ARGUMENT "labels[3]: ..." for a number that is named twice, a name that is empty or has other characters than
// letters, digits, "_", "-" and spaces, and for a meaning without anatomy or organ. Thread-safe.
absl::StatusOr<v1::LabelMap> ApplyLabels(const google::protobuf::RepeatedPtrField<v1::LabelMeaning>& labels,
                                         imaging::LabelVolume& volume);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PATIENT_LABEL_TABLE_H_
