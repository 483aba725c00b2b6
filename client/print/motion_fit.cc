#include "client/print/motion_fit.h"

#include <cmath>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/print/table.h"

namespace phrenic::client {
namespace {

using nlohmann::json;

constexpr const char* kSides[] = {"right", "left"};

// A length [m] in mm.
std::string Mm(double metres) { return absl::StrFormat("%.2f", 1000 * metres); }
// The same as a number of JSON, of six digits behind the point.
double RoundedMm(double metres) { return std::round(metres * 1e9) / 1e6; }

json ErrorJson(const fit::ErrorSummary& error) {
  return {{"mean_mm", RoundedMm(error.mean)}, {"p95_mm", RoundedMm(error.p95)}};
}

json ParametersJson(const fit::MotionFit& fit) {
  json parameters = json::array();
  for (const fit::FittedNumber& each : fit.parameters) {
    parameters.push_back({{"name", each.name},
                          {"what", each.what},
                          {"unit", "mm"},
                          {"value", RoundedMm(each.value)},
                          {"standard_error", RoundedMm(each.standard_error)},
                          {"spread_between_people", RoundedMm(each.spread)},
                          {"determined", each.determined}});
  }
  return parameters;
}

json CorrelationJson(const Eigen::MatrixXd& correlation) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < correlation.rows(); ++i) {
    json row = json::array();
    for (Eigen::Index j = 0; j < correlation.cols(); ++j) row.push_back(std::round(1e4 * correlation(i, j)) / 1e4);
    rows.push_back(row);
  }
  return rows;
}

json BaselinesJson(const fit::MotionFit& fit) {
  json baselines = json::array();
  for (const fit::Baseline& each : fit.baselines) {
    json baseline = ErrorJson(each.held_out);
    baseline["name"] = each.name;
    baseline["numbers"] = each.numbers;
    baselines.push_back(baseline);
  }
  return baselines;
}

json RegionsJson(const std::vector<fit::RegionError>& regions) {
  json list = json::array();
  for (const fit::RegionError& each : regions) {
    json region = ErrorJson(each.error);
    region["name"] = each.name;
    region["points"] = each.points;
    region["motion_mm"] = RoundedMm(each.motion);
    list.push_back(region);
  }
  return list;
}

void PrintFittedNumbers(const fit::MotionFit& fit) {
  Table table({"number", "mm", "standard error", "between people", "determined", "what"});
  for (const fit::FittedNumber& each : fit.parameters) {
    table.Add({each.name, Mm(each.value), Mm(each.standard_error), Mm(each.spread), each.determined ? "yes" : "NO",
               each.what});
  }
  table.Print(std::cout);
}

// Names the pair of numbers with the largest correlation.
void PrintStrongestCorrelation(const fit::MotionFit& fit) {
  Eigen::MatrixXd off = fit.correlation.cwiseAbs();
  off.diagonal().setZero();
  Eigen::Index i = 0, j = 0;
  off.maxCoeff(&i, &j);
  std::cout << absl::StrFormat("strongest correlation: %.2f, %s with %s\n", fit.correlation(i, j),
                               fit.parameters[static_cast<size_t>(i)].name,
                               fit.parameters[static_cast<size_t>(j)].name);
}

void PrintRegions(const fit::MotionFit& fit) {
  Table regions({"region", "points", "motion mm", "mean mm", "p95 mm"});
  for (const fit::RegionError& each : fit.regions) {
    regions.Add({each.name, absl::StrCat(each.points), Mm(each.motion), Mm(each.error.mean), Mm(each.error.p95)});
  }
  regions.Print(std::cout);
}

Table RegistrationTable(const fit::RegisteredLungs& registered) {
  Table table({"lung", "points", "scale x", "scale y", "scale z", "shift x mm", "shift y mm", "shift z mm", "outside %",
               "farthest mm"});
  for (int side = 0; side < 2; ++side) {
    const fit::Registration& lung = registered.lungs[side];
    table.Add({kSides[side], absl::StrCat(registered.points[side]), absl::StrFormat("%.3f", lung.scale.x()),
               absl::StrFormat("%.3f", lung.scale.y()), absl::StrFormat("%.3f", lung.scale.z()), Mm(lung.shift.x()),
               Mm(lung.shift.y()), Mm(lung.shift.z()), absl::StrFormat("%.1f", 100 * lung.outside), Mm(lung.farthest)});
  }
  return table;
}

