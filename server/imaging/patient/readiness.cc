#include "server/imaging/patient/readiness.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "server/imaging/patient/border.h"
#include "server/imaging/patient/patient_scene.h"
#include "server/mesh/self_crossings.h"

namespace phrenic::imaging {
namespace {

using Findings = std::vector<v1::ReadinessFinding>;

constexpr auto kCare = v1::READINESS_VERDICT_USABLE_WITH_CARE, kRefuse = v1::READINESS_VERDICT_NOT_USABLE;

// A finding in the form that programs read.
struct Facts {
  v1::FindingKind kind;
  std::vector<std::string> parts = {};
  std::vector<double> values = {};
};

void Add(bool refuse, std::string what, const Facts& facts, Findings& findings) {
  v1::ReadinessFinding& finding = findings.emplace_back();
  finding.set_verdict(refuse ? kRefuse : kCare);
  finding.set_what(std::move(what));
  finding.set_kind(facts.kind);
  finding.mutable_parts()->Assign(facts.parts.begin(), facts.parts.end());
  finding.mutable_values()->Assign(facts.values.begin(), facts.values.end());
}

const char* SideWordOf(v1::Side side) { return side == v1::SIDE_RIGHT ? "right" : "left"; }

void FindCutLungs(const LabelVolume& volume, const std::vector<Part>& parts, Findings& findings) {
  constexpr double kLeast = 2, kMost = 20;  // [cm^2]
  for (const Part& part : parts) {
    if (!part.Is(v1::STRUCTURE_LUNG)) continue;
    const BorderCut cut = LargestCut(volume, part);
    if (cut.area <= kLeast) continue;
    Add(cut.area > kMost,
        absl::StrFormat(
            "%s is cut by the %s border of the volume over %.0f cm2: its volume and its base are not known; "
            "use a scan from the apices of the lungs to L3",
            part.name, cut.side, cut.area),
        {v1::FINDING_KIND_LUNG_CUT, {part.name, cut.side}, {cut.area}}, findings);
  }
}

void FindCutRibs(const LabelVolume& volume, const std::vector<Part>& parts, Findings& findings) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> cut;
  for (const Part& part : parts) {
    if (part.Is(v1::STRUCTURE_RIB) && LargestCut(volume, part).area > 0) cut.push_back(part.name);
  }
  if (cut.empty()) return;
  Add(cut.size() >= kMost,
      absl::StrFormat("the border of the volume cuts %s: their motion is that of the part that is left; "
                      "use a scan that has whole ribs",
                      absl::StrJoin(cut, ", ")),
      {v1::FINDING_KIND_RIBS_CUT, cut}, findings);
}

bool IsFilled(const v1::PatientReport& report, const std::string& name) {
  const auto& parts = report.fill().parts();
  return std::find(parts.begin(), parts.end(), name) != parts.end();
}

// A volume with filled parts is never better than usable with care.
void FindFilled(const v1::TemplateFill& fill, Findings& findings) {
  constexpr double kMostOff = 15;  // residual of the template's registration [mm]
  if (fill.parts().empty()) return;
  Add(fill.residual_mm() > kMostOff,
      absl::StrFormat(
          "not seen, but filled from the generated thorax, which fits what is seen to %.1f mm: %s; their "
          "shape is not the person's, and %.0f %% of the diaphragm rests on them; label them if the scan shows "
          "them",
          fill.residual_mm(), absl::StrJoin(fill.parts(), ", "), 100 * fill.diaphragm_share()),
      {v1::FINDING_KIND_FILLED,
       {fill.parts().begin(), fill.parts().end()},
       {fill.residual_mm(), fill.diaphragm_share()}},
      findings);
}

void FindMissingRibs(const std::vector<Part>& parts, const v1::PatientReport& report, Findings& findings) {
  constexpr int kLast = 10;  // ribs 11 and 12 float
  constexpr std::size_t kMost = 7;
  std::vector<std::string> missing, bodies;
  for (const v1::Side side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    for (int number = 1; number <= kLast; ++number) {
      const bool there = std::any_of(parts.begin(), parts.end(), [&](const Part& part) {
        return part.Is(v1::STRUCTURE_RIB) && part.anatomy.side() == side && part.anatomy.number() == number;
      });
      const std::string body = absl::StrFormat("rib-%d-%s", number, SideWordOf(side));
      if (there || IsFilled(report, body)) continue;
      missing.push_back(absl::StrFormat("%d %s", number, SideWordOf(side)));
      bodies.push_back(body);
    }
  }
  if (missing.empty()) return;
  Add(missing.size() >= kMost,
      absl::StrFormat("ribs are missing (%s): the wall, the costal margin and the axes of the cage are guessed there; "
                      "label them, or use a scan that shows them",
                      absl::StrJoin(missing, ", ")),
      {v1::FINDING_KIND_RIBS_MISSING, bodies}, findings);
}

void FindMissingOrgans(const std::vector<Part>& parts, Findings& findings) {
  const auto has = [&parts](v1::Organ organ) {
    return std::any_of(parts.begin(), parts.end(), [organ](const Part& part) { return part.organ == organ; });
  };
  const auto is_sheet = [](const Part& part) { return part.Is(v1::STRUCTURE_DIAPHRAGM); };
  if (std::any_of(parts.begin(), parts.end(), is_sheet)) return;
  std::vector<std::string> missing, organs;
  if (!has(v1::ORGAN_HEART)) missing.emplace_back("heart");
  if (!has(v1::ORGAN_LIVER)) missing.emplace_back("liver");
  if (!has(v1::ORGAN_STOMACH) && !has(v1::ORGAN_SPLEEN)) missing.emplace_back("stomach or spleen");
  if (missing.empty()) return;
  for (const std::string& one : missing) organs.push_back(absl::StrReplaceAll(one, {{" ", "-"}}));
  Add(missing.size() == 3,
      absl::StrFormat("no label for %s: the domes are guessed from the lungs alone there; label them",
                      absl::StrJoin(missing, ", ")),
      {v1::FINDING_KIND_ORGANS_MISSING, organs}, findings);
}

void FindExtrapolation(const v1::DerivedDiaphragm& sheet, Findings& findings) {
  constexpr double kLeast = 0.25, kMost = 0.5;
  if (sheet.extrapolated() <= kLeast) return;
  std::vector<std::string> sectors;
  for (const v1::ExtrapolatedSector& sector : sheet.sectors()) sectors.push_back(sector.where());
  Add(sheet.extrapolated() > kMost,
      absl::StrFormat(
          "%.0f %% of the diaphragm is extrapolated, not seen (%s); label the organs and ribs beside it, or the "
          "diaphragm itself",
          100 * sheet.extrapolated(), absl::StrJoin(sectors, "; ")),
      {v1::FINDING_KIND_EXTRAPOLATED, sectors, {sheet.extrapolated()}}, findings);
}

void FindOddAxes(const v1::PatientReport& report, Findings& findings) {
  constexpr double kNarrow = 25, kWide = 90;  // [degree]; adults have 30 to 82
  std::vector<std::string> odd, ribs;
  std::vector<double> angles;
  for (const v1::PatientRib& rib : report.ribs()) {
    if (rib.axis_degrees() >= kNarrow && rib.axis_degrees() <= kWide) continue;
    odd.push_back(absl::StrFormat("%s %.0f", rib.body(), rib.axis_degrees()));
    ribs.push_back(rib.body());
    angles.push_back(rib.axis_degrees());
  }
  if (odd.empty()) return;
  Add(4 * odd.size() >= static_cast<std::size_t>(report.ribs_size()),
      absl::StrFormat(
          "axes of ribs are at angles to the midsagittal plane that no person has [degree] (%s): these ribs "
          "would move inwards or not at all; check that their necks are in the volume "
          "and labelled, and that --edge-length is at most 6 mm",
          absl::StrJoin(odd, ", ")),
      {v1::FINDING_KIND_ODD_AXES, ribs, angles}, findings);
}

// Returns the height of the sheet's highest point with |x| in the interval [m].
double Highest(const Mesh& sheet, double from, double to) {
  double highest = -std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < sheet.vertices.cols(); ++i) {
    const double x = std::abs(sheet.vertices(0, i));
    if (x >= from && x <= to) highest = std::max(highest, sheet.vertices(2, i));
  }
  return highest;
}

