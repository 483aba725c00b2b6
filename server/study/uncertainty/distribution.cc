#include "server/study/uncertainty/distribution.h"

#include <algorithm>
#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/triangular.hpp>
#include <boost/math/distributions/uniform.hpp>
#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "server/schema/fields.h"

namespace phrenic::study {
namespace {

absl::Status WrongInput(const std::string& path, const std::string& field, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(path, field.empty() ? "" : ".", field, ": ", what));
}

// Checks that the named numbers lie in the parameter's range and rise.
absl::Status CheckRising(const std::string& path, const v1::Quantity& quantity,
                         const std::vector<std::pair<const char*, double>>& numbers) {
  for (size_t i = 0; i < numbers.size(); ++i) {
    const auto& [name, value] = numbers[i];
    if (const auto problem = schema::NumberProblem(value, &quantity)) return WrongInput(path, name, *problem);
    if (i > 0 && value < numbers[i - 1].second) {
      return WrongInput(path, name, absl::StrCat("must not be below ", numbers[i - 1].first));
    }
  }
  if (numbers.front().second < numbers.back().second) return absl::OkStatus();
  return WrongInput(path, numbers.back().first, absl::StrCat("must be above ", numbers.front().first));
}

absl::Status CheckSpread(const std::string& path, const char* centre, double at, const char* name, double spread,
                         double least, const v1::Quantity& quantity) {
  if (const auto problem = schema::NumberProblem(at, &quantity)) return WrongInput(path, centre, *problem);
  if (std::isfinite(spread) && spread > least) return absl::OkStatus();
  return WrongInput(path, name, absl::StrCat("must be a number above ", schema::FormatNumber(least)));
}

// Sets quantiles of a boost distribution between the bounds of the input.
template <typename Law>
void SetLaw(const Law& law, const char* kind, Input& input) {
  input.kind = kind;
  input.inverse = [law](double p) { return boost::math::quantile(law, p); };
  input.first = boost::math::cdf(law, input.varied.low);
  input.last = boost::math::cdf(law, input.varied.high);
}

// The same for a law with tails, which end at kTail or at the parameter's range.
template <typename Law>
void SetTailedLaw(const Law& law, const char* kind, Input& input) {
  input.varied.low = std::max(input.varied.low, boost::math::quantile(law, kTail));
  input.varied.high = std::min(input.varied.high, boost::math::quantile(law, 1 - kTail));
  SetLaw(law, kind, input);
}

absl::Status SetDistribution(const v1::UncertainInput& wanted, const std::string& path, Input& input) {
  const v1::Quantity& range = calibrate::QuantityOf(input.varied);
  absl::Status status;
  switch (wanted.distribution_case()) {
    case v1::UncertainInput::kUniform: {
      const double low = wanted.uniform().low(), high = wanted.uniform().high();
      status = CheckRising(path + ".uniform", range, {{"low", low}, {"high", high}});
      if (!status.ok()) return status;
      input.varied.low = low, input.varied.high = high;
      SetLaw(boost::math::uniform(low, high), "uniform", input);
      return absl::OkStatus();
    }
    case v1::UncertainInput::kTriangular: {
      const auto& law = wanted.triangular();
      status =
          CheckRising(path + ".triangular", range, {{"low", law.low()}, {"mode", law.mode()}, {"high", law.high()}});
      if (!status.ok()) return status;
      input.varied.low = law.low(), input.varied.high = law.high();
      SetLaw(boost::math::triangular(law.low(), law.mode(), law.high()), "triangular", input);
      return absl::OkStatus();
    }
    case v1::UncertainInput::kNormal: {
      const auto& law = wanted.normal();
      status = CheckSpread(path + ".normal", "mean", law.mean(), "deviation", law.deviation(), 0, range);
      if (!status.ok()) return status;
      SetTailedLaw(boost::math::normal(law.mean(), law.deviation()), "normal", input);
      return absl::OkStatus();
    }
    case v1::UncertainInput::kLogNormal: {
      const auto& law = wanted.log_normal();
      status = CheckSpread(path + ".log_normal", "median", law.median(), "factor", law.factor(), 1, range);
      if (!status.ok()) return status;
      if (law.median() <= 0) return WrongInput(path, "log_normal.median", "must be above 0");
      SetTailedLaw(boost::math::lognormal(std::log(law.median()), std::log(law.factor())), "log-normal", input);
      return absl::OkStatus();
    }
    case v1::UncertainInput::DISTRIBUTION_NOT_SET:
      break;
  }
  return WrongInput(path, "", "needs a distribution: uniform, triangular, normal or log_normal");
}

}  // namespace

double Input::Quantile(double p) const {
  const double at = first + p * (last - first);
  if (at <= first) return varied.low;
  return at >= last ? varied.high : std::clamp(inverse(at), varied.low, varied.high);
}

absl::StatusOr<std::vector<Input>> MakeInputs(const google::protobuf::RepeatedPtrField<v1::UncertainInput>& inputs) {
  if (inputs.empty())
    return absl::InvalidArgumentError("inputs: at least one is needed, such as --vary elasticity:1:2");
  std::vector<Input> made;
  std::set<std::string> names;
  for (int i = 0; i < inputs.size(); ++i) {
    const std::string path = absl::StrCat("inputs[", i, "]");
    const std::string& name = inputs[i].parameter();
    if (name.find(':') != std::string::npos) return WrongInput(path, "parameter", "is a name without bounds");
    const auto varied = calibrate::ReadVaried(name);
    if (!varied.ok()) return WrongInput(path, "parameter", std::string(varied.status().message()));
    if (!names.insert(name).second) return WrongInput(path, "parameter", absl::StrCat(name, " is varied twice"));
    Input input{.varied = *varied, .kind = "", .source = inputs[i].source(), .inverse = nullptr, .first = 0, .last = 1};
    if (absl::Status status = SetDistribution(inputs[i], path, input); !status.ok()) return status;
    if (!(input.varied.low < input.varied.high) || !(input.first < input.last)) {
      return WrongInput(path, "", absl::StrCat("no part of the distribution lies in the range of ", name));
    }
    made.push_back(std::move(input));
  }
  return made;
}

void SetInputs(const std::vector<Input>& inputs, std::span<const double> p, v1::Parameters& parameters) {
  for (size_t i = 0; i < inputs.size(); ++i) {
    calibrate::SetValue(inputs[i].varied, inputs[i].Quantile(p[i]), parameters);
  }
}

google::protobuf::RepeatedPtrField<v1::InputRow> InputRows(const std::vector<Input>& inputs,
                                                           const v1::Parameters& nominal) {
  google::protobuf::RepeatedPtrField<v1::InputRow> rows;
  for (const Input& input : inputs) {
    v1::InputRow& row = *rows.Add();
    row.set_input(input.varied.field->name());
    row.set_unit(calibrate::QuantityOf(input.varied).unit());
    row.set_distribution(input.kind);
    row.set_nominal(calibrate::ValueOf(input.varied, nominal));
    row.set_p5(input.Quantile(0.05));
    row.set_p50(input.Quantile(0.5));
    row.set_p95(input.Quantile(0.95));
    row.set_source(input.source);
  }
  return rows;
}

}  // namespace phrenic::study