Table StudyTable(const fit::MotionStudy& study) {
  std::vector<std::string> header = {"person", "pairs", "descent mm"};
  for (const fit::Baseline& each : study.people.front().fit.baselines) header.push_back(each.name);
  header.insert(header.end(), {"mean mm", "p95 mm", "from one number", "its p95"});
  Table table(header);
  std::vector<fit::ErrorSummary> own, one;
  std::vector<std::vector<fit::ErrorSummary>> plain(study.people.front().fit.baselines.size());
  for (const fit::StudiedPerson& person : study.people) {
    std::vector<std::string> row = {person.name, absl::StrCat(person.pairs), Mm(person.fit.descent)};
    for (size_t i = 0; i < plain.size(); ++i) {
      plain[i].push_back(person.fit.baselines[i].held_out);
      row.push_back(Mm(plain[i].back().mean));
    }
    own.push_back(person.fit.held_out);
    if (person.from_one_number) one.push_back(*person.from_one_number);
    row.insert(row.end(), {Mm(own.back().mean), Mm(own.back().p95)});
    row.insert(row.end(),
               {person.from_one_number ? Mm(one.back().mean) : "-", person.from_one_number ? Mm(one.back().p95) : "-"});
    table.Add(row);
  }
  std::vector<std::string> mean = {"mean", "", ""};
  for (const auto& errors : plain) mean.push_back(Mm(MeanOf(errors).mean));
  mean.insert(mean.end(), {Mm(MeanOf(own).mean), Mm(MeanOf(own).p95), one.empty() ? "-" : Mm(MeanOf(one).mean),
                           one.empty() ? "-" : Mm(MeanOf(one).p95)});
  table.Add(mean);
  return table;
}

json TogetherJson(const fit::MotionStudy& study) {
  json numbers = json::array();
  for (Eigen::Index i = 0; i < study.together.mean.size(); ++i) {
    numbers.push_back({{"name", study.people.front().fit.parameters[static_cast<size_t>(i)].name},
                       {"mean", std::round(1e4 * study.together.mean[i]) / 1e4},
                       {"spread", std::round(1e4 * study.together.spread[i]) / 1e4}});
  }
  return numbers;
}

}  // namespace

json RegistrationJson(const fit::RegisteredLungs& registered, const StructureResiduals& residuals) {
  json lungs = json::array();
  for (int side = 0; side < 2; ++side) {
    const fit::Registration& lung = registered.lungs[side];
    lungs.push_back({{"lung", kSides[side]},
                     {"points", registered.points[side]},
                     {"scale", {lung.scale.x(), lung.scale.y(), lung.scale.z()}},
                     {"shift_mm", {RoundedMm(lung.shift.x()), RoundedMm(lung.shift.y()), RoundedMm(lung.shift.z())}},
                     {"outside", lung.outside},
                     {"farthest_mm", RoundedMm(lung.farthest)}});
  }
  json result = {{"gap_x_mm", RoundedMm(registered.gap)}, {"lungs", lungs}, {"doubts", registered.doubts}};
  for (size_t i = 0; i < residuals.scaled.size(); ++i) {
    const fit::StructureResidual &each = residuals.scaled[i], &bent = residuals.bent[i];
    result["structures"].push_back({{"name", each.name},
                                    {"shaped_by", each.shaped},
                                    {"points", each.points},
                                    {"mean_mm", RoundedMm(each.mean)},
                                    {"p95_mm", RoundedMm(each.p95)},
                                    {"bent_mean_mm", RoundedMm(bent.mean)},
                                    {"bent_p95_mm", RoundedMm(bent.p95)}});
  }
  if (!residuals.scaled.empty()) {
    for (int side = 0; side < 2; ++side) result["lungs"][side]["bent_by_mm"] = RoundedMm(residuals.most[side]);
  }
  return result;
}

void PrintStructures(const StructureResiduals& residuals) {
  if (residuals.scaled.empty()) return;
  Table table({"structure", "points", "scaled: mean mm", "p95 mm", "bent: mean mm", "p95 mm", "of the person"});
  for (size_t i = 0; i < residuals.scaled.size(); ++i) {
    const fit::StructureResidual &each = residuals.scaled[i], &bent = residuals.bent[i];
    table.Add({each.name, absl::StrCat(each.points), Mm(each.mean), Mm(each.p95), Mm(bent.mean), Mm(bent.p95),
               each.shaped ? "size, place, and the bend; fissures and grain are the template's"
                           : "nothing: it judges the lungs' bases alone"});
  }
  std::cout << "\nregistered lungs against the person's surfaces:\n";
  table.Print(std::cout);
  std::cout << absl::StrFormat("bent by at most %.1f mm (right) and %.1f (left)\n", 1000 * residuals.most[fit::kRight],
                               1000 * residuals.most[fit::kLeft]);
}