void FindOddSheet(const Mesh& sheet, const v1::DerivedDiaphragm& report, Findings& findings) {
  constexpr double kMiddle = 0.2, kMostTower = 15e-3;               // of half the width; [m]
  constexpr double kSmallest = 500, kLargest = 1600, kCell = 5e-3;  // [cm^2], [m]
  constexpr int kMostCrossings = 20;
  const double half = sheet.vertices.row(0).cwiseAbs().maxCoeff();
  const double tower = Highest(sheet, 0, kMiddle * half) - Highest(sheet, kMiddle * half, half);
  if (tower > 0) {
    Add(tower > kMostTower,
        absl::StrFormat(
            "the middle of the diaphragm is %.0f mm above its domes: it was drawn up between the lungs; label "
            "the heart",
            1e3 * tower),
        {v1::FINDING_KIND_TOWER, {}, {1e3 * tower}}, findings);
  }
  if (const int crossings = SelfCrossings(sheet, kCell); crossings > 0) {
    Add(crossings >= kMostCrossings,
        absl::StrFormat("the diaphragm crosses itself at rest in %d places: it is crumpled; check that the labels "
                        "of lungs and organs do not overlap or leave gaps",
                        crossings),
        {v1::FINDING_KIND_CROSSED, {}, {static_cast<double>(crossings)}}, findings);
  }
  if (report.area_cm2() < kSmallest || report.area_cm2() > kLargest) {
    Add(false,
        absl::StrFormat("the diaphragm has %.0f cm2; adults have 700 to 1,300; check the voxels' spacing, and that the "
                        "scan shows the whole thorax of an adult",
                        report.area_cm2()),
        {v1::FINDING_KIND_ODD_AREA, {}, {report.area_cm2()}}, findings);
  }
}

}  // namespace

v1::Readiness JudgeReadiness(const LabelVolume& volume, const std::vector<Part>& parts,
                             const std::vector<PatientBody>& bodies, const v1::PatientReport& report) {
  Findings findings;
  FindCutLungs(volume, parts, findings);
  FindCutRibs(volume, parts, findings);
  FindMissingRibs(parts, report, findings);
  FindFilled(report.fill(), findings);
  FindMissingOrgans(parts, findings);
  FindExtrapolation(report.diaphragm(), findings);
  FindOddAxes(report, findings);
  const auto middle =
      std::find_if(bodies.begin(), bodies.end(), [](const PatientBody& body) { return body.name == kMiddleBody; });
  if (middle != bodies.end()) FindOddSheet(middle->mesh, report.diaphragm(), findings);
  std::stable_sort(findings.begin(), findings.end(),
                   [](const auto& a, const auto& b) { return a.verdict() > b.verdict(); });
  v1::Readiness readiness;
  readiness.set_verdict(findings.empty() ? v1::READINESS_VERDICT_READY : findings.front().verdict());
  readiness.mutable_findings()->Assign(findings.begin(), findings.end());
  return readiness;
}

}  // namespace phrenic::imaging
