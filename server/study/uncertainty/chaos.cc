#include "server/study/uncertainty/chaos.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "server/study/uncertainty/percentiles.h"

namespace phrenic::study {
namespace {

using Exponents = std::vector<int>;  // a degree an input

// Appends all exponents of total degree `left` or less from input `at` on.
void AppendTerms(Exponents& exponents, size_t at, int left, std::vector<Exponents>& terms) {
  if (at == exponents.size()) {
    terms.push_back(exponents);
    return;
  }
  for (int power = 0; power <= left; ++power) {
    exponents[at] = power;
    AppendTerms(exponents, at + 1, left - power, terms);
  }
  exponents[at] = 0;
}

double ValueOfTerm(const Exponents& term, const double* u) {
  double value = 1;
  for (size_t i = 0; i < term.size(); ++i) {
    if (term[i] == 0) continue;
    const auto n = static_cast<unsigned>(term[i]);
    value *= std::sqrt(2.0 * n + 1) * std::legendre(n, 2 * u[i] - 1);
  }
  return value;
}

// The points whose values are finite, and these values.
struct FiniteRuns {
  Eigen::MatrixXd basis;  // runs x terms
  Eigen::VectorXd values;
};

FiniteRuns MakeBasis(const UnitPoints& points, std::span<const double> values, const std::vector<Exponents>& terms) {
  FiniteRuns runs{Eigen::MatrixXd(points.rows(), static_cast<Eigen::Index>(terms.size())),
                  Eigen::VectorXd(points.rows())};
  Eigen::Index row = 0;
  for (Eigen::Index j = 0; j < points.rows(); ++j) {
    if (!std::isfinite(values[static_cast<size_t>(j)])) continue;
    for (size_t t = 0; t < terms.size(); ++t) {
      runs.basis(row, static_cast<Eigen::Index>(t)) = ValueOfTerm(terms[t], points.row(j).data());
    }
    runs.values[row++] = values[static_cast<size_t>(j)];
  }
  runs.basis.conservativeResize(row, Eigen::NoChange);
  runs.values.conservativeResize(row);
  return runs;
}

// Mean square of the errors at left-out points: residual over 1 - leverage.
double LeftOutError(const Eigen::HouseholderQR<Eigen::MatrixXd>& qr, const FiniteRuns& runs,
                    const Eigen::VectorXd& coefficients) {
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(runs.basis.rows(), runs.basis.cols());
  const Eigen::ArrayXd residual = (runs.values - runs.basis * coefficients).array();
  return (residual / (1 - q.rowwise().squaredNorm().array()).max(1e-12)).square().mean();
}

void SetIndices(const std::vector<Exponents>& terms, const Eigen::VectorXd& coefficients, double variance,
                std::vector<SobolIndex>& indices) {
  for (size_t t = 1; t < terms.size(); ++t) {
    const double part = std::pow(coefficients[static_cast<Eigen::Index>(t)], 2) / variance;
    const auto inputs = std::count_if(terms[t].begin(), terms[t].end(), [](int power) { return power > 0; });
    for (size_t i = 0; i < indices.size(); ++i) {
      if (terms[t][i] == 0) continue;
      indices[i].total += part;
      if (inputs == 1) indices[i].first += part;
    }
  }
}

}  // namespace

double CountTerms(int inputs, int degree) {
  double terms = 1;
  for (int i = 1; i <= degree; ++i) terms *= static_cast<double>(inputs + i) / i;
  return std::round(terms);
}

ChaosFit FitChaos(const UnitPoints& points, std::span<const double> values, int degree) {
  std::vector<Exponents> terms;
  Exponents exponents(static_cast<size_t>(points.cols()));
  AppendTerms(exponents, 0, degree, terms);
  const FiniteRuns runs = MakeBasis(points, values, terms);
  ChaosFit fit;
  fit.runs = static_cast<int>(runs.values.size());
  if (runs.values.size() <= static_cast<Eigen::Index>(terms.size())) return fit;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(runs.basis);
  const Eigen::VectorXd coefficients = qr.solve(runs.values);
  if (!coefficients.allFinite()) return fit;
  fit.terms = static_cast<int>(terms.size());
  fit.mean = coefficients[0];
  const double variance = coefficients.tail(coefficients.size() - 1).squaredNorm();
  fit.deviation = std::sqrt(variance);
  if (!Varies(variance, fit.mean)) return fit;
  const double spread = (runs.values.array() - runs.values.mean()).square().mean();
  fit.predicted_share = 1 - LeftOutError(qr, runs, coefficients) / spread;
  fit.indices.resize(exponents.size());
  SetIndices(terms, coefficients, variance, fit.indices);
  return fit;
}

}  // namespace phrenic::study