void PrintRegistration(const fit::RegisteredLungs& registered) { RegistrationTable(registered).Print(std::cout); }

void PrintRegistrationCsv(const fit::RegisteredLungs& registered) { RegistrationTable(registered).PrintCsv(std::cout); }

void PrintDoubts(const fit::RegisteredLungs& registered) {
  for (const std::string& doubt : registered.doubts) std::cerr << "phrenic: warning: " << doubt << "\n";
}

void PrintErrors(const fit::MotionFit& fit) {
  Table models({"model", "numbers", "mean mm", "p95 mm"});
  for (const fit::Baseline& each : fit.baselines) {
    models.Add({each.name, absl::StrCat(each.numbers), Mm(each.held_out.mean), Mm(each.held_out.p95)});
  }
  models.Add(
      {"elastic lungs that slide", absl::StrCat(fit.parameters.size()), Mm(fit.held_out.mean), Mm(fit.held_out.p95)});
  if (fit.assimilated) {
    models.Add({"with the smallest elastic deformation through the fitting points", "-", Mm(fit.assimilated->mean),
                Mm(fit.assimilated->p95)});
  }
  models.Print(std::cout);
}

json FitJson(const fit::MotionFit& fit, const fit::FitOptions& options) {
  json result = {{"numbers", options.numbers},
                 {"split", options.split},
                 {"fitting_points", fit.halves.fitting.size()},
                 {"held_out_points", fit.halves.held_out.size()},
                 {"held_out_mean_mm", RoundedMm(fit.held_out.mean)},
                 {"held_out_p95_mm", RoundedMm(fit.held_out.p95)},
                 {"fitting_mean_mm", RoundedMm(fit.fitting.mean)},
                 {"baselines", BaselinesJson(fit)},
                 {"parameters", ParametersJson(fit)},
                 {"correlation", CorrelationJson(fit.correlation)},
                 {"regions", RegionsJson(fit.regions)},
                 {"descent_mm", RoundedMm(fit.descent)},
                 {"volume_change_l", std::round(1e7 * fit.volume) / 1e4},
                 {"registration", RegistrationJson(fit.registered)}};
  if (fit.assimilated) result["assimilated"] = ErrorJson(*fit.assimilated);
  return result;
}

void PrintFit(const fit::MotionFit& fit, const fit::FitOptions& options) {
  PrintRegistration(fit.registered);
  PrintFittedNumbers(fit);
  PrintStrongestCorrelation(fit);
  std::cout << absl::StrFormat("descent of the base %s mm; the lungs gain %.2f l\n\n", Mm(fit.descent),
                               1000 * fit.volume);
  PrintErrors(fit);
  PrintRegions(fit);
  std::cout << absl::StrFormat("held out: %d of %d landmarks (split %d), mean %s mm, p95 %s mm; fitting half %s mm\n",
                               fit.halves.held_out.size(), fit.exhale.cols(), options.split, Mm(fit.held_out.mean),
                               Mm(fit.held_out.p95), Mm(fit.fitting.mean));
}

void PrintFitCsv(const fit::MotionFit& fit) {
  Table rows({"kind", "name", "numbers", "points", "value", "standard_error", "spread", "mean", "p95"});
  for (const fit::FittedNumber& each : fit.parameters) {
    rows.Add({"parameter", each.name, "", "", Mm(each.value), Mm(each.standard_error), Mm(each.spread), "", ""});
  }
  for (const fit::Baseline& each : fit.baselines) {
    rows.Add({"baseline", each.name, absl::StrCat(each.numbers), "", "", "", "", Mm(each.held_out.mean),
              Mm(each.held_out.p95)});
  }
  for (const fit::RegionError& each : fit.regions) {
    rows.Add({"region", each.name, "", absl::StrCat(each.points), "", "", "", Mm(each.error.mean), Mm(each.error.p95)});
  }
  const auto held_out = static_cast<int>(fit.halves.held_out.size());
  rows.Add({"fit", "held out", absl::StrCat(fit.parameters.size()), absl::StrCat(held_out), "", "", "",
            Mm(fit.held_out.mean), Mm(fit.held_out.p95)});
  if (fit.assimilated) {
    rows.Add({"assimilated", "held out", "", absl::StrCat(held_out), "", "", "", Mm(fit.assimilated->mean),
              Mm(fit.assimilated->p95)});
  }
  rows.PrintCsv(std::cout);
}

