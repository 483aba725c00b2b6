#include "server/fit/fit_message.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace phrenic::fit {
namespace {

static_assert(std::endian::native == std::endian::little, "FitPoints are little-endian");

constexpr const char* kLungNames[] = {"right", "left"};

double Millimetres(double metres) { return 1000 * metres; }

void SetError(const ErrorSummary& error, v1::FitError& message) {
  message.set_mean_mm(Millimetres(error.mean));
  message.set_p95_mm(Millimetres(error.p95));
}

void AddParameters(const MotionFit& fit, v1::MotionFitResult& result) {
  for (const FittedNumber& each : fit.parameters) {
    v1::FittedAmplitude& parameter = *result.add_parameters();
    parameter.set_name(each.name);
    parameter.set_what(each.what);
    parameter.set_value_mm(Millimetres(each.value));
    parameter.set_standard_error_mm(Millimetres(each.standard_error));
    parameter.set_spread_between_people_mm(Millimetres(each.spread));
    parameter.set_determined(each.determined);
  }
  for (Eigen::Index i = 0; i < fit.correlation.rows(); ++i) {
    for (Eigen::Index j = 0; j < fit.correlation.cols(); ++j) result.add_correlation(fit.correlation(i, j));
  }
}

void AddErrors(const MotionFit& fit, v1::MotionFitResult& result) {
  SetError(fit.fitting, *result.mutable_fitting());
  SetError(fit.held_out, *result.mutable_held_out());
  if (fit.assimilated) SetError(*fit.assimilated, *result.mutable_assimilated());
  for (const Baseline& each : fit.baselines) {
    v1::FitBaseline& baseline = *result.add_baselines();
    baseline.set_name(each.name);
    baseline.set_numbers(each.numbers);
    baseline.set_mean_mm(Millimetres(each.held_out.mean));
    baseline.set_p95_mm(Millimetres(each.held_out.p95));
  }
  for (const RegionError& each : fit.regions) {
    v1::FitRegion& region = *result.add_regions();
    region.set_name(each.name);
    region.set_points(each.points);
    region.set_motion_mm(Millimetres(each.motion));
    region.set_mean_mm(Millimetres(each.error.mean));
    region.set_p95_mm(Millimetres(each.error.p95));
  }
}

void AddLungs(const RegisteredLungs& registered, v1::MotionFitResult& result) {
  result.set_gap_x_mm(Millimetres(registered.gap));
  for (const std::string& doubt : registered.doubts) result.add_doubts(doubt);
  for (const Side side : {kRight, kLeft}) {
    const Registration& registration = registered.lungs[side];
    v1::RegisteredLung& lung = *result.add_lungs();
    lung.set_lung(kLungNames[side]);
    lung.set_points(registered.points[side]);
    lung.set_scale_x(registration.scale.x());
    lung.set_scale_y(registration.scale.y());
    lung.set_scale_z(registration.scale.z());
    lung.set_shift_x_mm(Millimetres(registration.shift.x()));
    lung.set_shift_y_mm(Millimetres(registration.shift.y()));
    lung.set_shift_z_mm(Millimetres(registration.shift.z()));
    lung.set_outside(registration.outside);
    lung.set_farthest_mm(Millimetres(registration.farthest));
  }
}

void SetQuantity(const FittedQuantity& quantity, v1::FittedNumber& message) {
  const double unit = quantity.number.per_unit;
  message.set_name(quantity.number.name);
  message.set_what(quantity.number.what);
  message.set_unit(quantity.number.unit);
  message.set_value(quantity.value / unit);
  message.set_standard_error(quantity.standard_error / unit);
  message.set_prior(quantity.number.mean / unit);
  message.set_prior_sd(quantity.number.sd / unit);
  message.set_determined(quantity.determined);
  if (!std::isfinite(quantity.number.low)) return;
  message.set_low(quantity.number.low / unit);
  message.set_high(quantity.number.high / unit);
  message.set_at_bound(quantity.at_bound);
}

void SetKind(const KindReport& report, v1::FitKind& message) {
  const double unit = report.kind.per_unit;
  message.set_kind(report.kind.kind);
  message.set_source(report.kind.source);
  message.set_unit(report.kind.unit);
  message.set_error(report.kind.sd / unit);
  message.set_fitting(report.fitting);
  message.set_held_out(report.held_out);
  message.set_rms_still(report.still / unit);
  message.set_rms_before(report.before / unit);
  message.set_rms_after(report.after / unit);
  message.set_rms_held_out_still(report.held_out_still / unit);
  message.set_rms_held_out(report.held_out_after / unit);
}

std::string BytesOf(const Points& points) {
  return {reinterpret_cast<const char*>(points.data()), sizeof(double) * static_cast<std::size_t>(points.size())};
}

}  // namespace

v1::MotionFitResult FitMessage(const MotionFit& fit, const FitOptions& options) {
  v1::MotionFitResult result;
  result.set_modes(options.numbers);
  result.set_split(static_cast<std::int64_t>(options.split));
  AddErrors(fit, result);
  AddParameters(fit, result);
  result.set_descent_mm(Millimetres(fit.descent));
  result.set_volume_change_l(1000 * fit.volume);
  AddLungs(fit.registered, result);
  v1::FitPoints& points = *result.mutable_points();
  points.set_exhale(BytesOf(fit.exhale));
  points.set_motion(BytesOf(fit.motion));
  points.set_predicted(BytesOf(fit.predicted));
  points.mutable_held_out()->Add(fit.halves.held_out.begin(), fit.halves.held_out.end());
  return result;
}

v1::MotionFitResult JointFitMessage(const JointFit& fit, const FitOptions& options) {
  v1::MotionFitResult result = FitMessage(fit.motion, options);
  for (const FittedQuantity& each : fit.numbers) SetQuantity(each, *result.add_numbers());
  for (const FittedQuantity& each : fit.derived) SetQuantity(each, *result.add_derived());
  for (const KindReport& each : fit.kinds) SetKind(each, *result.add_kinds());
  result.set_own_lungs(fit.own_lungs);
  return result;
}

v1::MotionOfPerson PersonMessage(const StudiedPerson& person, const FitOptions& options) {
  v1::MotionOfPerson message;
  message.set_name(person.name);
  message.set_pairs(person.pairs);
  *message.mutable_fit() = FitMessage(person.fit, options);
  message.mutable_fit()->clear_points();
  message.mutable_fit()->clear_correlation();
  if (person.from_one_number) SetError(*person.from_one_number, *message.mutable_from_one_number());
  return message;
}

v1::MotionOfPeople PeopleMessage(const MotionStudy& study) {
  v1::MotionOfPeople message;
  std::vector<ErrorSummary> own, one;
  for (const StudiedPerson& person : study.people) {
    own.push_back(person.fit.held_out);
    if (person.from_one_number) one.push_back(*person.from_one_number);
  }
  SetError(MeanOf(own), *message.mutable_held_out());
  if (!one.empty()) SetError(MeanOf(one), *message.mutable_from_one_number());
  message.mutable_mean()->Add(study.together.mean.begin(), study.together.mean.end());
  message.mutable_spread()->Add(study.together.spread.begin(), study.together.spread.end());
  return message;
}

}  // namespace phrenic::fit
