// SIMD kernels of OuterProducts::CorrectStep. Google Highway compiles them for several instruction sets and selects the
// best one at run time. The results are bitwise equal on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_OUTER_PRODUCTS_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_OUTER_PRODUCTS_KERNEL_H_

#include <cstddef>
#include <vector>

namespace phrenic {

// The terms g_k, each 3 x n, and the weights w of their columns.
struct WeightedTerms {
  std::vector<const double*> g;
  const double* weights = nullptr;
  std::size_t columns = 0;  // n
};

// Sets along[k] to the sum of g_k (v - start), and gram[a * terms + b], b <= a, to the sum of w g_a g_b. Requires: both
// have room. `lanes` is working memory.
void SumProducts(const WeightedTerms& terms, const double* start, const double* v, std::vector<double>& lanes,
                 double* along, double* gram);

// Takes the sum of along[k] w g_k from v, and `dt` times it from x.
void TakeOffTerms(const WeightedTerms& terms, const double* along, double dt, double* v, double* x);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_OUTER_PRODUCTS_KERNEL_H_