json ExpectedJson(const Expected& expected) {
  json numbers = json::array(), regions = json::array();
  for (size_t i = 0; i < expected.amplitudes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    numbers.push_back({{"name", expected.amplitudes[i].Name()},
                       {"unit", "mm"},
                       {"value", RoundedMm(expected.prediction.amplitudes[at])},
                       {"spread", RoundedMm(expected.prediction.spread[at])}});
  }
  for (const fit::RegionError& each : expected.regions) {
    regions.push_back({{"name", each.name},
                       {"points", each.points},
                       {"motion_mm", RoundedMm(each.motion)},
                       {"spread_mm", RoundedMm(each.error.mean)}});
  }
  const fit::Prediction& p = expected.prediction;
  return {{"descent_mm", RoundedMm(p.descent)},
          {"tidal_volume_l", std::round(1e7 * p.volume) / 1e4},
          {"tidal_volume_spread_l", std::round(1e7 * p.volume_spread) / 1e4},
          {"expected_error_mm", RoundedMm(fit::kErrorPerDescent * p.descent)},
          {"people", expected.people},
          {"parameters", numbers},
          {"regions", regions}};
}

void PrintExpected(const Expected& expected) {
  const fit::Prediction& p = expected.prediction;
  Table numbers({"number", "mm", "between people"});
  for (size_t i = 0; i < expected.amplitudes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    numbers.Add({expected.amplitudes[i].Name(), Mm(p.amplitudes[at]), Mm(p.spread[at])});
  }
  numbers.Print(std::cout);
  Table regions({"region", "points", "motion mm", "between people"});
  for (const fit::RegionError& each : expected.regions) {
    regions.Add({each.name, absl::StrCat(each.points), Mm(each.motion), Mm(each.error.mean)});
  }
  regions.Print(std::cout);
  std::cout << absl::StrFormat(
      "descent of the base %s mm; the lungs gain %.2f +- %.2f l\nexpected for a person of whom nothing else is known; "
      "%d people predicted so were off by %s mm for this descent in the mean\n",
      Mm(p.descent), 1000 * p.volume, 1000 * p.volume_spread, expected.people, Mm(fit::kErrorPerDescent * p.descent));
}

void PrintExpectedCsv(const Expected& expected) {
  Table rows({"kind", "name", "points", "value", "spread"});
  for (size_t i = 0; i < expected.amplitudes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    rows.Add({"parameter", expected.amplitudes[i].Name(), "", Mm(expected.prediction.amplitudes[at]),
              Mm(expected.prediction.spread[at])});
  }
  for (const fit::RegionError& each : expected.regions) {
    rows.Add({"region", each.name, absl::StrCat(each.points), Mm(each.motion), Mm(each.error.mean)});
  }
  rows.PrintCsv(std::cout);
}

json StudyJson(const fit::MotionStudy& study) {
  json people = json::array();
  std::vector<fit::ErrorSummary> own, one;
  fit::FitOptions options;
  options.numbers = study.numbers;
  for (const fit::StudiedPerson& person : study.people) {
    json each = FitJson(person.fit, options);
    each["person"] = person.name;
    own.push_back(person.fit.held_out);
    if (person.from_one_number) {
      one.push_back(*person.from_one_number);
      each["from_one_number"] = ErrorJson(one.back());
    }
    people.push_back(each);
  }
  json result = {{"numbers", study.numbers}, {"cases", people}, {"people", TogetherJson(study)}};
  result["held_out_mean_mm"] = RoundedMm(MeanOf(own).mean);
  result["held_out_p95_mm"] = RoundedMm(MeanOf(own).p95);
  if (!one.empty()) result["from_one_number"] = ErrorJson(MeanOf(one));
  return result;
}

void PrintMotionStudy(const fit::MotionStudy& study) {
  StudyTable(study).Print(std::cout);
  std::cout << "\nper mm of descent, of all people together:\n";
  Table numbers({"number", "mean", "between people"});
  for (Eigen::Index i = 0; i < study.together.mean.size(); ++i) {
    numbers.Add({study.people.front().fit.parameters[static_cast<size_t>(i)].name,
                 absl::StrFormat("%.3f", study.together.mean[i]), absl::StrFormat("%.3f", study.together.spread[i])});
  }
  numbers.Print(std::cout);
}

void PrintMotionStudyCsv(const fit::MotionStudy& study) { StudyTable(study).PrintCsv(std::cout); }

}  // namespace phrenic::client
