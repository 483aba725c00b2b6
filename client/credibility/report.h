// The report of a model's credibility for one context of use: fifteen sections with verdicts.
#ifndef PHRENIC_CLIENT_CREDIBILITY_REPORT_H_
#define PHRENIC_CLIENT_CREDIBILITY_REPORT_H_

#include <vector>

#include "absl/status/statusor.h"
#include "client/credibility/evidence.h"
#include "phrenic/v1/credibility.pb.h"

namespace phrenic::client {

// Returns the model risk by the sum of the levels of influence and consequence; unspecified if one of them is.
v1::RiskLevel ModelRiskOf(const v1::CredibilityContext& context);

// Returns the sections that a model risk demands; all but MISSING at high or unspecified risk.
std::vector<v1::CredibilitySection> RequiredAt(v1::RiskLevel risk);

// Judges the evidence by the context's criteria. A section is met if each of its criteria holds and there is one,
// partly met if some do, else not shown. Sections 1 to 3 and 13 to 15 have criteria of their own, which the report
// lists beside the context's. A criterion whose number has not been made has no evidence and does not hold.
// INVALID_ARGUMENT with the known names, if a criterion names one that no kind of evidence has.
absl::StatusOr<v1::CredibilityReport> MakeCredibilityReport(const v1::CredibilityContext& context,
                                                            const Evidence& evidence, const EvidenceCommands& commands);

// "in vivo validation"
const char* TitleOf(v1::CredibilitySection section);
// "met", "partly", "NOT SHOWN"
const char* TextOf(v1::SectionVerdict verdict);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CREDIBILITY_REPORT_H_
